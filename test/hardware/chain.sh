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
# 1 pair in 2.5 s: the machine has no hardware acceleration.
"$build/devel/lib/arfm_vo/loopback_player" rosbag_fixtures/terrain.bag "$work" --pairs 12 --rate 0.4 --wait 120 &
player=$!
until [[ -s $work/right.yaml ]]; do sleep 0.5; kill -0 $player; done
# One after the other, without roslaunch: Python takes a minute to start here.
rosmaster --core > "$work/master.log" 2>&1 &
master=$!
nodes=()
trap 'kill "${nodes[@]}" $master $player 2> /dev/null || true' EXIT
until (echo > /dev/tcp/localhost/11311) 2> /dev/null; do sleep 0.5; kill -0 $master; done
start() { "$@" >> "$work/log" 2>&1 & nodes+=($!); }
programs=$build/devel/lib/arfm_vo
start /usr/lib/tf2_ros/static_transform_publisher 0 0 0 0 0 0 base_link left_camera_optical
start "$programs/pose_node" _camera_frame:=left_camera_optical _trajectory_dir:="$work/trajectory"
pose_node=${nodes[-1]}
start "$programs/arfm_node"
start env ROS_NAMESPACE=/stereo /usr/lib/stereo_image_proc/stereo_image_proc
start env ROS_NAMESPACE=/stereo "$programs/stereo_camera_node" _left_device:=/dev/video10 _right_device:=/dev/video11 \
  _video/pixel_format:=GREY _video/width:=480 _video/height:=360 _video/rate_hz:=0.4 _max_skew_s:=0.2 \
  _frame_timeout_s:=30 _left_camera_info_url:="file://$work/left.yaml" _right_camera_info_url:="file://$work/right.yaml"
wait $player
kill -INT $pose_node; wait $pose_node || true
# KITTI poses: the last column of each row of three is the position.
if ! [[ -s $work/trajectory/poses.txt ]]; then tail -40 "$work/log"; exit 1; fi
awk 'FNR == NR {x = $2; y = $3; z = $4; next}
  {n++; ex = $4 - x; ey = $8 - y; ez = $12 - z}
  END {
    way = sqrt(x * x + y * y + z * z); error = sqrt(ex * ex + ey * ey + ez * ez)
    print "| pairs with a pose | way, m | error at its end, m | % |"; print "|---|---|---|---|"
    printf "| %d | %.3f | %.4f | %.2f |\n", n, way, error, 100 * error / way
    exit !(n >= 12 && way > 0.5 && error < 0.02 * way)
  }' "$work/truth.txt" "$work/trajectory/poses.txt" || { tail -20 "$work/log"; exit 1; }
