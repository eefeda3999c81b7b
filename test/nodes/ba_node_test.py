#!/usr/bin/python3
"""ba_node's tf on a clock that jumps and stands still."""
import time
import unittest

import rospy
import rostest
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


if __name__ == "__main__":
    rospy.init_node("ba_node_tf")
    rostest.rosrun("arfm_vo", "ba_node_tf", BaNodeTest)
