#!/usr/bin/env bash
# Repeats the paper's experiments on what is there and prints their tables, Markdown. (docs/experiments.md is such a run, with
# pictures and verdicts.)
# Usage: scripts/measure.sh experiments [KITTI_FOLDER ...]      default: those of ../shared/data that are there
# ARFM_VO_SHARED: the folder that holds data/matching, data/kitti and data/calibration.
set -euo pipefail
readonly MAX_PAIRS=100  # of a sequence, as in the paper
readonly RENDERED_PAIRS=6
. test/kitti_folders.sh experiments "$@"
data=${ARFM_VO_SHARED:-../shared}/data
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
scripts/build.sh matching_experiment kitti_odometry render_sequence calibrate_stereo render_board_set > /dev/null
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Like the paper's indoor run in size and number; the head and side light are as hard as indoors.
"$programs/render_sequence" "$work/rendered_1624x1234" --path slopes --pairs $RENDERED_PAIRS \
  --width 1624 --height 1234 --threads 2 2> /dev/null
"$programs/render_sequence" "$work/rendered_low_sun" --path shadow --pairs $RENDERED_PAIRS --threads 2 2> /dev/null

echo "## Figs 5 to 9: matches"
echo
echo "Means over the pairs of a set; ms: of the matching (strategies), of finding and describing in one image (methods)."
echo
matching=("${folders[@]}" "$work/rendered_1624x1234" "$work/rendered_low_sun")
for set in graf boat leuven bikes; do
  if [ -d "$data/matching/oxford_$set" ]; then matching+=("$(realpath "$data/matching/oxford_$set")"); fi
done
"$programs/matching_experiment" "${matching[0]}" --more "${matching[@]:1}" > "$work/matching.csv"
echo "| experiment | set | way | pairs | matches | right | share, % | ms |"
echo "|---|---|---|---|---|---|---|---|"
awk -F, 'NR == 1 || ($1 == "strategy" && $6 != "fixed") || ($1 == "method" && $7 != "0.8000") {next}
         {way = $1 == "curve" ? "T " $7 : $1 == "rule" ? $6 : $1 == "strategy" ? $5 : $4
          key = $1 " | " $2 " | " way
          if (!(key in num)) keys[++count] = key
          ++num[key]; matches[key] += $9; right[key] += $10; ms[key] += $11}
         END {for (i = 1; i <= count; ++i) {
           k = keys[i]; n = num[k]
           printf "| %s | %d | %.0f | %.0f | %.1f | %.1f |\n", k, n, matches[k] / n, right[k] / n,
             100 * right[k] / (matches[k] > 0 ? matches[k] : 1), ms[k] / n}}' "$work/matching.csv"

echo
echo "## Figs 10, 11, 14 to 17: the odometry"
echo
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
echo "| sequence | run | lost | error over 10..50 m, % | ATE, m | error at the end, % | ms a pair | CPU ms a pair |"
echo "|---|---|---|---|---|---|---|---|"
for folder in "${folders[@]}" "$work/rendered_1624x1234"; do
  for config in surf surf_ransac surf_flann surf_flann_ransac paper_adaptive paper_fixed_0.6 best; do
    "$programs/kitti_odometry" "$folder" --pairs $MAX_PAIRS --config "$work/$config.yaml" > "$work/lines" 2> "$work/errors" ||
      cat "$work/errors" >&2
    awk -F': ' -v run="$(basename "$folder") | $config" '{value[$1] = $2} END {
      print "| " run " | " value["lost"] " | " value["t_rel_short_percent"] " | " value["ate_rmse_m"] " | " \
        value["end_error_percent"] " | " value["ms_per_pair_median"] " | " value["cpu_ms_per_pair"] " |"}' "$work/lines"
  done
done

echo
echo "## Figs 12, 13: calibration"
calibrate() {  # NAME IMAGES BOARD SQUARE
  printf '\n%s:\n\n' "$1"
  "$programs/calibrate_stereo" "$2" --board "$3" --square "$4" --output "$work/calibration" 2>&1 | sed 's/^/    /'
}
if [ -d "$data/calibration/opencv_9x6" ]; then calibrate opencv_9x6 "$data/calibration/opencv_9x6" 9x6 1; fi
"$programs/render_board_set" "$work/board" --threads 2 > /dev/null 2>&1
calibrate rendered_20x10 "$work/board" 20x10 0.10
printf '\nIts truth:\n\n'
grep -E '^(fx_|baseline_m)' "$work/board/truth.yaml" | sed 's/^/    /'
