#!/usr/bin/env bash
# Shows the odometry at work: installs and builds what is missing, replays a recording through the
# nodes by roslaunch, and prints the error against the ground truth.
# Usage: scripts/demo.sh [BAG | KITTI_FOLDER] [OUTPUT_DIR]     default: the fixture, _demo
#        scripts/demo.sh --simulation [X_M Y_M HEADING_DEG [OUTPUT_DIR]]
# With --simulation a simulated rover drives to a goal by sight alone, and a picture of the drive is written.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
if [ "${1:-}" = --simulation ]; then
  shift
  scripts/install_dependencies.sh
  exec scripts/simulation_demo.sh "$@"
fi
input=${1:-rosbag_fixtures/terrain.bag}
output=${2:-_demo}
[ -e "$input" ] || { echo "demo: $input: no such bag or KITTI folder" >&2; exit 1; }
scripts/install_dependencies.sh
# Only what the demo runs.
targets=(arfm_node pose_node ba_node truth_path_node camera_mount_node evaluate_trajectory)
if [ -d "$input" ]; then targets+=(kitti_to_bag); fi
scripts/build.sh "${targets[@]}"
export PATH=/usr/bin:$PATH
build=${BUILD_DIR:-_b}
set +u; . "$build/devel/setup.sh"; set -u
programs=$build/devel/lib/arfm_vo  # (rosrun asks which where there is another build folder)
export ROS_MASTER_URI=http://localhost:${ROS_MASTER_PORT:-11911}
mkdir -p "$output"
output=$(realpath "$output")
if [ -d "$input" ]; then
  "$programs/kitti_to_bag" "$input" "$output/input.bag"
  input=$output/input.bag
fi
input=$(realpath "$input")
rm -f "$output"{,/keyframes}/{poses,tracked}*.txt "$output"{,/keyframes}/trajectory*.tum
roslaunch arfm_vo replay.launch bag:="$input" rviz:=false trajectory_dir:="$output" trajectory_of_camera:=true
[ -s "$output/trajectory.tum" ] || { echo "demo: the nodes saved no trajectory" >&2; exit 1; }
if scripts/pair_with_truth.py "$output/trajectory.tum" "$input" "$output"; then
  "$programs/evaluate_trajectory" "$output/estimate.txt" "$output/truth.txt" \
    --plot "$output/trajectory.png"
  echo "picture: $output/trajectory.png"
fi
echo "trajectory: $output/trajectory.tum (TUM), $output/poses.txt (KITTI)"
