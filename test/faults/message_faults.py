"""Wrong operators, goals, velocities and poses: messages and services."""
import subprocess
import threading
import time

import rospy
from arfm_vo.msg import OdometryStatus, OperatorChallenge
from fault import UNCERTAIN, Fault
from geometry_msgs.msg import PoseStamped, Twist, Vector3
from machine_faults import unburden
from nav_msgs.msg import Odometry, Path
from std_msgs.msg import Bool

NAN = float("nan")


def operator_faults():
    def link(answer, wait_s=0.0):
        """How the person's answer comes of the challenges so far; None: none."""
        return lambda campaign: (setattr(campaign.rover, "link", answer), time.sleep(wait_s))

    def second_velocity(campaign):
        """Of another node, as fast as the first; it begins when its first message comes."""
        is_begun = threading.Event()

        def take(twist):
            if twist.linear.x < 0 and not is_begun.is_set():
                campaign.begin()
                is_begun.set()
        listener = rospy.Subscriber("cmd_vel", Twist, take)
        campaign.burden = [subprocess.Popen(["rostopic", "pub", "-r", "20", "/cmd_vel", "geometry_msgs/Twist",
                                             "{linear: {x: -0.1}}"], stdout=subprocess.DEVNULL)]
        if not is_begun.wait(30):
            raise RuntimeError("rostopic pub publishes nothing")
        listener.unregister()

    def emergency(is_set):
        return lambda c: c.rover.emergency.publish(Bool(is_set))

    def foreign_release(campaign):
        campaign.rover.emergency.publish(Bool(True))
        campaign.command("rostopic pub -1 /emergency_stop std_msgs/Bool 'data: false'")
        campaign.rover.call("chassis_node/start")

    mended = link(lambda heard: heard[-1], 0.5)
    return [
        Fault("stop service called", lambda c: c.rover.call("chassis_node/stop"), "stopped by hand"),
        Fault("a joystick is held at the start", lambda c: (c.rover.call("chassis_node/stop"), setattr(c.rover, "speed_mps", 0.1)),
              "stopped by hand", lambda c: setattr(c.rover, "speed_mps", None),
              is_well=lambda c: not c.rover.call("chassis_node/start").success),
        Fault("goal cancelled", lambda c: c.rover.call("chassis_node/cancel"), "-"),
        Fault("two nodes publish cmd_vel", second_velocity, "two nodes command velocities", unburden, by_velocity=True),
        *(Fault("operator does not answer: " + name, link(answer), "operator does not answer", mended, 0.9) for name, answer in (
            ("the link is cut", lambda heard: None), ("each answer is 8 s late", lambda heard: heard[-80] if heard[80:] else None),
            ("the first answer is repeated", lambda heard: heard[0]), ("it is for another rover", lambda heard: OperatorChallenge(
                "another rover", heard[-1].sequence, heard[-1].number)))),
        Fault("every other answer of the operator is lost", link(lambda heard: heard[-1] if len(heard) % 2 else None), "drives on", mended),
        Fault("software emergency stop", emergency(True), "software emergency stop is set", emergency(False)),
        Fault("another publisher clears the emergency stop", foreign_release, "software emergency stop is set",
              emergency(False), is_well=lambda c: c.rover.status.reason == "software emergency stop is set"),
    ]


def wrong_odometry(stamp=None, variance=1e-4):
    message = Odometry()
    message.header.frame_id = "odom"
    message.header.stamp = stamp if stamp is not None else rospy.Time.now()
    message.pose.covariance = [variance if i % 7 == 0 else 0 for i in range(36)]
    message.pose.pose.orientation.w = 1
    return message


def end_of_time():
    return rospy.Time(0xFFFFFFFF, 999999999)


def far_path(campaign):
    path = Path()
    path.header.frame_id, path.header.stamp = "map", rospy.Time.now()
    pose = PoseStamped()
    pose.pose.orientation.w = 1
    path.poses = [pose] * 10000
    campaign.publish("waypoints", path)


def many(make, topic, count=2000):
    return lambda campaign: [campaign.publish(topic, make()) for _ in range(count)]


def second_odometry(campaign):
    odometry = wrong_odometry()
    campaign.publish("odom", odometry)
    campaign.transform("odom", "base_link", 30, odometry.header.stamp)


def message_faults():
    contradiction = "pose contradicts the tracks"
    settle = lambda c: time.sleep(1)  # noqa: E731
    return [
        Fault("a second node tells odom and odom -> base_link 30 m off", second_odometry, contradiction, settle),
        Fault("a second node tells map -> odom 3 m off", lambda c: c.transform("map", "odom", 3, rospy.Time.now() + rospy.Duration(0.5)),
              "map frame has jumped", settle),
        Fault("tf odom -> base_link is not a number", lambda c: c.transform("odom", "base_link", NAN), "drives on"),
        Fault("tf odom -> base_link of the end of time", lambda c: c.transform("odom", "base_link", 30, end_of_time()), "drives on"),
        Fault("odom of the end of time", lambda c: c.publish("odom", wrong_odometry(end_of_time(), NAN)), "drives on"),
        *(Fault("odom with a covariance " + name, lambda c, variance=variance: c.publish("odom", wrong_odometry(variance=variance)),
                UNCERTAIN, settle, may_go_on=True) for name, variance in (("that is not a number", NAN), ("of 9999", 9999))),
        Fault("a second node tells status", lambda c: c.publish("status", OdometryStatus(epoch=7)), "odometry has started anew", settle),
        Fault("goal that is not a number", lambda c: c.rover.send_goal(NAN), "drives on"),
        Fault("goal 60 m away", lambda c: c.rover.send_goal(60), "drives on"),
        Fault("goal of a minute ago", lambda c: c.rover.send_goal(-3, stamp=rospy.Time.now() - rospy.Duration(60)), "drives on"),
        Fault("goal without a stamp", lambda c: c.rover.send_goal(-3, stamp=rospy.Time()), "drives on"),
        Fault("goal in an unknown frame", lambda c: c.rover.send_goal(1, frame="moon"), "drives on"),
        Fault("path of 10000 waypoints", far_path, "drives on"),
        Fault("cmd_vel while there is a goal", lambda c: c.publish("cmd_vel", Twist()), "drives on"),
        Fault("cmd_vel that is not a number", lambda c: c.publish("cmd_vel", Twist(linear=Vector3(NAN, 0, 0))), "drives on"),
        Fault("flood of 2000 goals without a stamp", many(PoseStamped, "goal"), "drives on"),
        Fault("flood of 2000 velocities", many(Twist, "cmd_vel"), "drives on"),
        Fault("clear_errors while driving", lambda c: c.rover.call("chassis_node/clear_errors"), "drives on"),
    ]
