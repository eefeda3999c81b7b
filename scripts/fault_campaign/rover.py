"""The running graph of launch/simulation.launch, and a person who drives it."""
import fcntl
import math
import os
import signal
import socket
import subprocess
import threading
import time

import rosgraph
import roslib.packages
import rosnode
import rospy
import rosservice
from arfm_vo.msg import DriveStatus, GoalReport, OdometryStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import Bool, Empty
from std_srvs.srv import Trigger

PATIENCE_S = 60
F_SETPIPE_SZ = 1031  # Linux; fcntl has its name from Python 3.10 on


def is_free(port, kind):
    with socket.socket(socket.AF_INET, kind) as end:
        try:
            end.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def find_bus_port(first):
    """The first PORT from `first` on of which UDP ports PORT1 and PORT2 are free."""
    return next(port for port in range(first, 6500)
                if all(is_free(10 * port + end, socket.SOCK_DGRAM) for end in (1, 2)))


def find_master_port():
    return next(port for port in range(11411, 12000) if is_free(port, socket.SOCK_STREAM))


class Launch:
    """simulation.launch as a user starts it, with an operator, in real time, the bus through the tap."""

    def __init__(self, log, driver_port, chassis_port):
        port = find_master_port()
        os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
        arguments = ["rviz:=false", "head:=false", "operator:=true", "real_time:=true", "max_wait_s:=0", "width:=320", "height:=240",
                     "port:=%d" % chassis_port, "chassis_port:=%d" % driver_port, "eyes:=/eyes"]
        self.process = subprocess.Popen(["roslaunch", "-p", str(port), "arfm_vo", "simulation.launch"] + arguments,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        fcntl.fcntl(self.process.stdout, F_SETPIPE_SZ, 4096)
        self.is_read = True  # false: nobody reads the terminal
        threading.Thread(target=self.read, args=(log,), daemon=True).start()

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


class Sight:
    """The way by the odometry beside the true one."""

    def __init__(self):
        self.truths, self.seen = {}, {}  # places by stamp
        self.mark_s = 0.0
        rospy.Subscriber("base_truth", Odometry, self.take_truth)
        rospy.Subscriber("odom", Odometry, self.take_odometry)

    @staticmethod
    def note(places, message):
        place = message.pose.pose.position
        places[message.header.stamp.to_sec()] = (place.x, place.y)
        while len(places) > 3000:
            del places[next(iter(places))]

    def take_truth(self, message):
        self.note(self.truths, message)

    def take_odometry(self, message):
        is_known = message.pose.covariance[0] < 1  # a pose that is lost has thousands
        if is_known and message._connection_header["callerid"] == "/pose_node":
            self.note(self.seen, message)

    def mark(self):
        """From here on."""
        self.mark_s = rospy.get_time() - 1

    def error_m(self):
        """By how much the way between the first and the last pose that was told differs from the true one."""
        stamps = [stamp for stamp in sorted(self.seen) if stamp >= self.mark_s]
        if len(stamps) < 2 or not self.truths:
            return 0.0
        ways = []
        for places in self.seen, self.truths:
            ends = [places[min(places, key=lambda other: abs(other - stamp))] for stamp in (stamps[0], stamps[-1])]
            ways.append(math.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]))
        return abs(ways[0] - ways[1])


class Rover:
    def __init__(self, tap):
        self.sight = Sight()
        self.odometry_texts = []  # what the odometry said of itself
        rospy.Subscriber("status", OdometryStatus, lambda status: self.odometry_texts.append(status.text))
        self.tap = tap
        self.status, self.reports = None, []
        self.has_operator = True
        self.goals = rospy.Publisher("goal", PoseStamped, queue_size=1)
        self.emergency = rospy.Publisher("emergency_stop", Bool, queue_size=1)
        self.heartbeats = rospy.Publisher("operator_heartbeat", Empty, queue_size=1)
        rospy.Subscriber("drive_status", DriveStatus, self.take_status)
        rospy.Subscriber("goal_report", GoalReport, self.reports.append)
        threading.Thread(target=self.beat, daemon=True).start()

    def beat(self):
        while True:
            if self.has_operator:
                self.heartbeats.publish(Empty())
            time.sleep(0.4)

    def take_status(self, status):
        self.status = status

    def wait(self, condition, limit_s=PATIENCE_S):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if condition():
                return True
            time.sleep(0.005)
        return condition()

    def call(self, service):
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
        self.goals.publish(goal)

    def drive(self):
        """Started, and at full speed to a goal 6 m ahead."""
        ready = (DriveStatus.READY, DriveStatus.DRIVING)
        if not self.wait(lambda: self.status and self.status.state in ready or
                         (self.call("chassis_node/start").success and time.sleep(1))):
            return False
        for _ in range(10):
            self.send_goal(6)
            if self.wait(lambda: self.status.forward_mps > 0.09, 6):
                return True
            self.call("chassis_node/start")
        return False

    def moves(self):
        return time.monotonic() - self.tap.moving_s < 0.3


def pid_of(node):
    """The process of a node, as the node itself tells it."""
    import xmlrpc.client
    uri = rosnode.get_api_uri(rosgraph.Master("/fault_campaign"), node, skip_cache=True)
    return xmlrpc.client.ServerProxy(uri).getPid("/fault_campaign")[2]


def program_of(node):
    """Its path in the build tree that this shell has; rosrun asks which one where the package holds two trees."""
    return roslib.packages.find_node("arfm_vo", node)[0]


def start_again(node):
    """The node with the parameters that it had."""
    remaps = ["stereo:=/eyes", "track_odometry:=track_odom"]
    return subprocess.Popen([program_of(node), "__name:=" + node] + remaps, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def has_service(name):
    try:
        return rosservice.get_service_node(name) is not None
    except rosservice.ROSServiceIOException:
        return False
