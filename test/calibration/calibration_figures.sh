#!/usr/bin/env bash
# Renders the paper's calibration set (63 pairs of 1624x1234, a board of 20x10 corners, 0.10 m), calibrates from it and
# compares with the truth: fx and baseline must be within 0.1 %, cx and cy within 1 px. The package must be built.
# Usage: scripts/measure.sh calibration_figures [RENDER_OPTION ...]     such as --pairs 15 --width 812
set -euo pipefail
programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs/render_board_set" "$work/set" --threads "$(nproc)" "$@"
"$programs/calibrate_stereo" "$work/set" --board 20x10 --square 0.10 --output "$work/result" | tee "$work/figures"
for eye in left right; do
  sed -n '/^camera_matrix/,/data/s/.*data: \[\(.*\)\]/\1/p' "$work/result/$eye.yaml" | tr -d , \
    | awk -v eye=$eye '{print "fx_" eye ":", $1; print "cx_" eye ":", $3; print "fy_" eye ":", $5; print "cy_" eye ":", $6}'
done > "$work/found"
grep '^baseline_m' "$work/figures" >> "$work/found"
awk 'FNR == NR {truth[$1] = $2; next}
  {
    error = $2 - truth[$1]; size = error < 0 ? -error : error
    is_center = $1 ~ /^c/
    limit = is_center ? 1 : truth[$1] / 1000
    bad = bad || size > limit
    printf "%-12s truth %-10.6g found %-10.6g error %s%s\n", $1, truth[$1], $2,
      is_center ? sprintf("%.4f px", error) : sprintf("%.4f %%", 100 * error / truth[$1]), (size > limit ? "  TOO LARGE" : "")
  }
  END {exit bad}' "$work/set/truth.yaml" "$work/found"
