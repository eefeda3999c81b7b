#!/usr/bin/env bash
# Runs kitti_odometry at every stride on KITTI folders, each as a first drive and as a second that remembers the first's
# calibration, and writes docs/results.md and, of the default folders, the table in the README. What peers reach stands in docs/peers.csv.
# Usage: scripts/measure.sh results [KITTI_FOLDER ...]     default: those of ../shared/data that are there
set -euo pipefail
. test/kitti_folders.sh results "$@"
program=${BUILD_DIR:-_b}/devel/lib/arfm_vo/kitti_odometry
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

run() {  # FILE KITTI_ODOMETRY_ARGUMENT...
  local lines=$1; shift
  "$program" "$@" --learned-calibration "$work/learned.yaml" > "$lines" 2> "$work/errors" ||
    { cat "$work/errors" >&2; exit 1; }
}
value() { awk -F': ' -v key="$2" '$1 == key {printf "%.3f", $2}' "$1"; }
pair() { echo "$(value "$1" "$2t_rel_short_percent") / $(value "$1" "$2ate_rmse_m")"; }
peer() {  # SEQUENCE K PROGRAM
  awk -F, -v s="$1" -v k="$2" -v p="$3" '$1 == s && $2 == k && $3 == p {print $4 " / " $5}' docs/peers.csv
}

{
  echo "| sequence | K | pairs | lost | **live** | live, second drive | after | live length ratio | libviso2 | ORB-SLAM2 | OV2SLAM | dsol |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
  for folder in "${folders[@]}"; do
    for stride in 1 2 3 5; do
      rm -f "$work/learned.yaml"
      for drive in 1 2; do run "$work/$drive" "$folder" --stride $stride; done
      name=$(basename "$folder")
      echo "| $name | $stride | $(awk '$1 == "pairs:" {print $2}' "$work/1") | $(awk '$1 == "lost:" {print $2}' "$work/1")" \
        "| **$(pair "$work/1" live_)** | $(pair "$work/2" live_) | $(pair "$work/1" "")" \
        "| $(value "$work/1" live_length_ratio) | $(peer "$name" $stride libviso2) | $(peer "$name" $stride ORB-SLAM2)" \
        "| $(peer "$name" $stride OV2SLAM) | $(peer "$name" $stride dsol) |"
    done
  done
} > "$work/table"
{
  echo "| sequence | pairs | **arfm_vo** | libviso2 | ORB-SLAM2 | OV2SLAM | dsol |"
  echo "|---|---|---|---|---|---|---|"
  awk -F' *[|] *' 'NF > 9 && ($3 == 1 || $3 == 5) {
    printf "| %s | %s | %s | %s | %s | %s | %s |\n", $2, $3 == 1 ? "all" : "every " $3 "th", $6, $10, $11, $12, $13}' "$work/table"
} > "$work/section"
test/readme_section.py docs/results.md results < "$work/table"
if [ $# -eq 0 ]; then test/readme_section.py README.md results < "$work/section"; fi
cat docs/results.md
