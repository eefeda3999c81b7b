#!/usr/bin/env bash
# Replays recordings through the nodes and prints how far their live poses (odom) are from those that bag_odometry writes to
# poses_online.txt, as a table. Run it on a machine that does nothing else: at high rates adjustments come later.
# Usage: scripts/measure.sh nodes_against_runner [SPEED [KITTI_FOLDER ...]]
#        SPEED: times that of the recording (default 0.2); default folders: those of ../shared/data that are there
set -euo pipefail
speed=${1:-0.2}; shift || true
[[ $speed =~ ^[0-9.]+$ ]] || { sed -n '2,5s/^# \?//p' "$0" >&2; exit 2; }
folders=()
. test/kitti_folders.sh nodes_against_runner "$@"
scripts/build.sh all >&2
# shellcheck disable=SC1091
set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
# A master of its own, so that no other ROS on the machine is disturbed.
port=$(test/ports.py)
export ROS_MASTER_URI=http://localhost:$port
work=$(mktemp -d)
rosmaster --core -p "$port" > "$work/rosmaster.log" 2>&1 &
master=$!
trap 'kill $master; rm -rf "$work"' EXIT

replay() {  # BAG: what odom told, one line a pose
  rostopic echo -p odom > "$work/odom.csv" 2> "$work/rostopic.log" &
  local listener=$!
  roslaunch -p "$port" arfm_vo replay.launch bag:="$1" rviz:=false rate:="$speed" \
    base_from_camera:="0 0 0 -1.5707963267948966 0 -1.5707963267948966" > "$work/roslaunch.log" 2>&1 ||
    { tail "$work/roslaunch.log" >&2; exit 1; }
  kill "$listener"
  wait "$listener" || true
}

echo "| sequence | speed | poses of nodes, of bag_odometry | farthest apart, mm | of the way, % |"
echo "|---|---|---|---|---|"
for folder in "${folders[@]}"; do
  name=$(basename "$folder")
  rosrun arfm_vo kitti_to_bag "$folder" "$work/$name.bag" > "$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  rosrun arfm_vo bag_odometry "$work/$name.bag" --output "$work/$name" > "$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  replay "$work/$name.bag"
  /usr/bin/python3 - "$work/odom.csv" "$work/$name/poses_online.txt" "$name" "$speed" << 'PYTHON'
import csv
import sys

import numpy

with open(sys.argv[1], encoding="utf-8") as file:
    told = numpy.array([[float(row[f"field.pose.pose.position.{axis}"]) for axis in "xyz"] for row in csv.DictReader(file)])
told = told[:, [1, 2, 0]] * [-1, -1, 1]  # base axes to optical ones
runner = numpy.loadtxt(sys.argv[2])[:, [3, 7, 11]]
common = min(len(told), len(runner))
apart_m = numpy.linalg.norm(told[-common:] - runner[-common:], axis=1).max()
way_m = numpy.linalg.norm(numpy.diff(runner, axis=0), axis=1).sum()
print(f"| {sys.argv[3]} | {sys.argv[4]} | {len(told)}, {len(runner)} | {1e3 * apart_m:.2g} | {100 * apart_m / way_m:.2g} |")
PYTHON
done
