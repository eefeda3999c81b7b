#!/usr/bin/env bash
# A stereo sequence through the real driver, rectification, matcher and pose node: the fixture's pairs are shown on two
# v4l2loopback cameras. To be run where these are.
# Usage: test/hardware/chain.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
[[ -e /dev/video10 && -e /dev/video11 ]] || { echo "no test cameras here" >&2; exit 1; }
export PATH=/usr/bin:$PATH ROS_MASTER_URI=http://localhost:11311 ROS_HOSTNAME=localhost ROS_HOME=/tmp/ros HOME=/tmp
build=${BUILD_DIR:-_b}
set +u; . "$build/devel/setup.sh"; set -u
work=$(mktemp -d)
programs=$build/devel/lib/arfm_vo
# One after the other, without roslaunch: Python takes a minute to start here.
jobs=()
start() { "$@" >> "$work/log" 2>&1 & jobs+=($!); }
trap 'kill "${jobs[@]}" 2> /dev/null || true' EXIT
fail() { echo "$*"; tail -40 "$work/log"; exit 1; }
start rosmaster --core
until (echo > /dev/tcp/localhost/11311) 2> /dev/null; do sleep 0.5; kill -0 "${jobs[0]}" || fail "no master"; done
# At most 1 pair a second: the machine has no hardware acceleration.
start "$programs/loopback_player" rosbag_fixtures/terrain.bag "$work" --pairs 12
player=${jobs[-1]}
until [[ -s $work/right.yaml ]]; do sleep 0.5; kill -0 "$player" || fail "nothing is shown"; done
start /usr/lib/tf2_ros/static_transform_publisher 0 0 0 0 0 0 base_link left_camera_optical
start "$programs/pose_node" _camera_frame:=left_camera_optical _trajectory_dir:="$work/trajectory" _tf_timeout_s:=10
pose_node=${jobs[-1]}
start "$programs/arfm_node"
start env ROS_NAMESPACE=/stereo /usr/lib/stereo_image_proc/stereo_image_proc
start env ROS_NAMESPACE=/stereo "$programs/stereo_camera_node" _left_device:=/dev/video10 _right_device:=/dev/video11 \
  _video/pixel_format:=GREY _video/width:=480 _video/height:=360 _video/rate_hz:=1 _max_skew_s:=0.2 \
  _frame_timeout_s:=30 _left_camera_info_url:="file://$work/left.yaml" _right_camera_info_url:="file://$work/right.yaml"
wait "$player" || fail "the chain does not answer"
kill -INT "$pose_node"; wait "$pose_node" || true
[[ -s $work/trajectory/poses.txt ]] || fail "no trajectory"
# KITTI poses: the last column of each row of three is the position.
awk 'FNR == NR {x = $2; y = $3; z = $4; next}
  {n++; ex = $4 - x; ey = $8 - y; ez = $12 - z}
  END {
    way = sqrt(x * x + y * y + z * z); error = sqrt(ex * ex + ey * ey + ez * ez)
    print "| pairs with a pose | way, m | error at its end, mm | % |"; print "|---|---|---|---|"
    printf "| %d | %.3f | %.2f | %.4f |\n", n, way, 1000 * error, 100 * error / way
    exit !(n >= 12 && way > 0.5 && error < 0.02 * way)
  }' "$work/truth.txt" "$work/trajectory/poses.txt" || fail "the pose is wrong"
