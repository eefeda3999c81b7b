#!/usr/bin/env bash
# Switches the odometry's parts on one after the other, on KITTI folders and on simulated drives, and writes
# docs/ablation.md.
# Usage: scripts/measure.sh ablation [KITTI_FOLDER ...]     default: those of ../shared/data that are there
set -euo pipefail
. test/kitti_folders.sh ablation "$@"
scripts/build.sh kitti_odometry simulate_kitti
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Each step's options; what a step does not name is as shipped.
no_subpixel='frontend: {stereo: {refine_subpixel: false, search_rows: false}}'
one_before='keyframes: {min_parallax_px: 0}, map: {max_keyframes: 2}, bundle: {enabled: false, num_keyframes: 2}'
steps=("frame to frame" "+ local map" "+ windowed BA" "+ sub-pixel" "+ global BA")
cat > "$work/0.yaml" <<YAML
{adjust_globally: false, $no_subpixel, odometry: {tracker: {align_patches: false}, $one_before}}
YAML
cat > "$work/1.yaml" <<YAML
{adjust_globally: false, $no_subpixel, odometry: {tracker: {align_patches: false}, bundle: {enabled: false}}}
YAML
cat > "$work/2.yaml" <<YAML
{adjust_globally: false, $no_subpixel, odometry: {tracker: {align_patches: false}}}
YAML
echo '{adjust_globally: false}' > "$work/3.yaml"
echo '{adjust_globally: true}' > "$work/4.yaml"

{
  echo "# What each part brings"
  echo
  echo "Written by \`scripts/measure.sh ablation\`. short: mean translation error over 10..50 m, %; ATE m. Simulated: KITTI's"
  echo "paths 05 and 10, 1,000 frames, 0.5 px noise, 20 % outliers, t_rel %; it has no images, so no sub-pixel step."
  echo
  header="|"; rule="|---"
  for folder in "${folders[@]}"; do
    for stride in 1 3; do header+=" | $(basename "$folder") K=$stride"; rule+="|---"; done
  done
  echo "$header | simulated 05 | simulated 10 |"
  echo "$rule|---|---|"
  for i in "${!steps[@]}"; do
    row="| ${steps[$i]}"
    for folder in "${folders[@]}"; do
      for stride in 1 3; do
        "$programs/kitti_odometry" "$folder" --stride $stride --config "$work/$i.yaml" > "$work/lines" 2> "$work/errors" ||
          { cat "$work/errors" >&2; exit 1; }
        row+=" | $(awk -F': ' '$1 == "t_rel_short_percent" {s = $2} $1 == "ate_rmse_m" {a = $2} $1 == "lost" {l = $2}
                              END {printf "%.2f / %.3f%s", s, a, (l > 0 ? " (" l " lost)" : "")}' "$work/lines")"
      done
    done
    if [ "$i" = 3 ]; then
      row+=" | | |"
    elif [ -d "$data/ground_truth_poses" ]; then
      "$programs/simulate_kitti" "$data/ground_truth_poses" --sequences 05,10 --frames 1000 --config "$work/$i.yaml" > "$work/csv"
      row+=" | $(awk -F, 'NR == 2 {print $9}' "$work/csv") | $(awk -F, 'NR == 3 {print $9}' "$work/csv") |"
    else
      row+=" | | |"
    fi
    echo "$row"
  done
} > "$work/ablation.md"
mv "$work/ablation.md" docs/ablation.md
cat docs/ablation.md
