"""Faults of the camera and of where it is: what the odometry sees, with right stamps and with wrong ones."""
import itertools
import math
import os
import re
import signal
import time

import rospy
import tf2_ros
from camera_tap import IMAGES, AgainOnce, Hold, Settling, cover, darken, freeze, recalibrate, swap, unchanged
from fault import Fault
from rover import pid_of


def changed(change):
    """Each time anew where the change has a memory."""
    def inject(campaign):
        campaign.camera.change = change() if isinstance(change, type) else change
    return inject


def mend(campaign):
    campaign.camera.change = unchanged
    time.sleep(2)


def cover_for(duration_s):
    def inject(campaign):
        campaign.camera.change = cover(*IMAGES)
        rospy.sleep(duration_s)
        campaign.camera.change = unchanged
    return inject


def stop_camera_for(duration_s):
    """As a SIGSTOP of its node does it: what has waited comes at once."""
    def inject(campaign):
        campaign.camera.change = hold = Hold()
        rospy.sleep(duration_s)
        hold.is_let_go = True
    return inject


def restart_camera(duration_s, change=lambda: unchanged):
    """As where its node is killed and started anew: its topics go and come."""
    def inject(campaign):
        campaign.camera.unadvertise()
        rospy.sleep(duration_s)
        campaign.camera.change = change()
        campaign.camera.advertise()
    return inject


def look_aside(campaign, aside_rad):
    """The cameras look aside of where the head tells, as on a belt that has slipped; the odometry begins anew."""
    joint = '<joint name="pan" type="revolute">'
    description = re.sub(joint + "(<origin.*?/>)?", joint + '<origin rpy="0 0 %g"/>' % aside_rad, rospy.get_param("robot_description"))
    rospy.set_param("robot_description", description)
    os.kill(pid_of("/robot_state_publisher"), signal.SIGKILL)  # roslaunch starts it anew
    time.sleep(4)
    campaign.rover.call("pose_node/reset")
    time.sleep(2)


def drive_aside(campaign):
    look_aside(campaign, math.radians(15))
    campaign.rover.drive()
    campaign.rover.sight.mark()
    campaign.begin()


def stop_without_camera(campaign):
    campaign.rover.call("chassis_node/stop")
    campaign.camera.unadvertise()
    rospy.sleep(2)


def shift_camera(campaign):
    """Beside the right transform of the mast's top, for 2 s."""
    transforms = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(transforms)
    message = transforms.lookup_transform("mast", "pan_link", rospy.Time(), rospy.Duration(5))
    listener.unregister()
    end_s = rospy.get_time() + 2
    message.transform.translation.x += 0.5
    while rospy.get_time() < end_s:
        message.header.stamp = rospy.Time.now()
        campaign.broadcaster.sendTransform(message)
        time.sleep(0.01)


def tilt_map(campaign):
    """A second node tells a map in which the rover stands on a slope of 35 degrees."""
    campaign.transform("map", "odom", 0, rospy.Time.now() + rospy.Duration(0.5), tilt_rad=math.radians(35))


def is_true(campaign):
    """The newest pose that was told is right."""
    told = campaign.rover.sight.told
    return not campaign.rover.sight.is_wrong(told[-1], told[0])


def names_the_right_camera(campaign):
    return is_true(campaign) and any("right" in text for text in campaign.rover.odometry_texts)


def camera_faults():
    def frozen(names):
        return lambda campaign: setattr(campaign.camera, "change", freeze(campaign.camera.last, names))
    stale, anew, contradiction = "pose is stale", "odometry has started anew", "pose contradicts the tracks"
    return [
        Fault("camera is frozen: the same pictures with new stamps", frozen(IMAGES), stale, mend, 1),
        Fault("left camera is frozen", frozen(IMAGES[:1]), stale, mend, 1.5, is_well=is_true),
        Fault("right camera is frozen", frozen(IMAGES[1:]), "drives on", mend, 1.5, is_well=names_the_right_camera),
        Fault("both lenses are covered", changed(cover(*IMAGES)), stale, mend, 1.5),
        Fault("both lenses are covered for 2 s", cover_for(2), stale, mend, 1.5, may_go_on=True),
        Fault("left lens is covered", changed(cover(IMAGES[0])), stale, mend, 1.5, is_well=is_true),
        Fault("right lens is covered", changed(cover(IMAGES[1])), "drives on", mend, 1.5, is_well=names_the_right_camera),
        Fault("cameras are swapped", changed(swap), stale, mend, 1.5, is_well=is_true),
        Fault("calibration changes while driving", changed(recalibrate), anew, mend, 1),
        Fault("camera's node is stopped (SIGSTOP) for 2 s: its pairs wait", stop_camera_for(2), stale, mend, 1.5, may_go_on=True),
        Fault("camera's node is killed and started anew after 2 s: its topics go and come", restart_camera(2), stale, mend, 1.5,
              may_go_on=True),
        Fault("camera is switched on anew after 2 s: its exposure settles in 3 s", restart_camera(2, Settling),
              "camera's exposure has not settled", mend, 1.5, may_go_on=True),
        Fault("head's belt has slipped: the cameras look 15 degrees aside", drive_aside, "too much slip",
              lambda c: look_aside(c, 0), 13, ends_node=True, max_wrong_way_m=1),
        Fault("camera is away at rest: the start-up check says so, and nothing starts", stop_without_camera, "stopped by hand",
              lambda c: (c.camera.advertise(), mend(c)), is_well=lambda c: "\nno camera" in c.rover.call("chassis_node/start").message),
        Fault("camera falls silent", changed(lambda pair: []), stale, mend, 1.5),
        Fault("pictures are half as bright at once", changed(darken), "drives on", mend, is_well=is_true),
        Fault("every other pair is lost", changed(lambda pair, kept=itertools.cycle((True, False)): [pair] if next(kept) else []),
              stale, mend, 3, may_go_on=True, is_well=is_true),
        Fault("each pair comes twice", changed(lambda pair: [pair, pair]), "drives on", mend, is_well=is_true),
        Fault("an old pair comes again", changed(AgainOnce), "drives on", mend, is_well=is_true),
        Fault("a second node tells the camera 0.5 m farther ahead", shift_camera, contradiction, mend, 1),
        Fault("a second node tells map -> odom tilted by 35 degrees", tilt_map, "rover is tilted too far", mend, 0.6),
    ]
