#!/usr/bin/env bash
# Repeats the paper's experiments on what is there and writes docs/experiments.md with its pictures.
# Usage: scripts/measure.sh experiments [KITTI_FOLDER ...]      default: those of ../shared/data that are there
# ARFM_VO_SHARED: the folder that holds data/matching, data/kitti and data/calibration.
set -euo pipefail
python3 -c 'import pandas' || { echo "experiments: pandas is missing (apt-get install python3-pandas)" >&2; exit 2; }
readonly MAX_PAIRS=100  # of a sequence, as in the paper
readonly RENDERED_PAIRS=6
data=${ARFM_VO_SHARED:-../shared}/data
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
folders=()
for folder in "$@"; do folders+=("$(realpath "$folder")"); done
if [ $# -eq 0 ]; then
  for folder in "$data"/kitti/*/; do
    if [ -d "$folder/image_0" ]; then folders+=("$(realpath "$folder")"); fi
  done
fi
[ ${#folders[@]} -gt 0 ] || { echo "experiments: no KITTI folder given or found" >&2; exit 1; }
scripts/build.sh matching_experiment kitti_odometry render_sequence calibrate_stereo render_board_set > /dev/null

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
start=$SECONDS
say() { echo "experiments: $((SECONDS - start)) s: $*" >&2; }

# Like the paper's indoor run in size and number; the head and side light are as hard as indoors.
say "rendering"
"$programs/render_sequence" "$work/rendered_1624x1234" --path slopes --pairs $RENDERED_PAIRS \
  --width 1624 --height 1234 --threads 2 2> /dev/null
"$programs/render_sequence" "$work/rendered_low_sun" --path shadow --pairs $RENDERED_PAIRS --threads 2 2> /dev/null

say "matching"
matching=("${folders[@]}" "$work/rendered_1624x1234" "$work/rendered_low_sun")
for set in graf boat leuven bikes; do
  if [ -d "$data/matching/oxford_$set" ]; then matching+=("$(realpath "$data/matching/oxford_$set")"); fi
done
"$programs/matching_experiment" "${matching[0]}" --more "${matching[@]:1}" \
  --pictures "$work/pictures" > "$work/matching.csv"

# Options of a run: the paper's, but for the strategy and the rule of the threshold.
configure() {  # NAME STRATEGY RULE
  sed "s/strategy: .*/strategy: $2/; s/rule: .*/$3/" config/arfm_paper.yaml > "$work/$1.yaml"
}
for strategy in surf surf_ransac surf_flann surf_flann_ransac; do
  configure "$strategy" "$strategy" "rule: fixed\n      fixed_ratio: 0.8"
done
configure paper_adaptive surf_flann_ransac "rule: variance"
configure paper_fixed_0.6 surf_flann_ransac "rule: fixed\n      fixed_ratio: 0.6"
cp config/arfm.yaml "$work/best.yaml"
for folder in "${folders[@]}" "$work/rendered_1624x1234"; do
  for config in surf surf_ransac surf_flann surf_flann_ransac paper_adaptive paper_fixed_0.6 best; do
    run=$work/runs/$(basename "$folder")/$config
    say "odometry: $(basename "$folder"), $config"
    mkdir -p "$run"
    "$programs/kitti_odometry" "$folder" --pairs $MAX_PAIRS --config "$work/$config.yaml" \
      --output "$run" > "$run/lines" 2> "$run/errors" || cat "$run/errors" >&2
    if [ -f "$folder/poses.txt" ]; then cp "$folder/poses.txt" "$run/truth.txt"; fi
  done
done

say "calibration"
calibrate() {  # NAME IMAGES BOARD SQUARE
  "$programs/calibrate_stereo" "$2" --board "$3" --square "$4" --output "$work/calibration/$1" \
    > "$work/calibration_$1" 2>&1 || cat "$work/calibration_$1" >&2
}
mkdir -p "$work/calibration"
if [ -d "$data/calibration/opencv_9x6" ]; then calibrate opencv_9x6 "$data/calibration/opencv_9x6" 9x6 1; fi
"$programs/render_board_set" "$work/board" --threads 2 > /dev/null 2>&1
calibrate rendered_20x10 "$work/board" 20x10 0.10
cp "$work/board/truth.yaml" "$work/calibration_truth"

say "report"
test/experiments/experiments_report.py "$work" docs
say "docs/experiments.md is written"
