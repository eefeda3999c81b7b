#!/usr/bin/env bash
# Drives the simulated rover to 20 goals by sight alone and writes docs/driving.md, its pictures beside it in
# docs/drives.png. Usage: scripts/closed_loop.sh [DRIVE_SIMULATION_ARGUMENT ...]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh drive_simulation
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
"${BUILD_DIR:-_b}/devel/lib/arfm_vo/drive_simulation" --threads "$(nproc)" --output "$work" "$@" \
  | tee "$work/table" || status=$?

value() { awk -v key="$1:" '$1 == key { print $2 }' "$work/table"; }

{
  cat <<'TEXT'
# Driving by sight alone

Made by `scripts/closed_loop.sh`: a simulated rover drives to goals on rendered terrain, in process, on a simulated
clock, with fixed seeds (a seed is a terrain, a start, a goal, the slip and the camera's noise). The pilot speaks to the
chassis in the CAN frames of the real one; the tracks slip by 10 % and more or less from place to place, and downhill;
all that the pilot knows of its place comes from the visual odometry on the rendered stereo pairs, 0.2 s late. Allowed
are 1 % of the way driven and 5 cm. The test `ClosedLoopTest` drives to three of these goals.

![four of the drives](drives.png)

*Four of the drives from above: contours every 0.25 m, green the true way, red the way by sight, yellow the goal.*

TEXT
  echo "| | asked | measured |"
  echo "|---|---|---|"
  goals=$(value goals)
  echo "| goals reached | $goals of $goals | $(value reached) |"
  echo "| within the allowed error | $goals | $(value within_allowed_error) |"
  echo "| largest error over allowed | 1 | $(value worst_error_over_allowed) |"
  echo "| fastest frame, m/s | 0.1 | $(value fastest_frame_mps) |"
  echo "| frames before start | 0 | $(value frames_before_start) |"
  echo "| steepest slope under the rover, degrees | to 10 | $(value steepest_slope_deg) |"
  echo "| way in all, m | | $(value driven_m) |"
  echo "| stereo pairs, of them without a pose | | $(value pairs), $(value lost) |"
  echo
  echo "| goal | away, m | driven, m | error, m | allowed, m | heading error, deg | steepest, deg | slip, % | fastest frame, m/s | frames before start | pairs | lost | time, s | outcome |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
  awk '$1 ~ /^[0-9]+$/ { printf "|"; for (i = 1; i <= 13; ++i) printf " %s |", $i
                         for (i = 14; i <= NF; ++i) printf " %s", $i; print " |" }' "$work/table"
} > "$work/driving.md"

mapfile -t pictures < <(find "$work" -name 'drive_*.png' | sort | head -4)
montage "${pictures[@]}" -tile 2x2 -geometry 600x663+4+4 "$work/drives.png"
mv "$work/driving.md" "$work/drives.png" docs/
exit "$status"
