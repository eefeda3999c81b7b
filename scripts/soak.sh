#!/usr/bin/env bash
# Feeds pairs of recordings, back and forth, with drop-outs, darkness, exposure steps, blur, a dark eye and jumps of time,
# through the running nodes as fast as they take them; in the last third a node is restarted each 1,000 pairs, in turn, by
# SIGTERM and by SIGKILL. Samples memory, files, threads and latency of each node each 200 pairs to BUILD_DIR/soak.csv and
# writes docs/soak.md. Status 1 where it was not tracked again.
# Usage: scripts/soak.sh [PAIRS [SECONDS [KITTI_FOLDER ...]]]     default: 50000 pairs; ends after SECONDS (0: never)
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
pairs=${1:-50000} seconds=${2:-0}
[[ $pairs =~ ^[0-9]+$ && $seconds =~ ^[0-9]+$ ]] || { sed -n '2,6s/^# \?//p' "$0" >&2; exit 2; }
shift $(($# < 2 ? $# : 2))
folders=()
. scripts/kitti_folders.sh soak "$@"
build=${BUILD_DIR:-_b}
scripts/build.sh arfm_node pose_node ba_node camera_mount_node arfm_vo_generate_messages_py >&2
export PATH=/usr/bin:$PATH
# shellcheck disable=SC1091
set +u; . "$build/devel/setup.sh"; set -u
# A master of its own, so that no other ROS on the machine is disturbed.
port=$(scripts/ports.py)
export ROS_MASTER_URI=http://localhost:$port
rosmaster --core -p "$port" > "$build/rosmaster.log" 2>&1 &
trap 'kill $!' EXIT
{
  echo "# Soak"
  echo
  echo "Written by \`scripts/soak.sh $pairs $seconds\`. Latency is that from the images as sent to \`features\` (arfm_node), \`odom\`"
  echo "(pose_node) and the keyframe's \`map_update\` (ba_node), with two pairs on their way at a time. A fault begins at each"
  echo "100th pair: drop-out of 5 pairs, darkness of 10, exposure halved, doubled, blur, a dark right eye, time 60 s back, ahead."
  echo
  scripts/soak.py --pairs "$pairs" --restart-every 1000 --restart-from $((pairs * 2 / 3)) \
    --max-seconds $((seconds > 0 ? seconds : 1 << 30)) --csv "$build/soak.csv" --programs "$build/devel/lib/arfm_vo" "${folders[@]}"
} > "$build/soak.md"
mv "$build/soak.md" docs/soak.md
cat docs/soak.md
