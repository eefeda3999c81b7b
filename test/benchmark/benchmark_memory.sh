#!/usr/bin/env bash
# Drives KITTI folders back and forth for 2,000 pairs in process and prints the resident memory on the way.
# Usage: scripts/measure.sh benchmark_memory [KITTI_FOLDER ...]     default: those of ../shared/data that are there
# PAIRS=N: so many pairs. Takes some minutes a folder.
set -euo pipefail
. test/kitti_folders.sh benchmark_memory "$@"
pairs=${PAIRS:-2000}
program=${BUILD_DIR:-_b}/devel/lib/arfm_vo/kitti_odometry
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

link_back_and_forth() {  # IMAGES NEW_IMAGES
  mkdir -p "$2"
  find "$(realpath "$1")" -maxdepth 1 -name '*.png' | sort | awk -v pairs="$pairs" -v to="$2" '
    {name[n++] = $0}
    END {for (i = 0; i < pairs; i++) {
           at = i % (2 * n - 2); if (at >= n) at = 2 * n - 2 - at
           printf "%s\n%s/%06d.png\n", name[at], to, i}}' | xargs -d '\n' -n 2 ln -s
}

echo "Resident memory, median over the 100 pairs about each: an adjustment that runs just then counts for little."
echo
echo "| sequence | pairs | lost | MB after 200 | 500 | 1000 | end | end / 200 | peak |"
echo "|---|---|---|---|---|---|---|---|---|"
for folder in "${folders[@]}"; do
  rm -rf "$work/folder"
  left=$folder/image_0 right=$folder/image_1
  [ -d "$left" ] || { left=$folder/image_00/data right=$folder/image_01/data; }
  link_back_and_forth "$left" "$work/folder/image_0"
  link_back_and_forth "$right" "$work/folder/image_1"
  for calibration in "$folder/calib.txt" "$folder/calib_cam_to_cam.txt" "$folder/../calib_cam_to_cam.txt"; do
    [ ! -f "$calibration" ] || { cp "$calibration" "$work/folder"; break; }
  done
  "$program" "$work/folder" --output "$work/out" > "$work/lines" 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; }
  value() { awk -F': ' -v key="$1" '$1 == key {print $2}' "$work/lines"; }
  around() {  # PAIR -> median over the 100 pairs about it
    awk -F, -v at="$1" 'NR - 1 > at - 50 && NR - 1 <= at + 50 {print $4}' "$work/out/timing.csv" | sort -g |
      awk '{memory[NR] = $1} END {print NR ? memory[int((NR + 1) / 2)] : "-"}'
  }
  early=$(around 200) end=$(around $((pairs - 50)))
  echo "| $(basename "$folder") | $pairs | $(value lost) | $early | $(around 500) | $(around 1000) | $end" \
    "| $(awk -v a="$early" -v b="$end" 'BEGIN {printf "%.3f", (a > 0 ? b / a : 0)}') | $(value peak_rss_mb) |"
done
