#!/usr/bin/env bash
# Runs kitti_odometry at every stride on KITTI folders and writes docs/results.md.
# Usage: scripts/results.sh [KITTI_FOLDER ...]     default: those of ../shared/data that are there
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/kitti_folders.sh results "$@"
program=${BUILD_DIR:-_b}/devel/lib/arfm_vo/kitti_odometry
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
  echo "# Results"
  echo
  echo "Written by \`scripts/results.sh\`. K: every K-th pair. short: mean translation error over 10..50 m."
  echo
  echo "| sequence | K | pairs | lost | short % | ATE m | t_rel % | end error % | length ratio | CPU ms a pair |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  for folder in "${folders[@]}"; do
    for stride in 1 2 3 5; do
      "$program" "$folder" --stride $stride --output "$work/out" > "$work/lines" 2> "$work/errors" ||
        { cat "$work/errors" >&2; exit 1; }
      value() { awk -F': ' -v key="$1" '$1 == key {print $2}' "$work/lines"; }
      echo "| $(basename "$folder") | $stride | $(value pairs) | $(value lost) | $(value t_rel_short_percent)" \
        "| $(value ate_rmse_m) | $(value t_rel_percent) | $(value end_error_percent)" \
        "| $(value length_ratio) | $(value cpu_ms_per_pair) |"
    done
  done
} > "$work/results.md"
mv "$work/results.md" docs/results.md
cat docs/results.md
