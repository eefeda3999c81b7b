#!/usr/bin/python3
"""replay.launch as a user calls it, on bags of many shapes: what it does and what its console says.

Usage: replay_test.py BUILD_DIR SOURCE_DIR [ReplayTest | CameraTest]
"""
import os
import re
import sys
import unittest

import numpy as np
import rosbag
import rospy
from launch_case import FIXTURE, LaunchCase

# Each robot has a namespace, and frames of its own.
TWO_ROBOTS = """
<launch>
  <param name="use_sim_time" value="true"/>
""" + "".join("""
  <include file="$(find arfm_vo)/launch/odometry.launch">
    <arg name="namespace" value="/ROBOT"/>
    <arg name="stereo" value="/ROBOT/stereo"/>
    <arg name="base_frame" value="ROBOT/base_link"/>
    <arg name="odom_frame" value="ROBOT/odom"/>
    <arg name="map_frame" value="ROBOT/map"/>
    <arg name="camera_frame" value="ROBOT/camera"/>
    <arg name="base_from_camera" value="0 0 1 -1.5707963 0 -1.5707963"/>
    <arg name="remember_calibration" value="false"/>
    <arg name="max_held_pairs" value="40"/>
    <arg name="trajectory_dir" value="%(folder)s/ROBOT"/>
  </include>""".replace("ROBOT", robot) for robot in ("a", "b")) + """
  <node name="player" pkg="rosbag" type="play" required="true"
        launch-prefix="bash -c '&quot;$0&quot; &quot;$@&quot;; code=$?; sleep 4; exit $code'"
        args="--clock --quiet --rate=0.5 --wait-for-subscribers %(folder)s/both.bag"/>
</launch>
"""

# Whoever wants the synchronized pairs comes late.
LATE_LISTENER = """
<launch>
  <node name="stereo_sync_node" pkg="arfm_vo" type="stereo_sync_node" output="screen"/>
  <node name="player" pkg="rosbag" type="play" required="true"
        launch-prefix="bash -c '&quot;$0&quot; &quot;$@&quot;; code=$?; sleep 3; exit $code'"
        args="--quiet --wait-for-subscribers %(bag)s --topics /stereo/left/image_rect /stereo/right/image_rect
              /stereo/left/camera_info /stereo/right/camera_info"/>
  <node name="recorder" pkg="rosbag" type="record" launch-prefix="bash -c 'sleep 4; exec &quot;$0&quot; &quot;$@&quot;'"
        args="-O %(folder)s/synchronized.bag /synchronized/left/image_rect /synchronized/right/image_rect
              /synchronized/left/camera_info /synchronized/right/camera_info"/>
</launch>
"""


class ReplayCase(LaunchCase):
    def replay(self, *arguments, rate=0.5):
        """What the console says of a replay, by default so slow that a busy machine drops no pair."""
        code, console = self.launch("replay.launch", "rviz:=false", "end_delay_s:=3", f"rate:={rate}", *arguments)
        self.assertEqual(code, 0, console)
        return console


class ReplayTest(ReplayCase):
    def test_paths_relative_to_the_caller_are_resolved_and_the_totals_are_told(self):
        os.symlink(FIXTURE, os.path.join(self.folder, "my drive.bag"))
        console = self.replay("bag:=my drive.bag", "trajectory_dir:=out")
        self.assertIn("the first pose is there", console)
        self.assertIn("36 pairs: 36 with a pose, 0 lost", console)
        self.assertIn(f"36 poses saved in {self.folder}/out/poses.txt", console)
        self.assertTrue(os.path.exists(os.path.join(self.folder, "out", "trajectory.tum")))
        self.assertIn("assumed is tf base_link <- left_camera_optical", console)

    def test_the_mount_in_the_tf_of_the_bag_goes_before_the_assumed_one(self):
        from geometry_msgs.msg import TransformStamped
        from tf2_msgs.msg import TFMessage
        self.write_bag("tf.bag", lambda topic, message: (topic, message))
        mount = TransformStamped()
        mount.header.stamp = rospy.Time(1000)
        mount.header.frame_id, mount.child_frame_id = "base_link", "left_camera_optical"
        mount.transform.rotation.w = 1
        with rosbag.Bag(os.path.join(self.folder, "tf.bag"), "a") as bag:
            bag.write("/tf_static", TFMessage([mount]), rospy.Time(1000))
        console = self.replay("bag:=tf.bag")
        self.assertIn("36 pairs: 36 with a pose", console)
        self.assertNotIn("assumed is", console)

    def test_no_pair_is_lost_before_somebody_listens_to_the_synchronized_ones(self):
        launch = os.path.join(self.folder, "late.launch")
        with open(launch, "w") as file:
            file.write(LATE_LISTENER % {"folder": self.folder, "bag": FIXTURE})
        code, console = self.launch(launch, package=())
        self.assertEqual(code, 0, console)
        self.assertIn("36 pairs, 0 images without partner", console)
        with rosbag.Bag(os.path.join(self.folder, "synchronized.bag")) as bag:
            counts = {topic: info.message_count for topic, info in bag.get_type_and_topic_info().topics.items()}
        self.assertEqual(list(counts.values()), [36] * 4, counts)

    def test_a_bag_at_twice_its_speed_keeps_its_pose(self):
        console = self.replay("bag:=" + FIXTURE, rate=2)
        pairs, tracked, lost = map(int, re.search(r"(\d+) pairs: (\d+) with a pose, (\d+) lost", console).groups())
        self.assertGreaterEqual(pairs, 10, console)  # a busy machine drops some
        self.assertEqual((tracked, lost), (pairs, 0), console)

    def test_an_interrupted_replay_ends_all_that_it_has_started(self):
        _, console = self.launch("replay.launch", "rviz:=false", "bag:=" + FIXTURE, "rate:=0.1", limit_s=20)
        self.assertIn("[master] killing on exit", console)

    def test_a_bag_in_a_loop_begins_anew_each_time_and_saves_each(self):
        _, console = self.launch("replay.launch", "rviz:=false", "bag:=" + FIXTURE, "loop:=true", "rate:=0.5", "trajectory_dir:=out", limit_s=36)
        self.assertIn("time jumped back", console)
        for name in "trajectory.tum", "trajectory_2.tum":
            with open(os.path.join(self.folder, "out", name)) as file:
                self.assertGreater(sum(not line.startswith("#") for line in file), 30, name)

    def test_two_robots_on_one_master_do_not_touch_each_other(self):
        with rosbag.Bag(FIXTURE) as source, rosbag.Bag(os.path.join(self.folder, "both.bag"), "w") as bag:
            for topic, message, stamp in source.read_messages():
                for robot in ("/a", "/b") if "ground_truth" not in topic else ():
                    bag.write(robot + topic, message, stamp)
        with open(os.path.join(self.folder, "both.launch"), "w") as file:
            file.write(TWO_ROBOTS % {"folder": self.folder})
        code, console = self.launch("both.launch", package=())
        self.assertEqual(code, 0, console)
        rows = []
        for robot in "a", "b":
            self.assertIn(f"tf {robot}/base_link <- {robot}/camera", console)
            table = np.loadtxt(os.path.join(self.folder, robot, "trajectory.tum"))
            rows.append({row[0]: row[1:4] for row in table})
        self.assertEqual(console.count(" 0 lost"), 2, console)
        common = sorted(set(rows[0]) & set(rows[1]))  # a busy machine drops some
        self.assertGreater(len(common), 10, console)
        ways_m = [np.linalg.norm(row[common[-1]] - row[common[0]]) for row in rows]
        self.assertGreater(ways_m[0], 0.5)
        self.assertAlmostEqual(ways_m[0], ways_m[1], delta=0.02)


class CameraTest(ReplayCase):
    """Bags as other cameras record them."""

    def replay_renamed(self, left, right, image, frame):
        """Replays the fixture as the camera of the namespaces `left` and `right` would record it."""
        names = {"/stereo/left/image_rect": f"{left}/{image}",
                 "/stereo/right/image_rect": f"{right}/{image}",
                 "/stereo/left/camera_info": f"{left}/camera_info",
                 "/stereo/right/camera_info": f"{right}/camera_info"}

        def rename(topic, message):
            message.header.frame_id = frame
            return (names[topic], message) if topic in names else None

        self.write_bag("renamed.bag", rename)
        console = self.replay(
            "bag:=renamed.bag", f"left_image:={left}/{image}", f"right_image:={right}/{image}",
            f"left_info:={left}/camera_info", f"right_info:={right}/camera_info",
            "base_from_camera:=0.1 0 0.5 -1.5707963 0 -1.5707963")
        self.assertIn("36 pairs: 36 with a pose", console)
        self.assertIn("tf base_link <- " + frame, console)
        self.assertNotIn("assumed is", console)

    def test_a_realsense_is_replayed_by_its_topics_with_base_from_camera_alone(self):
        self.replay_renamed("/camera/infra1", "/camera/infra2", "image_rect_raw", "camera_infra1_optical_frame")

    def test_a_zed_is_replayed_by_its_topics(self):
        self.replay_renamed("/zed/zed_node/left", "/zed/zed_node/right", "image_rect_gray", "zed_left_camera_optical_frame")

    def test_a_bag_of_kitti2bag_is_replayed_by_its_topics(self):
        self.replay_renamed("/kitti/camera_gray_left", "/kitti/camera_gray_right", "image_raw", "camera_gray_left")

    def test_stamps_that_differ_are_told_and_paired_on_demand(self):
        def delay_right(topic, message):
            if "/right/" in topic:
                message.header.stamp += rospy.Duration(0.002)
            return topic, message

        self.write_bag("apart.bag", delay_right)
        console = self.replay("bag:=apart.bag")
        self.assertIn("2.000 ms apart", console)
        self.assertIn("approx_sync:=true", console)
        self.assertIn("36 pairs: 36 with a pose", self.replay("bag:=apart.bag", "approx_sync:=true", "max_skew_s:=0.005"))

    def test_raw_images_are_told_and_rectified_on_demand(self):
        self.write_bag("raw.bag", lambda topic, message: (topic.replace("image_rect", "image_raw"), message))
        self.assertIn("give rectify:=true", self.refuse("bag:=raw.bag"))
        self.assertIn("36 pairs: 36 with a pose", self.replay("bag:=raw.bag", "rectify:=true"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
