#!/usr/bin/python3
"""Starts chassis_node, sends it one goal in the map and waits for what becomes of it.

Usage: drive_to.py X_M Y_M HEADING_DEG [TIMEOUT_S]      exit status 0 where the goal was reached
"""
import math
import sys
import threading

import rospy
from arfm_vo.msg import DriveStatus, GoalReport
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger


def make_goal(x_m, y_m, heading_deg):
    goal = PoseStamped()
    goal.header.frame_id = "map"
    goal.pose.position.x = x_m
    goal.pose.position.y = y_m
    goal.pose.orientation.z = math.sin(math.radians(heading_deg) / 2)
    goal.pose.orientation.w = math.cos(math.radians(heading_deg) / 2)
    return goal


class Errand:
    """One drive to a goal. Timeouts are wall time: simulated time may stand still."""

    def __init__(self):
        self.done = threading.Event()
        self.has_status, self.has_pose = threading.Event(), threading.Event()
        self.is_sent = False
        self.goal = self.report = self.truth = None
        self.goals = rospy.Publisher("goal", PoseStamped, queue_size=1, latch=True)
        rospy.Subscriber("goal_report", GoalReport, self.take_report)
        rospy.Subscriber("base_truth", Odometry, self.take_truth)
        rospy.Subscriber("drive_status", DriveStatus, lambda _: self.has_status.set())
        rospy.Subscriber("odom", Odometry, lambda _: self.has_pose.set())

    def take_report(self, report):
        if self.is_sent and report.result != GoalReport.REPLACED:
            self.report = report
            self.done.set()

    def take_truth(self, truth):
        self.truth = truth.pose.pose.position

    def start(self, timeout_s):
        # Not before there is a pose: a drive that is started without one waits for it.
        for event, what in (self.has_status, "drive_status"), (self.has_pose, "odom"):
            if not event.wait(timeout_s):
                print("start: nothing on %s within %g s" % (what, timeout_s))
                return False
        answer = rospy.ServiceProxy("chassis_node/start", Trigger)()
        print("start:", answer.message)
        return answer.success

    def error_m(self):
        """By the truth, where a simulation tells it."""
        position = self.goal.pose.position
        return math.hypot(position.x - self.truth.x, position.y - self.truth.y)

    def run(self, x_m, y_m, heading_deg, timeout_s):
        if not self.start(timeout_s):
            return False
        self.goal = make_goal(x_m, y_m, heading_deg)
        self.is_sent = True
        self.goals.publish(self.goal)
        if not self.done.wait(timeout_s):
            print("outcome: no answer within %g s" % timeout_s)
            return False
        print("outcome:", self.report.text)
        print("error_by_sight_m: %.3f" % self.report.position_error_m)
        if self.truth is not None:
            print("error_m: %.3f" % self.error_m())
        return self.report.result == GoalReport.ARRIVED


def main():
    arguments = [float(argument) for argument in rospy.myargv()[1:]]
    if len(arguments) not in (3, 4):
        sys.exit(__doc__)
    rospy.init_node("drive_to", anonymous=True)
    timeout_s = arguments[3] if len(arguments) == 4 else 600
    return 0 if Errand().run(*arguments[:3], timeout_s) else 1


if __name__ == "__main__":
    sys.exit(main())
