#!/usr/bin/python3
"""Injects faults into the running graph of launch/simulation.launch and writes what became of each.

Exit status 0 where every row is as promised.
"""
import argparse
import math
import os
import pathlib
import random
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import bus_tap as bus  # noqa: E402
import camera_tap  # noqa: E402
import rospy  # noqa: E402
import tf2_ros  # noqa: E402
from camera_faults import camera_faults  # noqa: E402
from fault import Fault, NotPermitted  # noqa: E402
from machine_faults import last_faults, machine_faults  # noqa: E402
from arfm_vo.msg import DriveStatus, GoalReport, OdometryStatus  # noqa: E402
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist  # noqa: E402
from nav_msgs.msg import Odometry, Path  # noqa: E402
from rover import Launch, Rover, find_bus_port, pid_of, program_of, start_again  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from std_msgs.msg import Bool  # noqa: E402

MAX_STOP_S = 0.3  # after the fault, or after its limit
MAX_WAY_M = 0.10  # of the tracks from the fault on, their own inertia included
WATCH_S = 3.0
# A row in which the campaign itself did not run for so long says nothing of the rover: it is measured anew.
MAX_HELD_UP_S = 0.3
MAX_TRIES = 3
BRIEFLY_UNCERTAIN = "pose is too uncertain"  # until the next good covariance
NODES = ("chassis_node", "pose_node", "ba_node", "arfm_node")
NAN = float("nan")


class Campaign:
    def __init__(self, rover, tap, camera, launch, max_stop_s):
        self.rover, self.tap, self.camera, self.launch, self.max_stop_s = rover, tap, camera, launch, max_stop_s
        self.pids, self.children = {}, []
        self.broadcaster = tf2_ros.TransformBroadcaster()
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10) for topic, kind in (
            ("odom", Odometry), ("status", OdometryStatus), ("waypoints", Path), ("cmd_vel", Twist), ("goal", PoseStamped))}
        self.clock = rospy.Publisher("/clock", Clock, queue_size=1)

    # What a fault may do.

    def signal(self, node, number):
        os.kill(self.pids[node], number)

    def restart(self, node):
        self.children.append(start_again(node))

    def publish(self, topic, message):
        self.publishers[topic].publish(message)

    def transform(self, parent, child, x_m, stamp=None):
        message = TransformStamped()
        message.header.frame_id, message.child_frame_id = parent, child
        message.header.stamp = stamp if stamp is not None else rospy.Time.now()
        message.transform.translation.x = x_m
        message.transform.rotation.w = 1
        self.broadcaster.sendTransform(message)

    def command(self, text):
        subprocess.run(text, shell=True, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def obey(self, change):
        self.tap.change = change

    def heal_bus(self):
        self.tap.change = lambda frame: frame

    # A row.

    def measure(self, fault):
        """The row of a fault; None where the rover could not be made to drive."""
        if not self.rover.drive():
            return None
        self.pids = {node: pid_of("/" + node) for node in NODES}
        del self.rover.reports[:]
        del self.rover.odometry_texts[:]
        self.rover.sight.mark()
        way_m = self.tap.way_m()
        injected_s, simulated_s = time.monotonic(), rospy.get_time()
        fault.inject(self)
        told = [self.rover.status.reason]
        end_s = injected_s + fault.limit_s + WATCH_S
        looked_s, held_up_s = time.monotonic(), 0.0
        end_way_m, has_warned = way_m, False
        while looked_s < end_s:
            told.append(self.rover.status.reason)
            has_warned |= self.rover.status.state == DriveStatus.WARNING
            moves_on = has_warned and self.tap.starts_s and self.tap.starts_s[-1] > injected_s
            if not (moves_on and fault.promise == BRIEFLY_UNCERTAIN):
                end_way_m = self.tap.way_m()
            time.sleep(0.01)
            held_up_s, looked_s = max(held_up_s, time.monotonic() - looked_s), time.monotonic()
        pace = max(0.1, (rospy.get_time() - simulated_s) / (time.monotonic() - injected_s))
        if fault.ends_graph:
            pace = 1.0  # simulated time ends too
        row = {"name": fault.name, "promise": fault.promise, "limit_s": fault.limit_s / min(1.0, pace)}
        row["held_up_s"] = held_up_s
        row["moves"] = self.rover.moves()
        row["pose_off_m"] = self.rover.sight.error_m()
        stops_s = [stop_s for stop_s in self.tap.stops_s if stop_s >= injected_s]
        row["stop_s"] = (stops_s[0] if stops_s else self.tap.moving_s) - injected_s
        row["way_m"] = end_way_m - way_m
        row["told"] = list(dict.fromkeys(reason for reason in told if reason != "none"))
        row["drives_on"] = fault.promise == "drives on" or (
            "drives on" in fault.promise and row["moves"] and not row["told"])
        row["arrived"] = sum(report.result == GoalReport.ARRIVED for report in self.rover.reports)
        is_well = fault.is_well(self)
        fault.mend(self)
        row["go_on"] = "" if fault.ends_graph else self.find_what_it_takes(row)
        row["kept"] = self.is_kept(fault, row) and is_well
        return row

    def measure_undisturbed(self, fault):
        """The same; once more where the machine held the campaign up and that may be why it is not as promised."""
        for attempt in range(1, MAX_TRIES + 1):
            row = self.measure(fault)
            is_disturbed = row is not None and not row["kept"] and row["held_up_s"] > MAX_HELD_UP_S
            if not is_disturbed or fault.ends_graph or fault.is_load or attempt == MAX_TRIES:
                return row
            print("%s: held up for %.2f s by the machine, measured anew" % (fault.name, row["held_up_s"]), flush=True)

    def is_kept(self, fault, row):
        if row["arrived"]:
            return False
        promises = [fault.promise] + fault.promise.split(" or ")
        if row["drives_on"]:
            return row["moves"] and not row["told"]
        is_told = fault.promise == "-" or any(promise in row["told"] for promise in promises) or (
            "-" in promises and not row["told"])
        allowed_m = MAX_WAY_M + 0.1 * row["limit_s"]
        is_over = not row["moves"] or fault.promise == BRIEFLY_UNCERTAIN
        is_soon = row["stop_s"] <= row["limit_s"] + self.max_stop_s
        return is_told and is_over and is_soon and row["way_m"] <= allowed_m

    def find_what_it_takes(self, row):
        if row["drives_on"]:
            return ""
        rover = self.rover
        rover.wait(lambda: time.monotonic() - self.tap.moving_s > 0.5, 2)
        if rover.wait(rover.moves, 6):
            return "by itself, with a warning"
        rover.wait(lambda: rover.call("chassis_node/start").success, 20)
        return "start" if rover.wait(rover.moves, 3) else "start and a new goal"


def set_byte(identifier, index, value):
    def change(frame):
        if frame.id == identifier:
            frame.bytes[index] = value
        return frame
    return change


def run_away(frame):
    if frame.id == bus.MOTION_STATE:
        frame.bytes[:4] = struct.pack(">hh", 200, 0)
    return frame


class Hold:
    """The first bytes of the odometer stand: those of the left track, or of both."""

    def __init__(self, size):
        self.size, self.first = size, None

    def __call__(self, frame):
        if frame.id == bus.ODOMETER:
            self.first = self.first or bytes(frame.bytes[:self.size])
            frame.bytes[:self.size] = self.first
        return frame


class Repeat:
    """Every message is as its first."""

    def __init__(self):
        self.first = {}

    def __call__(self, frame):
        frame.bytes = bytearray(self.first.setdefault(frame.id, bytes(frame.bytes)))
        return frame


def heal(campaign):
    campaign.heal_bus()
    time.sleep(0.5)


def clear(campaign):
    heal(campaign)
    campaign.rover.call("chassis_node/clear_errors")


def fuzz(campaign):
    engine = random.Random(1)
    for _ in range(3000):
        identifier = engine.randrange(0x400, 0x800)
        campaign.tap.inject(bus.make_frame(identifier, engine.randbytes(engine.randrange(9))))


def flood(campaign):
    for i in range(20000):
        campaign.tap.inject(bus.make_frame(0x3FF, [1, 2, 3]))
        if i % 160 == 0:
            time.sleep(0.02)


def bus_faults():
    def changed(change):
        return lambda campaign: campaign.obey(change() if isinstance(change, type) else change)

    def held(size):
        return lambda campaign: campaign.obey(Hold(size))
    state = bus.SYSTEM_STATE
    return [
        Fault("emergency stop button", changed(set_byte(state, 0, 1)), "emergency stop button of the chassis is pressed", heal),
        Fault("chassis fault", changed(set_byte(state, 0, 2)), "chassis reports a fault", clear),
        Fault("under-voltage fault", changed(set_byte(state, 4, 1)), "chassis reports a fault", clear),
        Fault("remote control takes over", changed(set_byte(state, 1, 3)), "remote control has the rover", heal),
        Fault("remote control is lost", changed(set_byte(state, 4, 4)), "chassis has lost its remote control", heal),
        Fault("chassis falls into standby", changed(set_byte(state, 1, 0)), "chassis takes no commands over CAN", heal),
        Fault("chassis falls silent", changed(lambda frame: None), "chassis is silent", heal, 0.5),
        Fault("track odometer falls silent", changed(lambda frame: None if frame.id == bus.ODOMETER else frame),
              "chassis is silent", heal, 0.5),
        Fault("system state falls silent", changed(lambda frame: None if frame.id == state else frame),
              "chassis is silent", heal, 0.5),
        Fault("motor driver reports a fault", changed(set_byte(bus.MOTOR_STATUS[0], 5, 0x44)),
              "motor or its driver reports a fault", heal),
        Fault("tracks run away at 0.2 m/s", changed(run_away), "tracks run faster than commanded", heal, 0.2),
        Fault("left track is jammed", held(4), "a track is jammed", heal, 2),
        Fault("rover slides: the eyes go on, both tracks are told to stand", held(8),
              "rover moves otherwise than its tracks or pose contradicts the tracks or a track is jammed", heal, 2),
        Fault("feedback repeats itself", changed(Repeat), "feedback of the chassis is frozen", heal, 1.1),
        Fault("another driver sends 0x111", lambda c: c.tap.inject(bus.make_frame(0x111, [0] * 8)),
              "another driver commands the chassis", lambda c: time.sleep(1.2)),
        Fault("3000 fuzzed frames of foreign identifiers", fuzz, "drives on"),
        Fault("flood of 20000 foreign frames", flood, "drives on"),
    ]


def killed(node):
    def mend(campaign):
        campaign.restart(node)
        time.sleep(3)
    return mend


def respawned(campaign):
    """roslaunch starts chassis_node anew, after 2 s."""
    campaign.rover.status = None
    campaign.rover.wait(lambda: campaign.rover.status is not None)
    time.sleep(1)


def kill_and_restart(node):
    def inject(campaign):
        campaign.signal(node, signal.SIGKILL)
        campaign.restart(node)
    return inject


def stop_and_continue(node, duration_s):
    def inject(campaign):
        campaign.signal(node, signal.SIGSTOP)
        rospy.sleep(duration_s)  # of simulated time, as the limits are
        campaign.signal(node, signal.SIGCONT)
    return inject


def sent(node, number):
    return lambda campaign: campaign.signal(node, number)


def node_faults():
    stop, go_on, kill = signal.SIGSTOP, signal.SIGCONT, signal.SIGKILL
    rows = []
    for node in "pose_node", "arfm_node":
        rows.append(Fault(node + " killed -9", sent(node, kill), "pose is stale", killed(node), 1))
        rows.append(Fault(node + " stopped (SIGSTOP) for 5 s", stop_and_continue(node, 5), "pose was away too long", limit_s=1))
    rows += [
        Fault("pose_node killed -9 and started anew", kill_and_restart("pose_node"), "odometry has started anew", limit_s=1.0,
              mend=lambda c: time.sleep(2)),
        Fault("pose_node/reset called", lambda c: c.rover.call("pose_node/reset"), "odometry has started anew",
              limit_s=0.7, mend=lambda c: time.sleep(2)),
        Fault("ba_node killed -9", sent("ba_node", kill), "map frame is no longer told", killed("ba_node"), 1.1),
        Fault("ba_node stopped (SIGSTOP)", sent("ba_node", stop), "map frame is no longer told", sent("ba_node", go_on), 1.1),
        Fault("chassis_node killed -9", sent("chassis_node", kill), "-", respawned),
        Fault("chassis_node ends (SIGTERM)", sent("chassis_node", signal.SIGTERM), "-", respawned),
        Fault("chassis_node loses its terminal (SIGHUP)", sent("chassis_node", signal.SIGHUP), "-", respawned),
        Fault("chassis_node hangs (SIGSTOP)", sent("chassis_node", stop), "-",
              lambda c: (sent("chassis_node", go_on)(c), time.sleep(1))),
        Fault("a second chassis_node is started",
              lambda c: c.command("timeout 5 %s __name:=second _can:=$(rosparam get /chassis_node/can)" %
                                  program_of("chassis_node")),
              "drives on"),
    ]
    return rows


def operator_faults():
    def operator(is_there):
        def act(campaign):
            campaign.rover.has_operator = is_there
            time.sleep(0.5 if is_there else 0)
        return act

    def emergency(is_set):
        return lambda c: c.rover.emergency.publish(Bool(is_set))

    def foreign_release(campaign):
        campaign.rover.emergency.publish(Bool(True))
        campaign.command("rostopic pub -1 /emergency_stop std_msgs/Bool 'data: false'")
        if campaign.rover.call("chassis_node/start").success:
            campaign.rover.status.reason = "started in spite of the emergency stop"

    no_frame = Fault("goal cancelled", lambda c: c.rover.call("chassis_node/cancel"), "-")
    return [
        Fault("stop service called", lambda c: c.rover.call("chassis_node/stop"), "stopped by hand"),
        no_frame,
        Fault("operator heartbeat ceases", operator(False), "no operator heartbeat", operator(True), 0.9),
        Fault("software emergency stop", emergency(True), "software emergency stop is set", emergency(False)),
        Fault("another publisher clears the emergency stop", foreign_release, "software emergency stop is set",
              emergency(False)),
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
    for _ in range(10000):
        pose = PoseStamped()
        pose.pose.orientation.w = 1
        path.poses.append(pose)
    campaign.publish("waypoints", path)


def many(make, topic, count=2000):
    def inject(campaign):
        for _ in range(count):
            campaign.publish(topic, make())
    return inject


def second_status(campaign):
    campaign.publish("status", OdometryStatus(epoch=7))


def second_odometry(campaign):
    odometry = wrong_odometry()
    campaign.publish("odom", odometry)
    campaign.transform("odom", "base_link", 30, odometry.header.stamp)


def message_faults():
    twist = Twist()
    twist.linear.x = NAN
    uncertain, contradiction = BRIEFLY_UNCERTAIN, "pose contradicts the tracks"
    settle = lambda c: time.sleep(1)  # noqa: E731
    return [
        Fault("a second node tells odom and odom -> base_link 30 m off", second_odometry, contradiction, settle),
        Fault("a second node tells map -> odom 3 m off", lambda c: c.transform("map", "odom", 3, rospy.Time.now() + rospy.Duration(0.5)),
              "map frame has jumped", settle),
        Fault("tf odom -> base_link is not a number", lambda c: c.transform("odom", "base_link", NAN), "drives on"),
        Fault("tf odom -> base_link of the end of time", lambda c: c.transform("odom", "base_link", 30, end_of_time()), "drives on",
              killed("pose_node")),
        Fault("odom of the end of time", lambda c: c.publish("odom", wrong_odometry(end_of_time(), NAN)), "drives on"),
        Fault("odom with a covariance that is not a number", lambda c: c.publish("odom", wrong_odometry(variance=NAN)), uncertain, settle),
        Fault("odom with a covariance of 9999", lambda c: c.publish("odom", wrong_odometry(variance=9999)), uncertain, settle),
        Fault("a second node tells status", second_status, "odometry has started anew", settle),
        Fault("goal that is not a number", lambda c: c.rover.send_goal(NAN), "drives on"),
        Fault("goal 60 m away", lambda c: c.rover.send_goal(60), "drives on"),
        Fault("goal of a minute ago", lambda c: c.rover.send_goal(-3, stamp=rospy.Time.now() - rospy.Duration(60)), "drives on"),
        Fault("goal without a stamp", lambda c: c.rover.send_goal(-3, stamp=rospy.Time()), "drives on"),
        Fault("goal in an unknown frame", lambda c: c.rover.send_goal(1, frame="moon"), "drives on"),
        Fault("path of 10000 waypoints", far_path, "drives on"),
        Fault("cmd_vel while there is a goal", lambda c: c.publish("cmd_vel", Twist()), "drives on"),
        Fault("cmd_vel that is not a number", lambda c: c.publish("cmd_vel", twist), "drives on"),
        Fault("flood of 2000 goals without a stamp", many(PoseStamped, "goal"), "drives on"),
        Fault("flood of 2000 velocities", many(Twist, "cmd_vel"), "drives on"),
        Fault("clear_errors while driving", lambda c: c.rover.call("chassis_node/clear_errors"), "drives on"),
    ]


def all_faults():
    return (operator_faults() + message_faults() + bus_faults() + camera_faults() + node_faults() + machine_faults() +
            last_faults())


def table(rows):
    stops = [1000 * (row["stop_s"] - row["limit_s"]) for row in rows if not row["drives_on"]]
    lines = ["# Faults in the running graph", "",
             "Made by `scripts/fault_campaign.sh`: `simulation.launch` as a user starts it, in real time, with an operator",
             "heartbeat; the bus runs through a tap that notes every command by the steady clock. The rover drives at",
             "0.1 m/s when the fault comes. *Stop* is from the fault to the last frame that moves; the way is that of the",
             "tracks, their own inertia included, until it moves on by good poses, with a warning, or until",
             "%g s after the limit. Limits are in simulated time, which rendering holds back; they stand here in wall time." % WATCH_S,
             "",
             "| | |", "|---|---|",
             "| faults, as promised | %d, %d |" % (len(rows), sum(row["kept"] for row in rows)),
             "| false arrivals | %d |" % sum(row["arrived"] for row in rows)]
    if stops:
        lines.append("| stop after the fault or its limit, median and worst, ms | %.0f, %.0f |" %
                     (statistics.median(stops), max(stops)))
    lines += ["", "| fault | promised | told | limit, s | stop, ms | way, m | to go on | as promised |", "|" + "---|" * 8]
    for row in rows:
        drives_on = row["drives_on"]
        lines.append("| %s | %s | %s | %s | %s | %.2f | %s | %s |" % (
            row["name"], row["promise"], "; ".join(row["told"]), "%.1f" % row["limit_s"] if row["limit_s"] else "",
            "" if drives_on else "%.0f" % (1000 * row["stop_s"]), row["way_m"], row["go_on"], "yes" if row["kept"] else "NO"))
    return "\n".join(lines) + "\n"


def run(faults, log, output, max_stop_s):
    driver_port = find_bus_port(4721)
    chassis_port = find_bus_port(driver_port + 1)
    tap = bus.BusTap(driver_port, chassis_port)
    launch = Launch(log, driver_port, chassis_port)
    rows = []
    try:
        while subprocess.run(["rosparam", "get", "/use_sim_time"], capture_output=True).returncode != 0:
            if launch.process.poll() is not None:
                raise RuntimeError("roslaunch has ended:\n" + pathlib.Path(log.name).read_text()[-2000:])
            time.sleep(0.2)
        rospy.init_node("fault_campaign", disable_signals=True)
        camera = camera_tap.CameraTap()
        rover = Rover(tap)
        if not rover.wait(lambda: rover.status is not None, 120):
            raise RuntimeError("the rover does not come up")
        is_silent = tap.num_commands == 0
        campaign = Campaign(rover, tap, camera, launch, max_stop_s)
        for fault in faults:
            try:
                row = campaign.measure_undisturbed(fault)
            except NotPermitted as error:
                print("%s: left out, not permitted here: %s" % (fault.name, error), flush=True)
                continue
            if row is None:
                print("%s: the rover could not be made to drive: %s" % (fault.name, rover.status.reason), flush=True)
                row = {"name": fault.name, "promise": fault.promise, "told": ["did not drive before"], "limit_s": 0,
                       "stop_s": math.inf, "way_m": 0, "go_on": "", "kept": False, "arrived": 0, "drives_on": False}
            print(row, flush=True)
            rows.append(row)
            if output:
                output.write_text(table(rows))
        if not is_silent:
            print("frames were sent before start", flush=True)
            rows[0]["kept"] = False
    finally:
        launch.end()
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", help="faults whose name holds one of these, separated by |")
    parser.add_argument("--output", type=pathlib.Path, help="the table, Markdown")
    parser.add_argument("--max-stop-s", type=float, default=MAX_STOP_S, help="after the fault or its limit")
    arguments = parser.parse_args()
    names = arguments.only.split("|") if arguments.only else [""]
    faults = [fault for fault in all_faults() if any(name in fault.name for name in names)]
    if not faults:
        sys.exit("no fault's name holds " + arguments.only)
    with tempfile.NamedTemporaryFile(suffix=".log", prefix="fault_campaign_") as log:
        rows = run(faults, log, arguments.output, arguments.max_stop_s)
    return 0 if all(row["kept"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
