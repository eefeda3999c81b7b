"""Faults of the computer: its clock, its CPU, memory and disk, its terminal, the ROS master."""
import os
import signal
import subprocess
import sys
import tempfile
import time

import rospy
from fault import UNCERTAIN, Fault, NotPermitted
from node_faults import outside_ros
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool


def step_clock(seconds):
    """Somebody publishes one wrong time on /clock; the simulator's next is right again."""
    return lambda campaign: campaign.clock.publish(Clock(clock=rospy.Time.now() + rospy.Duration(seconds)))


def spawn(campaign, program, count=1):
    campaign.burden = [subprocess.Popen([sys.executable, "-c", program], start_new_session=True) for _ in range(count)]


def unburden(campaign):
    for process in campaign.burden:
        process.terminate()  # a ROS node takes leave of the master: its port may soon be another's
        process.wait()
    time.sleep(2)


def press_memory(campaign):
    """Takes half of what is free and writes to all of it."""
    spawn(campaign, "free = [int(l.split()[1]) for l in open('/proc/meminfo') if l.startswith('MemAvailable')][0]\n"
                    "block = bytearray(free * 512)\nimport time\n" "while True:\n  block[::4096] = bytes(len(block[::4096]))")


def fill_disk(campaign):
    """The black box records onto a disk of 1 MB."""
    campaign.disk = tempfile.mkdtemp(prefix="arfm_vo_disk_")
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", campaign.disk], capture_output=True, text=True)
    if mounted.returncode != 0:
        raise NotPermitted(mounted.stderr.strip())
    with open(os.path.join(campaign.disk, "rest"), "wb") as file:
        try:
            file.write(bytes(1 << 21))
        except OSError:
            pass
    campaign.burden = [subprocess.Popen(["roslaunch", "arfm_vo", "record.launch", "folder:=" + campaign.disk, "min_space:=0"],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)]


def free_disk(campaign):
    for process in campaign.burden:
        process.send_signal(signal.SIGINT)
        process.wait()
    subprocess.run(["umount", "-l", campaign.disk], check=False)
    os.rmdir(campaign.disk)


def freeze_terminal(campaign):
    """Nobody reads what roslaunch and its nodes write, and there is much to write."""
    campaign.launch.is_read = False
    for _ in range(400):
        campaign.rover.send_goal(-3, stamp=rospy.Time())


def machine_faults():
    rows = [Fault("clock steps by %+d s and back" % seconds, step_clock(seconds), may_go_on=True, limit_s=1, mend=lambda c: time.sleep(3),
                  promise="drives on or chassis_node was held up or clock was set or odometry has started anew or pose is stale or no pose or " + UNCERTAIN)
            for seconds in (1, -1, 3600, -3600)]
    return rows + [
        *(Fault(name, inject, "drives on or pose is stale or chassis_node was held up", unburden, 3, is_load=True, may_go_on=True) for name, inject in (
            ("8 busy loops", lambda c: spawn(c, "while True: pass", 8)), ("memory is short", press_memory))),
        Fault("disk of the black box is full", fill_disk, "drives on", free_disk),
        Fault("terminal is frozen", freeze_terminal, "- or drives on",
              lambda c: (setattr(c.launch, "is_read", True), time.sleep(2)), 1),
    ]


def last_faults():
    """After these the graph is not what it was."""
    # roslaunch notices within a second that its master is gone and ends all nodes; chassis_node says farewell. (A roscore
    # that was started by itself would leave the nodes with the connections that they have, the operator's among them.)
    return [Fault("computer's clock is set by %s30 s" % sign, lambda c, ahead=sign == "+": rospy.ServiceProxy(
        "simulator_node/set_clock", SetBool)(ahead), "chassis_node was held up or clock was set", lambda c: time.sleep(3), 1)
            for sign in "+-"] + [Fault("roscore killed", outside_ros("rosmaster", signal.SIGKILL), "-", limit_s=1.0, ends_graph=True)]
