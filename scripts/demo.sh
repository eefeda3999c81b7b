#!/usr/bin/env bash
# Shows the odometry at work: installs and builds what is missing, replays a recording through the nodes by roslaunch, and
# prints the error against the ground truth.
# Usage: scripts/demo.sh [BAG | KITTI_FOLDER] [OUTPUT_DIR]     default: the fixture, _demo
#        scripts/demo.sh --simulation [X_M Y_M HEADING_DEG [OUTPUT_DIR]]      default: 4 1.5 90, _demo_simulation
# With --simulation a simulated rover drives to a goal by sight alone, through all the nodes and without a screen, and a
# picture of the drive is written.
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
export PATH=/usr/bin:$PATH
step() { echo "demo: step $1 of 4: $2"; }
fail() { echo "demo: $1" >&2; [ ! -f "$log" ] || tail -20 "$log" >&2; exit 1; }

# prepare DEFAULT_PORT TARGET ...: installs, builds, and makes the package known to this shell.
prepare() {
  export ROS_MASTER_URI=http://localhost:${ROS_MASTER_PORT:-$1}
  shift
  step 1 "Debian packages (the first time minutes, by the network)"
  scripts/install_dependencies.sh
  step 2 "building what is shown (the first time 4 minutes on two cores)"
  NINJA_STATUS="demo: step 2 of 4: file %f of %t, %e s: " scripts/build.sh "$@"
  set +u; . "${BUILD_DIR:-_b}/devel/setup.sh"; set -u
  programs=${BUILD_DIR:-_b}/devel/lib/arfm_vo  # (rosrun asks which where there is another build folder)
  mkdir -p "$output"
  output=$(realpath "$output")
  log=$output/roslaunch.log
  rm -f "$log"
}

replay() {
  local targets=(arfm_node pose_node ba_node truth_path_node camera_mount_node evaluate_trajectory) time_ms
  if [ -d "$input" ]; then targets+=(kitti_to_bag); fi
  prepare 11911 "${targets[@]}"
  if [ -d "$input" ]; then
    "$programs/kitti_to_bag" "$input" "$output/input.bag"
    input=$output/input.bag
  fi
  input=$(realpath "$input")
  rm -f "$output"{,/keyframes}/{poses,tracked}*.txt "$output"{,/keyframes}/trajectory*.tum
  step 3 "replaying $input through the nodes (its console: $log)"
  roslaunch arfm_vo replay.launch bag:="$input" rviz:=false trajectory_dir:="$output" trajectory_of_camera:=true \
    > "$log" 2>&1 || fail "roslaunch failed"
  [ -s "$output/trajectory.tum" ] || fail "the nodes saved no trajectory"
  grep -E 'WARN|ERROR|pose_node: [0-9]+ pairs' "$log" | grep -v 'assumed is tf' || true
  step 4 "comparing with the ground truth"
  time_ms=$(sed -n 's/.*_node: .*; median \([0-9.]*\) ms a pair.*/\1/p' "$log" | awk '{ sum += $1 } END { printf "%.1f", sum }')
  echo
  python3 - "$input" > "$output/truth.tum" << 'PYTHON'
import sys, rosbag
for _, truth, _ in rosbag.Bag(sys.argv[1]).read_messages(topics=["/stereo/ground_truth"]):
    p, q = truth.pose.position, truth.pose.orientation
    print(truth.header.stamp.to_sec(), p.x, p.y, p.z, q.x, q.y, q.z, q.w)
PYTHON
  if [ -s "$output/truth.tum" ]; then
    "$programs/evaluate_trajectory" "$output/trajectory.tum" "$output/truth.tum" --plot "$output/trajectory.png" > "$output/error.txt"
    awk -F': ' '{ value[$1] = $2 } END {
      printf "Error:   %.3f m (ATE) over %s pairs; at the end %.2f %% of the distance.\n",
        value["ate_rmse_m"], value["frames"], value["end_error_percent"] }' "$output/error.txt"
  else
    echo "Error:   unknown, as the recording holds no ground truth."
  fi
  echo "Time:    $time_ms ms a pair (arfm_node and pose_node)."
  if [ -s "$output/trajectory.png" ]; then echo "Picture: $output/trajectory.png"; else echo "Poses:   $output/trajectory.tum"; fi
  echo "Next:    scripts/demo.sh KITTI_FOLDER or BAG for your own recording, scripts/demo.sh --simulation for a rover that drives."
}

simulate() {
  local port
  prepare 11912 simulator_node chassis_node arfm_node pose_node ba_node truth_path_node pan_tilt_node arfm_vo_nodelets \
    arfm_vo_generate_messages_py
  port=${ROS_MASTER_URI##*:}
  rm -f "$output/drive.png"
  step 3 "starting the nodes (their console: $log)"
  roslaunch -p "$port" arfm_vo simulation.launch rviz:=false nodelets:=true max_speed_up:=5 \
    port:=$((port / 10)) picture:="$output/drive.png" > "$log" 2>&1 &
  launch=$!
  trap 'kill -INT $launch 2> /dev/null && wait $launch || true' EXIT
  until (echo > "/dev/tcp/localhost/$port") 2> /dev/null; do
    kill -0 $launch || fail "roslaunch has ended"
    sleep 0.2
  done
  step 4 "driving to x $1 m, y $2 m, heading $3 degrees"
  scripts/drive_to.py --yes "$1" "$2" "$3" 1800 || fail "the rover did not arrive"
  for _ in $(seq 100); do [ ! -s "$output/drive.png" ] || break; sleep 0.1; done
  [ -s "$output/drive.png" ] || fail "the simulator wrote no picture"
  echo "Picture: $output/drive.png"
  echo "Next:    roslaunch arfm_vo simulation.launch, for the same in rviz: click start, then a 2D Nav Goal."
}

log=
if [ "${1:-}" = --simulation ]; then
  output=${5:-_demo_simulation}
  simulate "${2:-4}" "${3:-1.5}" "${4:-90}"
else
  input=${1:-rosbag_fixtures/terrain.bag}
  output=${2:-_demo}
  [ -e "$input" ] || { echo "demo: $input: no such bag or KITTI folder" >&2; exit 1; }
  replay
fi
