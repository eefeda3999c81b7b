#!/usr/bin/env bash
# A simulated rover drives to a goal by sight alone, through all the nodes, without a screen; writes a picture of the
# drive. Usage: scripts/simulation_demo.sh [X_M Y_M HEADING_DEG [OUTPUT_DIR]]      default 4 1.5 90, _demo_simulation
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
x=${1:-4} y=${2:-1.5} heading=${3:-90} output=${4:-_demo_simulation}
scripts/build.sh simulator_node chassis_node arfm_node pose_node ba_node truth_path_node pan_tilt_node arfm_vo_nodelets \
  arfm_vo_generate_messages_py
export PATH=/usr/bin:$PATH
# shellcheck disable=SC1091
set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
mkdir -p "$output"
output=$(realpath "$output")
rm -f "$output/drive.png"
ros_port=${ROS_MASTER_PORT:-11912}
export ROS_MASTER_URI=http://localhost:$ros_port
roslaunch -p "$ros_port" arfm_vo simulation.launch rviz:=false nodelets:=true max_speed_up:=5 \
  port:=$((ros_port / 10)) picture:="$output/drive.png" > "$output/roslaunch.log" 2>&1 &
launch=$!
trap 'kill -INT $launch 2>/dev/null && wait $launch || true' EXIT
until (echo > "/dev/tcp/localhost/$ros_port") 2>/dev/null; do
  kill -0 $launch || { tail -20 "$output/roslaunch.log"; exit 1; }
  sleep 0.2
done
echo "drives to x $x m, y $y m, heading $heading degrees; log: $output/roslaunch.log"
scripts/drive_to.py --yes "$x" "$y" "$heading" 1800 || { tail -20 "$output/roslaunch.log"; exit 1; }
for _ in $(seq 100); do [ ! -s "$output/drive.png" ] || break; sleep 0.1; done
[ -s "$output/drive.png" ] || { echo "demo: the simulator wrote no picture" >&2; exit 1; }
echo "picture: $output/drive.png"
