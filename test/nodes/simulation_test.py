#!/usr/bin/python3
"""The simulated rover drives to a goal by sight alone through all the nodes."""
import pathlib
import sys
import unittest

import rospy
import rostest
from arfm_vo.msg import DriveStatus

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from drive_to import Errand  # noqa: E402


class SimulationTest(unittest.TestCase):
    def test_drives_to_a_goal_by_sight(self):
        speeds = []
        rospy.Subscriber("drive_status", DriveStatus, lambda status: speeds.append(abs(status.forward_mps)))
        errand = Errand()
        self.assertTrue(errand.run(0.8, 0.2, 30, timeout_s=280), errand.report)
        self.assertLess(errand.error_m(), 0.01 * 0.8 + 0.05)
        self.assertGreater(max(speeds), 0.05)
        self.assertLessEqual(max(speeds), 0.1)


if __name__ == "__main__":
    rospy.init_node("simulation_test")
    rostest.rosrun("arfm_vo", "simulation", SimulationTest)
