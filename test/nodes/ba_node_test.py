#!/usr/bin/python3
"""ba_node's tf: on a clock that jumps and stands still, and where a person states the rover's place."""
import math
import time
import unittest

import rospy
import rostest
from arfm_vo.msg import KeyframeStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage


class BaNodeTest(unittest.TestCase):
    def test_no_transform_is_sent_twice_with_the_same_stamp(self):
        stamps = []
        rospy.Subscriber("/tf", TFMessage, lambda message: stamps.extend(
            transform.header.stamp for transform in message.transforms))
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        now_s, end = 1000, time.monotonic() + 60
        while len(set(stamps)) < 20 and time.monotonic() < end:
            now_s += 1  # 20 periods of the transform in one
            clock.publish(Clock(clock=rospy.Time(now_s)))
            time.sleep(0.02)
        self.assertGreaterEqual(len(set(stamps)), 20)
        self.assertEqual(sorted(set(stamps)), stamps)

    def test_the_map_moves_to_where_a_person_states_the_rover_to_stand(self):
        transforms = []
        rospy.Subscriber("/tf", TFMessage, lambda message: transforms.extend(message.transforms))
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        odom = rospy.Publisher("odom", Odometry, queue_size=1)
        stated = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        odometry = Odometry()  # at (1, 2), looking along y
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = 1, 2
        odometry.pose.pose.orientation.z = odometry.pose.pose.orientation.w = math.sqrt(0.5)
        pose = PoseWithCovarianceStamped()  # stands at (10, 20), looking along x
        pose.header.frame_id = "map"
        pose.pose.pose.position.x, pose.pose.pose.position.y = 10, 20
        pose.pose.pose.orientation.w = 1

        def is_moved():
            """Whether map -> odom takes (1, 2) to (10, 20) and turns by -90 degrees."""
            move = transforms[-1].transform if transforms else None
            return move and abs(move.translation.x - 8) < 1e-9 and abs(move.translation.y - 21) < 1e-9 and \
                abs(abs(move.rotation.w) - math.sqrt(0.5)) < 1e-9 and move.rotation.z * move.rotation.w < 0

        now_s, end = 5000, time.monotonic() + 60
        while not is_moved() and time.monotonic() < end:
            now_s += 0.1
            clock.publish(Clock(clock=rospy.Time(now_s)))
            odom.publish(odometry)
            stated.publish(pose)
            time.sleep(0.05)
        self.assertTrue(is_moved(), transforms[-1:])

    def test_a_malformed_keyframe_is_refused_by_name(self):
        told = []
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: told.extend(
            status for status in message.status if "global adjustment" in status.name))
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        keyframes = rospy.Publisher("keyframe", KeyframeStamped, queue_size=1)

        def is_refused():
            return any(status.level == DiagnosticStatus.ERROR and "keyframe refused: stereo camera: fx" in status.message
                       for status in told)

        now_s, end = 9000, time.monotonic() + 60
        while not is_refused() and time.monotonic() < end:
            now_s += 0.5
            clock.publish(Clock(clock=rospy.Time(now_s)))
            keyframes.publish(KeyframeStamped())  # without a camera
            time.sleep(0.1)
        self.assertTrue(is_refused(), told[-1:])


if __name__ == "__main__":
    rospy.init_node("ba_node_tf")
    rostest.rosrun("arfm_vo", "ba_node_tf", BaNodeTest)
