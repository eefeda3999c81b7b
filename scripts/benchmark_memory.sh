#!/usr/bin/env bash
# Drives KITTI folders back and forth for 2,000 pairs in process and prints the resident memory on the way.
# Usage: scripts/benchmark_memory.sh [KITTI_FOLDER ...]     default: those of ../shared/data that are there
# PAIRS=N: so many pairs. Takes some minutes a folder.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/kitti_folders.sh benchmark_memory "$@"
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
  awk -F, -v name="$(basename "$folder")" -v lost="$(value lost)" -v peak="$(value peak_rss_mb)" '
    NR > 1 {memory[NR - 1] = $4}
    END {n = NR - 1
         printf "| %s | %d | %s | %s | %s | %s | %s | %.3f | %s |\n", name, n, lost, memory[200], memory[500],
                memory[1000], memory[n], (memory[200] > 0 ? memory[n] / memory[200] : 0), peak}' "$work/out/timing.csv"
done
