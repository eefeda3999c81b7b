#!/usr/bin/env bash
# Measures SURF, matching and the whole pair against what Debian offers, and writes the table between
# the marks of docs/benchmark.md. Takes some minutes; best on a machine that does nothing else.
# Usage: scripts/measure.sh benchmark [KITTI_FOLDER]     default: KITTI 06 of ../shared/data, else a rendered drive
set -euo pipefail
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scripts/build.sh features_benchmark kitti_odometry render_sequence > /dev/null
folder=${1:-${ARFM_VO_SHARED:-../shared}/data/kitti/odometry_06_000-050}
if [ ! -d "$folder" ]; then
  [ $# -eq 0 ] || { echo "benchmark: $folder: no such KITTI folder" >&2; exit 1; }
  folder=$work/rendered
  "$programs/render_sequence" "$folder" --pairs 40 --threads 2 2> /dev/null
fi
left=$(find "$folder/image_0/" -name '*.png' | sort | head -n 1)
ARFM_VO_PAIR=$left:$folder/image_1/$(basename "$left") "$programs/features_benchmark" \
  --benchmark_repetitions="${REPETITIONS:-5}" --benchmark_min_time=0.2 \
  --benchmark_enable_random_interleaving=true --benchmark_out="$work/features.json" \
  --benchmark_out_format=json > /dev/null 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; }
"$programs/kitti_odometry" "$folder" --output "$work/run" > "$work/lines" 2> "$work/errors" ||
  { cat "$work/errors" >&2; exit 1; }
test/benchmark/benchmark_table.py "$work/features.json" "$work/lines" "$work/run/timing.csv" \
  "$(basename "$folder")" | tee "$work/section"
test/readme_section.py docs/benchmark.md benchmark < "$work/section"
