#!/usr/bin/python3
"""Tells chassis_node that a person attends the rover: an operator heartbeat at 2 Hz while this runs in a terminal.

Usage: operator_heartbeat.py     Enter stops the rover; Ctrl-C, or closing the terminal, ends the heartbeat, and the rover stops
"""
import select
import signal
import sys

import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

PERIOD_S = 0.5


def stop():
    try:
        print("stop:", rospy.ServiceProxy("chassis_node/stop", Trigger)().message)
    except rospy.ServiceException as error:
        print("stop: no answer: %s" % error)


def attend():
    """Beats until the terminal is gone. A wall clock paces it: simulated time may stand still."""
    heartbeats = rospy.Publisher("operator_heartbeat", Empty, queue_size=1)
    print("Enter stops the rover, Ctrl-C ends the watch")
    while not rospy.is_shutdown():
        heartbeats.publish(Empty())
        is_readable, _, _ = select.select([sys.stdin], [], [], PERIOD_S)
        if not is_readable:
            continue
        if not sys.stdin.readline():
            return  # the terminal is gone
        stop()


def main():
    if {"--help", "-h"} & set(sys.argv):
        print(__doc__)
        return
    if len(rospy.myargv()) != 1:
        sys.exit(__doc__)
    # Ctrl-C must find the node alive, so that it can still stop the rover.
    rospy.init_node("operator", anonymous=True, disable_signals=True)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    try:
        attend()
    except KeyboardInterrupt:
        pass
    finally:
        stop()


if __name__ == "__main__":
    main()
