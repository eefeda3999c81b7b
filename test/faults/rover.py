"""The running graph of launch/simulation.launch, and a person who drives it."""
import fcntl
import math
import os
import signal
import subprocess
import threading
import time
import xmlrpc.client

import rosgraph
import roslib.packages
import rosnode
import rospy
from arfm_vo.msg import DriveStatus, GoalReport, OdometryStatus, OperatorChallenge
from geometry_msgs.msg import PoseStamped, Twist, Vector3
from ports import find_free_port
from sight import Sight
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

PATIENCE_S = 60
UNCERTAIN = "pose is too uncertain"
MAX_DISTANCE_M = 20  # from the start, in a terrain that ends; then the rover turns round
WARNING_S = 1.8  # of the 2 s that are promised: what tells them comes late too
COMMANDED_S = 2.5  # a motion so soon after a command needs no warning
F_SETPIPE_SZ = 1031  # Linux; fcntl has its name from Python 3.10 on


class Launch:
    """simulation.launch as a user starts it, with an operator, in real time, the bus through the tap."""

    def __init__(self, log, driver_port, chassis_port):
        port = find_free_port()
        os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
        arguments = ["rviz:=false", "operator:=true", "real_time:=true", "max_wait_s:=0", "width:=320", "height:=240",
                     "port:=%d" % chassis_port, "chassis_port:=%d" % driver_port, "cameras:=/cameras", "guard:=true"]
        self.process = subprocess.Popen(["roslaunch", "-p", str(port), "arfm_vo", "simulation.launch"] + arguments,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        fcntl.fcntl(self.process.stdout, F_SETPIPE_SZ, 4096)
        self.is_read = True  # false: nobody reads the terminal
        threading.Thread(target=self.read, args=(log,), daemon=True).start()

    def signal(self, program, number):
        """To what roslaunch has started and is no node."""
        pids = subprocess.run(["pgrep", "-P", str(self.process.pid), "-f", program], text=True, check=True, stdout=subprocess.PIPE)
        for pid in pids.stdout.split():
            os.kill(int(pid), number)

    def read(self, log):
        while True:
            while not self.is_read:
                time.sleep(0.05)
            said = os.read(self.process.stdout.fileno(), 4096)
            if not said:
                return
            log.write(said)
            log.flush()

    def end(self):
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


class Rover:
    def __init__(self, tap):
        self.sight = Sight(tap.way_m)
        self.odometry_texts = []  # what the odometry said of itself
        rospy.Subscriber("status", OdometryStatus, lambda status: self.odometry_texts.append(status.text))
        self.tap = tap
        self.status, self.reports = None, []
        self.told = {}  # reasons since the fault began, and what they measured
        self.is_homeward = False  # far from where it began, and turned round
        self.speed_mps = None  # of cmd_vel, where the rover is driven by it
        self.commands_s, self.warnings_s = [], []  # by the steady clock; of a warning its begin and its end
        self.goals = rospy.Publisher("goal", PoseStamped, queue_size=1)
        self.emergency = rospy.Publisher("emergency_stop", Bool, queue_size=1)
        self.answers = rospy.Publisher("operator_answer", OperatorChallenge, queue_size=10)
        self.link, self.heard = lambda heard: heard[-1], []  # the operator's answer, of the challenges; None: none
        rospy.Subscriber("operator_challenge", OperatorChallenge, self.answer, queue_size=1)
        self.velocities = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("drive_status", DriveStatus, self.take_status)
        rospy.Subscriber("goal_report", GoalReport, self.take_report)
        threading.Thread(target=self.steer, daemon=True).start()

    def answer(self, challenge):
        self.heard.append(challenge)
        answer = self.link(self.heard)
        if answer is not None:
            self.answers.publish(answer)

    def steer(self):
        while True:
            if self.speed_mps is not None:
                self.velocities.publish(Twist(linear=Vector3(self.speed_mps, 0, 0)))
            time.sleep(0.04)

    @staticmethod
    def is_told_by_chassis(message):
        """And not by a fault."""
        return message._connection_header["callerid"] == "/chassis_node"

    def take_report(self, report):
        if self.is_told_by_chassis(report):
            self.reports.append(report)

    def take_status(self, status):
        if not self.is_told_by_chassis(status):
            return
        warned, warns = (some is not None and some.state == DriveStatus.WARNING for some in (self.status, status))
        if warns and not warned:
            self.warnings_s.append([time.monotonic(), math.inf])
        if warned and not warns:
            self.warnings_s[-1][1] = time.monotonic()
        self.status = status
        self.told[status.reason] = status.detail

    def count_unwarned(self, since_s, pace):
        """How often it began to move without having been commanded just before (in time of that pace), or having warned."""
        def is_announced(start_s):
            return (any(0 <= start_s - command_s <= COMMANDED_S / pace for command_s in self.commands_s) or
                    any(WARNING_S <= start_s - begin_s and start_s - end_s <= 1 for begin_s, end_s in self.warnings_s))
        return sum(not is_announced(start_s) for start_s in self.tap.starts_s if start_s > since_s)

    def wait(self, condition, limit_s=PATIENCE_S):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if condition():
                return True
            time.sleep(0.005)
        return condition()

    def wait_simulated(self, condition, limit_s):
        """So long in simulated time, which a busy machine holds back."""
        end_s = rospy.get_time() + limit_s
        return self.wait(lambda: condition() or rospy.get_time() > end_s) and condition()

    def call(self, service):
        self.commands_s.append(time.monotonic())
        try:
            return rospy.ServiceProxy(service, Trigger)()
        except rospy.ServiceException as error:
            return Trigger._response_class(success=False, message=str(error))

    def send_goal(self, x_m, y_m=0.0, frame="base_link", stamp=None):
        goal = PoseStamped()
        goal.header.frame_id = frame
        goal.header.stamp = stamp if stamp is not None else rospy.Time.now()
        goal.pose.position.x, goal.pose.position.y = x_m, y_m
        goal.pose.orientation.w = 1
        self.commands_s.append(time.monotonic())
        self.goals.publish(goal)

    def is_fast(self, limit_s):
        return self.wait(lambda: self.status.forward_mps > 0.09, limit_s)

    def start(self):
        """As a person does it, who has seen where the rover stands; says whether it has started."""
        if self.status.reason == UNCERTAIN or UNCERTAIN in self.status.detail:
            self.call("chassis_node/set_datum")
        return self.call("chassis_node/start").success

    def drive(self, by_velocity=False):
        """Started, and at full speed to a goal 6 m ahead, or by cmd_vel."""
        self.speed_mps = None
        ready = (DriveStatus.READY, DriveStatus.DRIVING)
        if not self.wait(lambda: self.status and self.status.state in ready or (self.start() and time.sleep(1))):
            return False
        if by_velocity:
            self.call("chassis_node/cancel")
            self.speed_mps = 0.1
        elif self.sight.distance_m() > MAX_DISTANCE_M and not self.is_homeward:
            self.send_goal(-6)
            self.is_fast(PATIENCE_S)
        self.is_homeward = self.sight.distance_m() > MAX_DISTANCE_M
        for _ in range(10):
            if not by_velocity:
                self.send_goal(6)
            if self.is_fast(6):
                return True
            self.start()
        return False

    def moves(self):
        return time.monotonic() - self.tap.moving_s < 0.3


def pid_of(node):
    """The process of a node, as the node itself tells it."""
    uri = rosnode.get_api_uri(rosgraph.Master("/fault_campaign"), node, skip_cache=True)
    return xmlrpc.client.ServerProxy(uri).getPid("/fault_campaign")[2]


def pids_of_nodes():
    """By their names without the first slash; those that answer, and not this one."""
    pids = {}
    for name in rosnode.get_node_names():
        try:
            pids[name.lstrip("/")] = pid_of(name)
        except (OSError, rosnode.ROSNodeIOException):
            pass  # it has ended
    del pids[rospy.get_name().lstrip("/")]
    return pids


def program_of(node):
    """Its path in the build tree that this shell has; rosrun asks which one where the package holds two trees."""
    return roslib.packages.find_node("arfm_vo", node)[0]


def start_again(node):
    """The node with the parameters that it had."""
    return subprocess.Popen([program_of(node), "__name:=" + node, "stereo:=/cameras"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
