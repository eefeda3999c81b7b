#!/usr/bin/python3
"""Starts chassis_node, sends it one goal in the map and waits for what becomes of it.

Asks before it starts the rover. On a time-out and on Ctrl-C it stops the rover and drops the goal.
Exit status 0 where the goal was reached.
"""
import argparse
import math
import sys
import threading
import time

import rospy
from arfm_vo.msg import DriveStatus, GoalReport
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger


PATIENCE_S = 60  # with the start-up check: the exposure settles, and nodes come up, meanwhile


def make_goal(x_m, y_m, heading_deg):
    goal = PoseStamped()
    goal.header.frame_id = "map"
    goal.header.stamp = rospy.Time.now()
    goal.pose.position.x = x_m
    goal.pose.position.y = y_m
    goal.pose.orientation.z = math.sin(math.radians(heading_deg) / 2)
    goal.pose.orientation.w = math.cos(math.radians(heading_deg) / 2)
    return goal


def call(service):
    answer = rospy.ServiceProxy("chassis_node/" + service, Trigger)()
    print("%s: %s" % (service, answer.message))
    return answer.success


class Errand:
    """One drive to a goal. Timeouts are wall time: simulated time may stand still."""

    def __init__(self):
        self.done, self.has_pose = threading.Event(), threading.Event()
        self.is_sent = False
        self.status = self.goal = self.report = self.truth = None
        # Not latched: a goal is for now, not for whoever comes later.
        self.goals = rospy.Publisher("goal", PoseStamped, queue_size=1)
        rospy.Subscriber("goal_report", GoalReport, self.take_report)
        rospy.Subscriber("base_truth", Odometry, lambda truth: setattr(self, "truth", truth.pose.pose.position))
        rospy.Subscriber("drive_status", DriveStatus, lambda status: setattr(self, "status", status))
        rospy.Subscriber("odom", Odometry, lambda _: self.has_pose.set())

    def take_report(self, report):
        if self.is_sent and report.result != GoalReport.REPLACED:
            self.report = report
            self.done.set()

    def start(self, timeout_s):
        end_s = time.monotonic() + timeout_s
        # Not before there is a pose: a rover that is started without one is blocked soon.
        for condition, what in ((lambda: self.status, "nothing on drive_status"), (self.has_pose.is_set, "nothing on odom"),
                                (self.goals.get_num_connections, "nobody takes goals")):
            while not condition():
                if time.monotonic() > end_s:
                    print("start: %s within %g s" % (what, timeout_s))
                    return False
                time.sleep(0.01)
        while not rospy.ServiceProxy("chassis_node/check", Trigger)().success and time.monotonic() < end_s - timeout_s + PATIENCE_S:
            time.sleep(0.1)
        return call("check") and call("start") and self.wait_until_ready(end_s)

    def wait_until_ready(self, end_s):
        """The chassis takes commands, and the pose is one to drive by: a goal is refused before."""
        started = rospy.Time.now()
        while time.monotonic() < end_s:
            status = self.status
            if status.header.stamp >= started:
                if status.state in (DriveStatus.READY, DriveStatus.WARNING, DriveStatus.DRIVING):
                    return True
                if status.state == DriveStatus.BLOCKED:
                    break
            time.sleep(0.02)
        print("start: not ready: %s (%s)" % (self.status.state_text, self.status.reason))
        call("stop")
        return False

    def send(self, x_m, y_m, heading_deg):
        self.goal = make_goal(x_m, y_m, heading_deg)
        self.is_sent = True
        self.goals.publish(self.goal)

    def error_m(self):
        """By the truth, where a simulation tells it."""
        position = self.goal.pose.position
        return math.hypot(position.x - self.truth.x, position.y - self.truth.y)

    def run(self, x_m, y_m, heading_deg, timeout_s):
        has_ended = False
        try:
            if not self.start(timeout_s):
                has_ended = True
                return False
            self.send(x_m, y_m, heading_deg)
            has_ended = self.done.wait(timeout_s)
        finally:  # whatever ends the wait: a time-out, Ctrl-C, a lost master
            if not has_ended:
                print("outcome: no answer within %g s, or interrupted" % timeout_s)
                call("stop")
        if not has_ended:
            return False
        print("outcome:", self.report.text)
        print("error_by_sight_m: %.3f" % self.report.position_error_m)
        if self.truth is not None:
            print("error_m: %.3f" % self.error_m())
        return self.report.result == GoalReport.ARRIVED


def is_agreed():
    """A person says that the rover may move."""
    try:
        return input("The rover will drive. Is the way free, and an operator at the stop? [y/N] ").strip() == "y"
    except EOFError:
        return False


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("x_m", type=float)
    parser.add_argument("y_m", type=float)
    parser.add_argument("heading_deg", type=float)
    parser.add_argument("timeout_s", type=float, nargs="?", default=600)
    parser.add_argument("--yes", action="store_true", help="do not ask before the rover is started")
    arguments = parser.parse_args(rospy.myargv()[1:])
    if not arguments.yes and not is_agreed():
        print("not started: nobody agreed (see --yes)")
        return 1
    # Ctrl-C must reach the wait below, which then stops the rover while the node still lives.
    rospy.init_node("drive_to", anonymous=True, disable_signals=True)
    errand = Errand()
    try:
        return 0 if errand.run(arguments.x_m, arguments.y_m, arguments.heading_deg, arguments.timeout_s) else 1
    except KeyboardInterrupt:
        return 1


if __name__ == "__main__":
    sys.exit(main())
