"""Nodes that are killed, stopped and started anew."""
import signal
import socket
import time

import rospy
from fault import Fault
from rover import program_of


def killed(node):
    return lambda campaign: (campaign.restart(node), time.sleep(3))


def respawned(campaign):
    """roslaunch starts chassis_node anew, after 2 s."""
    campaign.rover.status = None
    campaign.rover.wait(lambda: campaign.rover.status is not None)
    time.sleep(1)


def kill_and_restart(node):
    return lambda campaign: (campaign.signal(node, signal.SIGKILL), campaign.restart(node))


def stop_and_continue(node, duration_s):
    def inject(campaign):
        campaign.signal(node, signal.SIGSTOP)
        rospy.sleep(duration_s)  # of simulated time, as the limits are
        campaign.signal(node, signal.SIGCONT)
    return inject


def sent(node, number):
    return lambda campaign: campaign.signal(node, number)


def outside_ros(program, number):
    return lambda campaign: campaign.launch.signal(program, number)


def send_packet(campaign):
    """What stops the rover without a ROS master."""
    socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b"", ("127.0.0.1", 10 * campaign.tap.driver_port + 3))


def wait(duration_s):
    return lambda campaign: time.sleep(duration_s)


def ended(node, number, name, promise="-", mend=respawned, limit_s=0.0, may_go_on=False):
    return Fault(name, sent(node, number), promise, mend, limit_s, ends_node=True, may_go_on=may_go_on)


def node_faults():
    stop, go_on, kill = signal.SIGSTOP, signal.SIGCONT, signal.SIGKILL
    packet = "software emergency stop is set"
    stale, away, no_map = "pose is stale", "pose was away too long", "map frame is no longer told"
    head, mast = "head/pan_tilt_node", "robot_state_publisher"
    rows = []
    for node in "pose_node", "arfm_node":
        rows.append(ended(node, kill, node + " killed -9", stale, killed(node), 1))
        rows.append(Fault(node + " stopped (SIGSTOP) for 5 s", stop_and_continue(node, 5), away, limit_s=1))
    rows += [
        Fault("pose_node killed -9 and started anew", kill_and_restart("pose_node"), "odometry has started anew", limit_s=1.0,
              mend=wait(2), ends_node=True),
        Fault("arfm_node killed -9 and started anew", kill_and_restart("arfm_node"), "drives on or " + stale, limit_s=1.0,
              mend=wait(2), ends_node=True, may_go_on=True),
        Fault("ba_node killed -9 and started anew", kill_and_restart("ba_node"), "drives on or map frame has jumped or " + no_map,
              limit_s=1.1, mend=wait(2), ends_node=True, may_go_on=True),
        Fault("pose_node/reset called", lambda c: c.rover.call("pose_node/reset"), "odometry has started anew",
              limit_s=0.7, mend=wait(2)),
        ended("ba_node", kill, "ba_node killed -9", no_map, killed("ba_node"), 1.1),
        Fault("ba_node stopped (SIGSTOP)", sent("ba_node", stop), no_map, sent("ba_node", go_on), 1.1),
        # roslaunch starts these two anew.
        ended(head, kill, "pan_tilt_node killed -9 and started anew", stale, wait(5), 1, may_go_on=True),
        ended(mast, kill, "robot_state_publisher killed -9 and started anew", "drives on or " + stale, wait(5), 1, may_go_on=True),
        Fault("pan_tilt_node stopped (SIGSTOP) for 5 s", stop_and_continue(head, 5), away, limit_s=1),
        ended("chassis_node", kill, "chassis_node killed -9"),
        ended("chassis_node", signal.SIGTERM, "chassis_node ends (SIGTERM)"),
        ended("chassis_node", signal.SIGHUP, "chassis_node loses its terminal (SIGHUP)"),
        Fault("chassis_node hangs (SIGSTOP)", sent("chassis_node", stop), "-",
              lambda c: (sent("chassis_node", go_on)(c), time.sleep(1))),
        # roslaunch starts it anew.
        Fault("chassis_guard killed -9", outside_ros("chassis_guard", kill), "CAN bus is down", wait(4)),
        Fault("chassis_guard hangs (SIGSTOP)", outside_ros("chassis_guard", stop), "CAN bus is down",
              outside_ros("chassis_guard", go_on)),
        Fault("a packet to chassis_guard", send_packet, packet),
        Fault("ROS master hangs (SIGSTOP), a packet to chassis_guard",
              lambda c: (c.launch.signal("rosmaster", stop), send_packet(c)), packet, outside_ros("rosmaster", go_on)),
        Fault("a second chassis_node is started",
              lambda c: c.command("timeout 5 %s __name:=second _can:=$(rosparam get /chassis_node/can)" %
                                  program_of("chassis_node")),
              "drives on"),
    ]
    return rows
