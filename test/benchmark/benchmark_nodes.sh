#!/usr/bin/env bash
# Measures the odometry's nodes on a bag, as separate nodes and as nodelets: roslaunch to first pose, latency from image
# to odometry, pairs a second, dropped pairs, memory. The mount is given, so that no pair waits for the bag's tf. Run on a machine that does nothing else.
# Usage: scripts/measure.sh benchmark_nodes BAG [SPEED ...]      SPEED: times that of the recording (default 1 2 3 4)
set -euo pipefail
[ $# -ge 1 ] || { sed -n 2,4p "$0" >&2; exit 2; }
bag=$(realpath "$1"); shift
speeds=("$@"); [ ${#speeds[@]} -gt 0 ] || speeds=(1 2 3 4)
[ -r "$bag" ] || { echo "$bag: no such bag" >&2; exit 1; }
# shellcheck disable=SC1091
set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
# A master of its own, so that no other ROS on the machine is disturbed.
port=$(test/ports.py)
export ROS_MASTER_URI=http://localhost:$port
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

measure() {  # NODELETS SPEED -> the probe's line
  local start probe
  start=$(date +%s.%N)
  roslaunch -p "${ROS_MASTER_URI##*:}" arfm_vo replay.launch bag:="$bag" rate:="$2" nodelets:="$1" rviz:=false \
    base_from_camera:="0 0 1.65 -1.5707963 0 -1.5707963" \
    >"$logs/roslaunch.log" 2>&1 &
  local launch=$!
  test/benchmark/odometry_probe.py "$start" >"$logs/probe.log" 2>"$logs/probe.err" &
  probe=$!
  wait "$launch" || true
  kill "$probe" 2>/dev/null || true
  wait "$probe" || { cat "$logs/probe.err" "$logs/roslaunch.log" >&2; exit 1; }
  tail -n 1 "$logs/probe.log"
}

row='%-9s %6s %9s %8s %7s %7s %8s %9s %8s %8s %9s %9s\n'
# shellcheck disable=SC2059
{
  printf "$row" chain speed pairs_s start_s pairs poses drop_arfm drop_pose p50_ms p95_ms rss_early rss_end
  for nodelets in false true; do
    for speed in "${speeds[@]}"; do
      read -r first pairs poses arfm pose rate p50 p95 early end < <(measure "$nodelets" "$speed")
      printf "$row" "$([ "$nodelets" = true ] && echo nodelets || echo nodes)" "$speed" "$rate" "$first" \
        "$pairs" "$poses" "$arfm" "$pose" "$p50" "$p95" "$early" "$end"
    done
  done
}
