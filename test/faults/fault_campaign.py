#!/usr/bin/python3
"""Injects faults into the running graph of launch/simulation.launch and writes what became of each.

Exit status 0 where every row is as promised.
"""
import argparse
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path[:0] = [str(folder) for folder in list(pathlib.Path(__file__).resolve().parents)[:2]]  # (no slices before Python 3.10)
import bus_tap as bus  # noqa: E402
import camera_tap  # noqa: E402
import rospy  # noqa: E402
import tf2_ros  # noqa: E402
from bus_faults import bus_faults  # noqa: E402
from camera_faults import camera_faults  # noqa: E402
from fault import BY_ITSELF, EITHER, HELD_UP, PAUSES, NotPermitted  # noqa: E402
from machine_faults import last_faults, machine_faults  # noqa: E402
from message_faults import message_faults, operator_faults  # noqa: E402
from node_faults import node_faults  # noqa: E402
from topic_faults import topic_faults  # noqa: E402
from arfm_vo.msg import DriveStatus, GoalReport, OdometryStatus  # noqa: E402
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist  # noqa: E402
from nav_msgs.msg import Odometry, Path  # noqa: E402
from rover import UNCERTAIN, Launch, Rover, pids_of_nodes, start_again  # noqa: E402
from ports import find_bus_port  # noqa: E402
from readme_section import replace_section  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from table import WATCH_S, tables  # noqa: E402

MAX_STOP_S = 0.3  # after the fault, or after its limit
MAX_WAY_M = 0.10  # of the tracks from the fault on, their own inertia included
# A row in which the machine held the campaign up for so long says nothing of the rover: it is measured anew; so is one that
# fails where it held chassis_node up, which says so and pauses.
MAX_HELD_UP_S = 0.3
MAX_TRIES = 3
MAX_WAIT_S = 30  # for simulated time where the machine holds it back


class Campaign:
    def __init__(self, rover, tap, camera, launch, max_stop_s):
        self.rover, self.tap, self.camera, self.launch, self.max_stop_s = rover, tap, camera, launch, max_stop_s
        self.pids, self.children = {}, []
        self.began_s, self.began_simulated_s, self.began_way_m = 0.0, 0.0, 0.0  # the fault, by both clocks and the tracks
        self.broadcaster = tf2_ros.TransformBroadcaster()
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10) for topic, kind in (
            ("odom", Odometry), ("status", OdometryStatus), ("waypoints", Path), ("cmd_vel", Twist), ("goal", PoseStamped))}
        self.clock = rospy.Publisher("/clock", Clock, queue_size=1)

    # What a fault may do.

    def begin(self):
        """The fault begins now; one that takes time to prepare says so itself."""
        self.began_s, self.began_simulated_s, self.began_way_m = time.monotonic(), rospy.get_time(), self.tap.way_m()
        self.rover.told = {}

    def signal(self, node, number):
        os.kill(self.pids[node], number)

    def restart(self, node):
        self.children.append(start_again(node))

    def publish(self, topic, message):
        self.publishers[topic].publish(message)

    def transform(self, parent, child, x_m, stamp=None, tilt_rad=0):
        message = TransformStamped()
        message.header.frame_id, message.child_frame_id = parent, child
        message.header.stamp = stamp if stamp is not None else rospy.Time.now()
        message.transform.translation.x = x_m
        message.transform.rotation.x, message.transform.rotation.w = math.sin(tilt_rad / 2), math.cos(tilt_rad / 2)
        self.broadcaster.sendTransform(message)

    def command(self, text):
        subprocess.run(text, shell=True, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def obey(self, change):
        self.tap.change = change

    # A row.

    def measure(self, fault):
        """The row of a fault; None where the rover could not be made to drive."""
        if not self.rover.drive(fault.by_velocity):
            return None
        self.pids = pids_of_nodes()
        del self.rover.reports[:]
        del self.rover.odometry_texts[:]
        self.rover.sight.mark()
        self.begin()
        fault.inject(self)
        injected_s, simulated_s, way_m = self.began_s, self.began_simulated_s, self.began_way_m
        end_s = max(injected_s + fault.limit_s + WATCH_S, time.monotonic() + WATCH_S / 2)  # injecting may take long
        simulated_end_s = simulated_s + fault.limit_s + WATCH_S / 2
        told, has_warned, end_way_m = self.rover.told, False, way_m
        looked_s, held_up_s, limit_ended_s = time.monotonic(), 0.0, injected_s
        awaited = {fault.promise} if fault.ends_node and fault.promise != "-" and " or " not in fault.promise else set()
        while looked_s < end_s or (not fault.ends_graph and looked_s < end_s + MAX_WAIT_S and (
                rospy.get_time() < simulated_end_s or not awaited <= told.keys())):  # a node may be slow to start
            if rospy.get_time() < simulated_s + fault.limit_s:  # simulated time runs unevenly on a busy machine
                limit_ended_s = looked_s
            has_warned |= self.rover.status.state == DriveStatus.WARNING
            moves_on = has_warned and self.tap.starts_s and self.tap.starts_s[-1] > injected_s
            if not (moves_on and fault.may_go_on):
                end_way_m = self.tap.way_m()
            time.sleep(0.01)
            held_up_s, looked_s = max(held_up_s, time.monotonic() - looked_s), time.monotonic()
        pace = min(1.0, max(0.1, (rospy.get_time() - simulated_s) / (time.monotonic() - injected_s)))
        row = {"name": fault.name, "promise": fault.promise, "limit_s": max(fault.limit_s, limit_ended_s - injected_s),
               "held_up_s": held_up_s, "details": dict(told), "moves": self.rover.moves()}
        row["wrong_way_m"] = self.rover.sight.wrong_way_m(end_way_m)
        row["dead"] = [node for node, pid in self.pids.items() if not os.path.exists("/proc/%d" % pid)]
        stops_s = [stop_s for stop_s in self.tap.stops_s if stop_s >= injected_s]
        row["stop_s"] = (stops_s[0] if stops_s else self.tap.moving_s) - injected_s
        row["way_m"] = end_way_m - way_m
        row["told"] = [reason for reason in row["details"] if reason != "none"]
        row["drives_on"] = fault.promise == "drives on" or (fault.promise.startswith("drives on") and row["moves"] and not row["told"])
        row["arrived"] = sum(report.result == GoalReport.ARRIVED for report in self.rover.reports)
        is_well = fault.is_well(self)
        fault.mend(self)
        row["go_on"] = "" if fault.ends_graph else self.find_what_it_takes(row)
        self.rover.speed_mps = None
        row["unwarned"] = 0 if fault.ends_graph else self.rover.count_unwarned(injected_s, pace)
        row["kept"] = self.is_kept(fault, row) and is_well
        return row

    def measure_undisturbed(self, fault):
        """The same; once more where the machine held the campaign up and that may be why it is not as promised."""
        for attempt in range(1, MAX_TRIES + 1):
            row = self.measure(fault)
            is_halted = row and HELD_UP in row["told"] and HELD_UP not in fault.promise
            is_disturbed = row and not row["kept"] and (row["held_up_s"] > MAX_HELD_UP_S or is_halted)
            if not is_disturbed or fault.ends_graph or fault.is_load or attempt == MAX_TRIES:
                return row
            print("%s: held up (%.2f s; told: %s), measured anew" % (fault.name, row["held_up_s"], row["told"]), flush=True)

    def is_kept(self, fault, row):
        is_dead = row["dead"] and not (fault.ends_node or fault.ends_graph)
        is_paused = set(row["told"]) <= PAUSES  # and nothing else
        is_started = row["go_on"] != BY_ITSELF or is_paused
        if row["arrived"] or is_dead or row["unwarned"] or not is_started or row["wrong_way_m"] > fault.max_wrong_way_m:
            return False
        if fault.promise == EITHER:
            return row["moves"] or row["told"] != []
        promises = [fault.promise] + fault.promise.split(" or ")
        if row["drives_on"]:
            return row["moves"] and not row["told"]
        is_told = fault.promise == "-" or any(promise in row["told"] for promise in promises) or ("-" in promises and not row["told"])
        allowed_m = MAX_WAY_M + 0.1 * row["limit_s"]
        is_over = not row["moves"] or (fault.may_go_on and is_paused)
        is_soon = row["stop_s"] <= row["limit_s"] + self.max_stop_s
        return is_told and is_over and is_soon and row["way_m"] <= allowed_m

    def find_what_it_takes(self, row):
        if row["drives_on"]:
            return ""
        rover = self.rover
        rover.wait(lambda: time.monotonic() - self.tap.moving_s > 0.5, 2)
        if rover.wait_simulated(rover.moves, 6):
            return BY_ITSELF
        is_uncertain = UNCERTAIN in (rover.status.reason + rover.status.detail)
        rover.wait(rover.start, 20)
        start = "datum and start" if is_uncertain else "start"
        return start if rover.wait_simulated(rover.moves, 3) else start + " and a new goal"


def all_faults():
    """Of the graph that runs."""
    return (operator_faults() + message_faults() + bus_faults() + camera_faults() + node_faults() + topic_faults() +
            machine_faults() + last_faults())


def did_not_drive(fault):
    return {"name": fault.name, "promise": fault.promise, "told": ["did not drive before"], "limit_s": 0, "stop_s": math.inf,
            "way_m": 0, "wrong_way_m": 0, "go_on": "", "kept": False, "arrived": 0, "unwarned": 0, "drives_on": False}


def run(names, log, page, max_stop_s):
    driver_port = find_bus_port(4721)
    chassis_port = find_bus_port(driver_port + 1)
    tap = bus.BusTap(driver_port, chassis_port)
    launch = Launch(log, driver_port, chassis_port)
    rows, campaign = [], None
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
        faults = [fault for fault in all_faults() if any(name in fault.name for name in names)]
        if not faults:
            sys.exit("no fault's name holds " + "|".join(names))
        campaign = Campaign(rover, tap, camera, launch, max_stop_s)
        for fault in faults:
            try:
                row = campaign.measure_undisturbed(fault)
            except NotPermitted as error:
                print("%s: left out, not permitted here: %s" % (fault.name, error), flush=True)
                continue
            if row is None:
                print("%s: the rover could not be made to drive: %s" % (fault.name, rover.status.reason), flush=True)
                row = did_not_drive(fault)
            print(row, flush=True)
            rows.append(row)
            for name, text in tables(rows).items() if page else ():
                replace_section(page, name, text)
        if not is_silent:
            print("frames were sent before start", flush=True)
            rows[0]["kept"] = False
    finally:
        for child in campaign.children if campaign else []:
            child.kill()
        launch.end()
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", help="faults whose name holds one of these, separated by |")
    parser.add_argument("--output", metavar="PAGE", type=argparse.FileType("r+"), help="whose tables are replaced")
    parser.add_argument("--max-stop-s", type=float, default=MAX_STOP_S, help="after the fault or its limit")
    arguments = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it, and so do its children
    names = arguments.only.split("|") if arguments.only else [""]
    with tempfile.NamedTemporaryFile(suffix=".log", prefix="fault_campaign_") as log:
        rows = run(names, log, arguments.output and arguments.output.name, arguments.max_stop_s)
    return 0 if all(row["kept"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
