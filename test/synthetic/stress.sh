#!/usr/bin/env bash
# Spoils the pictures of recordings and of a rendered drive (test/synthetic/disturbances.cpp) and writes what the odometry
# makes of them to docs/stress.md.
# Usage: scripts/measure.sh stress [KITTI_FOLDER ...]
#        default folders: those of ../shared/data that are there, the hand-held walk too
set -euo pipefail
. test/kitti_folders.sh stress "$@"
walk=${ARFM_VO_SHARED:-../shared}/data/handheld/boofcv_backyard
if [ $# -eq 0 ] && [ -d "$walk" ]; then folders+=("$walk"); fi
scripts/build.sh stress_odometry render_sequence relocalise
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs/render_sequence" "$work/rendered_curve" --path curve --pairs 60 > "$work/log" 2>&1 ||
  { cat "$work/log" >&2; exit 1; }
folders+=("$work/rendered_curve")
: > "$work/wrong"

{
  for folder in "${folders[@]}"; do
    name=$(basename "$folder")
    "$programs/stress_odometry" "$folder" --all > "$work/lines"
    echo "## $name"
    echo
    echo "| disturbance | live | after | tracked | degraded | lost | wrong | largest |"
    echo "|---|---|---|---|---|---|---|---|"
    awk -F, 'NR > 1 {gsub("nan", "-"); printf "| %s | %s / %s | %s / %s | %s | %s | %s | %s | %s |\n", \
      $1, $2, $3, $4, $5, $6, $7, $8, $9, $10}' "$work/lines"
    awk -F, -v name="$name" 'NR > 1 && $9 > 0 {printf "| %s | %s | %s | %s |\n", name, $1, $9, $10}' "$work/lines" >> "$work/wrong"
    echo
  done
} > "$work/stress"
{
  echo "| sequence | disturbance | wrong | largest |"
  echo "|---|---|---|---|"
  cat "$work/wrong"
} > "$work/all_wrong"
"$programs/render_sequence" "$work/turn" --path wide_turn > "$work/log" 2>&1
{
  echo "| shared view at least | tries | found by the first pair | wrong |"
  echo "|---|---|---|---|"
  for share in 0.5 0.25 0.1; do
    "$programs/relocalise" "$work/turn" --min-share $share |
      awk -F': ' -v share=$share '{v[$1] = $2} END {printf "| %s | %d | %d | %d |\n", share, v["tries"], v["found"], v["wrong"]}'
  done
} > "$work/relocalisation"
test/readme_section.py docs/stress.md stress < "$work/stress"
test/readme_section.py docs/stress.md wrong < "$work/all_wrong"
test/readme_section.py docs/stress.md relocalisation < "$work/relocalisation"
