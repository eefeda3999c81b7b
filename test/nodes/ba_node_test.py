#!/usr/bin/python3
"""ba_node's tf: on a clock that jumps and stands still, and where a person states the rover's place."""
import math
import time
import unittest

import rospy
import rostest
from arfm_vo.msg import KeyframeStamped, MapUpdateStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage


def make_keyframe(number):
    """Keyframe `number` of a camera that drives 0.3 m each towards 48 points; the first one brings the points."""
    keyframe = KeyframeStamped(epoch=1, id=number)
    keyframe.header.stamp = rospy.Time(100 + number)
    keyframe.header.frame_id = "odom"
    camera = keyframe.camera
    camera.fx = camera.fy = 700
    camera.cx, camera.cy, camera.baseline_m, camera.width, camera.height = 600, 180, 0.5, 1226, 370
    for transform in keyframe.odom_from_world, keyframe.base_from_camera, keyframe.camera_from_world:
        transform.rotation.w = 1
    way_m = 0.3 * number
    keyframe.camera_from_world.translation.z = -way_m
    for landmark in range(48):
        x, y, z = landmark % 8 - 3.5, 0.4 * (landmark // 8) - 1, 12 + landmark % 5
        u, v = 600 + 700 * x / (z - way_m), 180 + 700 * y / (z - way_m)
        keyframe.observation_landmark.append(landmark)
        keyframe.observation_pixels += [u, v, u - 700 * 0.5 / (z - way_m), v]
        keyframe.observation_has_right.append(True)
        keyframe.observation_sigma.append(0.3)
        if number == 0:
            keyframe.landmark_id.append(landmark)
            keyframe.landmark_position += [x, y, z]
            keyframe.landmark_laplacian_sign.append(1)
            keyframe.landmark_descriptors += [1.0] + 63 * [0.0]
    return keyframe


class BaNodeTest(unittest.TestCase):
    def step_until(self, condition, now_s, step_s, *outputs):
        """Sets /clock on by steps, and publishes each of the (publisher, message), until the condition holds or a minute is over."""
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        end = time.monotonic() + 60
        while not condition() and time.monotonic() < end:
            now_s += step_s
            clock.publish(Clock(clock=rospy.Time(now_s)))
            for publisher, message in outputs:
                publisher.publish(message)
            time.sleep(0.03)

    def test_no_transform_is_sent_twice_with_the_same_stamp(self):
        stamps = []
        rospy.Subscriber("/tf", TFMessage, lambda message: stamps.extend(transform.header.stamp for transform in message.transforms))
        self.step_until(lambda: len(set(stamps)) >= 20, 1000, 1)  # 20 periods of the transform in one
        self.assertGreaterEqual(len(set(stamps)), 20)
        self.assertEqual(sorted(set(stamps)), stamps)

    def test_the_map_moves_to_where_a_person_states_the_rover_to_stand(self):
        transforms = []
        rospy.Subscriber("/tf", TFMessage, lambda message: transforms.extend(message.transforms))
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

        self.step_until(is_moved, 5000, 0.1, (odom, odometry), (stated, pose))
        self.assertTrue(is_moved(), transforms[-1:])

    def test_a_malformed_keyframe_is_refused_by_name(self):
        told = []
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: told.extend(
            status for status in message.status if "global adjustment" in status.name))
        keyframes = rospy.Publisher("keyframe", KeyframeStamped, queue_size=1)

        def is_refused():
            return any(status.level == DiagnosticStatus.ERROR and "keyframe refused: stereo camera: fx" in status.message
                       for status in told)

        self.step_until(is_refused, 9000, 0.5, (keyframes, KeyframeStamped()))  # without a camera
        self.assertTrue(is_refused(), told[-1:])

    def test_the_map_is_adjusted_to_its_last_keyframe_once_none_comes_and_the_odometry_is_not_told(self):
        adjustments, updates = [], []
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: adjustments.extend(
            int(value.value) for status in message.status if "global adjustment" in status.name
            for value in status.values if value.key == "adjustments"))
        listener = rospy.Subscriber("map_update", MapUpdateStamped, updates.append)
        keyframes = rospy.Publisher("keyframe", KeyframeStamped, queue_size=10)
        end = time.monotonic() + 60
        while time.monotonic() < end and not (keyframes.get_num_connections() and listener.get_num_connections() and adjustments):
            time.sleep(0.05)
        for number, num_updates in enumerate((0, 1, 2, 3, 3)):  # adjustments are due at 2, 3, 4 and 6 keyframes
            keyframes.publish(make_keyframe(number))
            while len(updates) < num_updates and time.monotonic() < end:  # one that is late would adjust for two
                time.sleep(0.02)
        while (not adjustments or adjustments[-1] < 4) and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(adjustments[-1], 4)
        self.assertEqual([update.num_keyframes for update in updates], [2, 3, 4])


if __name__ == "__main__":
    rospy.init_node("ba_node_tf")
    rostest.rosrun("arfm_vo", "ba_node_tf", BaNodeTest)
