#!/usr/bin/python3
"""The simulated rover sees, pans its head and drives to a goal by sight alone, through all the nodes."""
import math
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import roslib.packages
import rosservice
import rospy
import rostest
from arfm_vo.msg import DriveStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
from drive_to import Errand  # noqa: E402

PATIENCE_S = 120
MAX_COVARIANCE = 1  # a pose that is lost has thousands


def turn_between(a, b):
    """The angle between two orientations, rad."""
    dot = abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w)
    return 2 * math.acos(min(1.0, dot))


def way_between(a, b):
    return math.sqrt((a.x - b.x) ** 2 + (a.y - b.y) ** 2 + (a.z - b.z) ** 2)


class Head:
    """The pan-tilt unit, and where the camera truly is."""

    def __init__(self):
        self.is_settled = False
        self.angles = {}
        self.camera = None
        self.commands = rospy.Publisher("/head/cmd", JointState, queue_size=1, latch=True)
        self.subscribers = [
            rospy.Subscriber("/head/settled", Bool, lambda message: setattr(self, "is_settled", message.data)),
            rospy.Subscriber("/joint_states", JointState, lambda message: self.angles.update(zip(message.name, message.position))),
            rospy.Subscriber("/stereo/ground_truth", PoseStamped, lambda message: setattr(self, "camera", message.pose))]

    def send(self, pan_rad, tilt_rad):
        self.commands.publish(JointState(name=["pan", "tilt"], position=[pan_rad, tilt_rad]))

    def is_at(self, pan_rad, tilt_rad):
        return self.is_settled and all(
            abs(self.angles.get(name, math.inf) - angle) < 0.01 for name, angle in (("pan", pan_rad), ("tilt", tilt_rad)))


class SimulationTest(unittest.TestCase):
    def setUp(self):
        self.poses = []
        self.odometry = rospy.Subscriber("odom", Odometry, self.take_odometry)
        self.head = Head()
        self.wait(lambda: self.head.is_settled and self.head.camera, "the head and the first pair")
        self.head.send(0, 0)
        self.wait(lambda: self.head.is_at(0, 0), "the head ahead")

    def tearDown(self):
        for subscriber in [self.odometry] + self.head.subscribers:
            subscriber.unregister()

    def take_odometry(self, odometry):
        if odometry.pose.covariance[0] < MAX_COVARIANCE:
            self.poses.append(odometry.pose.pose)

    def wait(self, condition, what):
        end = time.monotonic() + PATIENCE_S
        while not condition():
            self.assertLess(time.monotonic(), end, "waited in vain for " + what)
            time.sleep(0.01)

    def go_on(self, num_poses):
        seen = len(self.poses)
        self.wait(lambda: len(self.poses) >= seen + num_poses, "%d poses" % num_poses)

    def test_panning_the_head_leaves_the_parked_base_where_it_is(self):
        self.go_on(3)
        first, camera = self.poses[-1], self.head.camera
        del self.poses[:-1]
        self.head.send(0.5, -0.1)
        self.wait(lambda: self.head.is_at(0.5, -0.1), "the head to the left")
        self.go_on(3)
        # The pictures are taken where the head looks: else the base would seem to turn.
        self.assertAlmostEqual(turn_between(camera.orientation, self.head.camera.orientation), 0.51, delta=0.02)
        self.head.send(0, 0)
        self.wait(lambda: self.head.is_at(0, 0), "the head ahead")
        self.go_on(3)
        self.assertLess(turn_between(camera.orientation, self.head.camera.orientation), 0.01)
        self.assertGreater(len(self.poses), 10)
        ways = [way_between(first.position, pose.position) for pose in self.poses]
        turns = [turn_between(first.orientation, pose.orientation) for pose in self.poses]
        print("head: %d poses, base moves %.1f mm and turns %.2f deg at most" % (len(ways), 1000 * max(ways), math.degrees(max(turns))))
        self.assertLess(max(ways), 0.03)
        self.assertLess(math.degrees(max(turns)), 1)

    @staticmethod
    def chassis_node():
        """Of this build tree; rosrun asks which one where the package holds two."""
        return roslib.packages.find_node("arfm_vo", "chassis_node")[0]

    def test_simulated_time_is_refused_on_a_real_bus(self):
        answer = subprocess.run([self.chassis_node(), "__name:=real", "_can:=can0"],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=PATIENCE_S)
        self.assertNotEqual(answer.returncode, 0)
        self.assertIn("'can0' is a real bus", answer.stdout)

    def test_before_the_first_clock_the_chassis_takes_no_start(self):
        node = subprocess.Popen(
            [self.chassis_node(), "__name:=early", "/clock:=/early/clock", "_can:=udp:14901:14902"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)
        said = next((line for line in node.stdout if "/early/clock" in line), "")
        self.assertIn("nothing comes on /early/clock", said)
        with self.assertRaises(rospy.ROSException):
            rospy.wait_for_service("/early/start", timeout=0.5)
        clock = rospy.Publisher("/early/clock", Clock, queue_size=1, latch=True)
        clock.publish(rospy.Time(1000))
        self.wait(lambda: any(name == "/early/start" for name in rosservice.get_service_list()), "the service")

    def test_drives_to_a_goal_by_sight_while_the_head_moves(self):
        speeds = []

        def take_status(status):
            speeds.append(abs(status.forward_mps))
            if speeds[-1] > 0.09 >= max(speeds[:-1], default=0):
                self.head.send(0.3, 0)

        rospy.Subscriber("drive_status", DriveStatus, take_status)
        errand = Errand()
        self.assertTrue(errand.run(0.8, 0.2, 30, timeout_s=280), errand.report)
        self.assertLess(errand.error_m(), 0.01 * 0.8 + 0.05)
        self.assertGreater(max(speeds), 0.05)
        self.assertLessEqual(max(speeds), 0.1)
        self.wait(lambda: self.head.is_at(0.3, 0), "the head")
        print("drive: error %.1f mm" % (1000 * errand.error_m()))

    def test_stops_when_the_wait_for_a_drive_is_interrupted(self):
        """Ctrl-C and a time-out end the wait of drive_to.py in the same way."""
        told = []
        rospy.Subscriber("drive_status", DriveStatus, told.append)
        errand = Errand()

        def interrupt(_):
            self.wait(lambda: told and told[-1].forward_mps > 0.05, "the rover to drive")
            raise KeyboardInterrupt

        errand.done.wait = interrupt
        with self.assertRaises(KeyboardInterrupt):
            errand.run(3, 0, 0, timeout_s=PATIENCE_S)
        self.wait(lambda: told[-1].state == DriveStatus.STANDBY and not told[-1].has_goal, "the stop")

    def test_an_operator_answers_until_stopped_or_the_terminal_is_gone_and_stops_the_rover(self):
        told = []
        rospy.Subscriber("drive_status", DriveStatus, told.append)
        operator = subprocess.Popen([sys.executable, SCRIPTS / "operator_answer.py"], stdin=subprocess.PIPE,
                                    stdout=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(operator.wait)
        self.addCleanup(operator.kill)
        self.wait(lambda: told and told[-1].operator_round_trip_s < 0.5, "answers in time")
        for number, is_answered in (signal.SIGSTOP, False), (signal.SIGCONT, True):
            operator.send_signal(number)
            self.wait(lambda: (told[-1].operator_round_trip_s < 0.5) == is_answered, "what signal %d does" % number)
        said, _ = operator.communicate("\n", timeout=PATIENCE_S)  # Enter, then the terminal is gone
        self.assertEqual(said.count("stop: stopped"), 2, said)
        self.wait(lambda: math.isnan(told[-1].operator_round_trip_s), "the end of the answers")


if __name__ == "__main__":
    rospy.init_node("simulation_test")
    rostest.rosrun("arfm_vo", "simulation", SimulationTest)
