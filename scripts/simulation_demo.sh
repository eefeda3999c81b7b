#!/usr/bin/env bash
# A simulated rover drives to a goal by sight alone, through all the nodes, without a screen; writes a picture of the
# drive. Usage: scripts/simulation_demo.sh [X_M Y_M HEADING_DEG [OUTPUT_DIR]]      default 4 1.5 90 and demo_simulation
set -euo pipefail
cd "$(dirname "$0")/.."
x=${1:-4} y=${2:-1.5} heading=${3:-90} output=${4:-demo_simulation}
scripts/build.sh simulator_node chassis_node arfm_node pose_node ba_node truth_path_node arfm_vo_nodelets
export PATH=/usr/bin:$PATH
# shellcheck disable=SC1091
set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
mkdir -p "$output"
output=$(cd "$output" && pwd)
ros_port=$((20000 + RANDOM % 10000))
export ROS_MASTER_URI=http://localhost:$ros_port
roslaunch -p "$ros_port" arfm_vo simulation.launch rviz:=false nodelets:=true max_speed_up:=3 \
  port:=$((1000 + RANDOM % 5000)) picture:="$output/drive.png" > "$output/roslaunch.log" 2>&1 &
launch=$!
trap 'kill -INT $launch 2>/dev/null && wait $launch || true' EXIT
until (echo > "/dev/tcp/localhost/$ros_port") 2>/dev/null; do
  kill -0 $launch || { tail -20 "$output/roslaunch.log"; exit 1; }
  sleep 0.2
done
scripts/drive_to.py "$x" "$y" "$heading"
until [ -s "$output/drive.png" ]; do sleep 0.2; done
echo "picture: $output/drive.png"
