#!/usr/bin/env bash
# A stereo sequence through the real driver, rectification, matcher and pose node: the fixture's pairs are shown on two
# v4l2loopback cameras. To be run where these are.
# Usage: test/hardware/chain.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
[[ -e /dev/video10 && -e /dev/video11 ]] || { echo "no test cameras here" >&2; exit 1; }
export PATH=/usr/bin:$PATH ROS_MASTER_URI=http://localhost:11311 ROS_HOME=/tmp/ros HOME=/tmp
build=${BUILD_DIR:-_b}
set +u; . "$build/devel/setup.sh"; set -u
work=$(mktemp -d)
# 1 pair in 2.5 s: the machine has no hardware acceleration.
"$build/devel/lib/arfm_vo/loopback_player" rosbag_fixtures/terrain.bag "$work" --pairs 12 --rate 0.4 --wait 120 &
player=$!
until [[ -s $work/right.yaml ]]; do sleep 0.5; kill -0 $player; done
cat > "$work/camera.yaml" <<YAML
left_device: /dev/video10
right_device: /dev/video11
video: {pixel_format: GREY, width: 480, height: 360, rate_hz: 0.4}
max_skew_s: 0.2
frame_timeout_s: 30
left_camera_info_url: file://$work/left.yaml
right_camera_info_url: file://$work/right.yaml
YAML
cat > "$work/chain.launch" <<LAUNCH
<launch>
  <include file="\$(find arfm_vo)/launch/camera.launch"><arg name="config" value="$work/camera.yaml"/></include>
  <include file="\$(find arfm_vo)/launch/odometry.launch">
    <arg name="global_adjustment" value="false"/>
    <arg name="base_from_camera" value="0 0 0 0 0 0"/>
    <arg name="camera_frame" value="left_camera_optical"/>
    <arg name="trajectory_dir" value="$work/trajectory"/>
  </include>
</launch>
LAUNCH
roslaunch "$work/chain.launch" > "$work/log" 2>&1 &
launch=$!
trap 'kill $launch $player 2>/dev/null || true' EXIT
wait $player
kill -INT $launch; wait $launch || true
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
