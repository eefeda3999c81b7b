#!/usr/bin/python3
"""Feeds recordings, back and forth and with faults, through arfm_node, pose_node and ba_node as fast as they take them,
restarts a node now and then, and writes what each needs to a CSV. See scripts/soak.sh.

Usage: soak.py --pairs N --restart-every N --restart-from N --max-seconds S --csv FILE --programs DIR KITTI_FOLDER ...
"""
import argparse
import csv
import itertools
import os
import pathlib
import signal
import struct
import subprocess
import threading
import time

import cv2
import numpy
import rospy
import soak_report
from arfm_vo.msg import OdometryStatus
from rospy.msg import AnyMsg
from sensor_msgs.msg import CameraInfo, Image

NODES = ("arfm_node", "pose_node", "ba_node")
OUTPUT = {"arfm_node": "features", "pose_node": "odom", "ba_node": "map_update"}  # its latency is that to this topic
BOUNDED = ("map_update", "path", "keyframe", "path_optimized")
ROUNDS = 4             # each recording goes back and forth so many times before the next
STEP_S = 0.1           # between stamps
IN_FLIGHT = 2          # pairs on their way at a time
ANSWER_S = 2           # after which a pair counts as not answered
SAMPLE_PAIRS = 200
FAULT_PERIOD = 100     # a fault begins at each so manyth pair
RECOVERY_PAIRS = 60    # within which a tracked pair is expected after a fault, a new recording, a restart


def grey(factor):
    return lambda image: numpy.clip(image * factor, 0, 255).astype(numpy.uint8)


def same(image):
    return image


# Name, pairs it lasts, change of the left and of the right image; None: the pair does not come.
FAULTS = (("drop-out", 5, None, None), ("darkness", 10, grey(0), grey(0)), ("exposure halved", 20, grey(0.5), grey(0.5)),
          ("blur", 5, lambda image: cv2.blur(image, (11, 11)), lambda image: cv2.blur(image, (11, 11))),
          ("exposure doubled", 20, grey(2), grey(2)), ("right eye dark", 10, same, grey(0)),
          ("time 60 s back", 1, same, same), ("time 60 s ahead", 1, same, same))


class Recording:
    def __init__(self, folder):
        eyes = [sorted(pathlib.Path(folder).glob(pattern)) for pattern in
                ("image_0/*.png", "image_1/*.png", "image_00/data/*.png", "image_01/data/*.png")]
        left, right = eyes[:2] if eyes[0] else eyes[2:]
        self.pairs = [tuple(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in paths) for paths in zip(left, right)]
        self.infos = [self.camera_info(folder, eye, self.pairs[0][0].shape) for eye in (0, 1)]

    @staticmethod
    def camera_info(folder, eye, shape):
        for name, key in (("calib.txt", f"P{eye}:"), ("calib_cam_to_cam.txt", f"P_rect_0{eye}:"),
                          ("../calib_cam_to_cam.txt", f"P_rect_0{eye}:")):
            path = pathlib.Path(folder, name)
            lines = path.read_text().splitlines() if path.exists() else []
            for line in lines:
                if line.startswith(key):
                    info = CameraInfo(height=shape[0], width=shape[1], distortion_model="plumb_bob", D=[0.0] * 5)
                    info.P = [float(word) for word in line.split()[1:]]
                    info.K = [info.P[i] for i in (0, 1, 2, 4, 5, 6, 8, 9, 10)]
                    info.R = [1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0]
                    return info
        raise SystemExit(f"soak: {folder}: no calibration with {key}")

    def back_and_forth(self):
        there = list(range(len(self.pairs)))
        return (there + there[-2:0:-1]) * ROUNDS


def proc(pid, name):
    return pathlib.Path("/proc", str(pid), name)


class Node:
    """One of the three as a process of its own."""

    def __init__(self, programs, name, log):
        self.command = [os.path.join(programs, name), f"__name:={name}", "_remember_calibration:=false"]
        self.log, self.process, self.restarts = log, None, 0
        self.start()

    def start(self):
        self.process = subprocess.Popen(self.command, stdout=self.log, stderr=subprocess.STDOUT)

    def restart(self, kind):
        self.process.send_signal(kind)
        self.process.wait(30)
        self.restarts += 1
        self.start()

    def needs(self):
        """Resident MB, open files, threads."""
        pid = self.process.pid
        pages = int(proc(pid, "statm").read_text().split()[1])
        return pages * 4096 / 1e6, len(list(proc(pid, "fd").iterdir())), len(list(proc(pid, "task").iterdir()))


class Answers:
    """When each pair was sent and what came of it; sizes of what is published."""

    def __init__(self):
        self.changed = threading.Condition()
        self.sent, self.states = {}, {}
        self.latencies_ms = {name: [] for name in NODES}
        self.sizes = dict.fromkeys(BOUNDED, 0)
        self.dropped = (0, 0)
        self.subscribers = [rospy.Subscriber("status", OdometryStatus, self.take_status, queue_size=100, tcp_nodelay=True)]
        for topic in {*OUTPUT.values(), *BOUNDED}:
            self.subscribers.append(rospy.Subscriber(topic, AnyMsg, self.take, topic, queue_size=100, tcp_nodelay=True))

    def take_status(self, status):
        with self.changed:
            self.states[(status.header.stamp.secs, status.header.stamp.nsecs)] = status.state
            self.dropped = (status.num_dropped_arfm, status.num_dropped_pose)
            self.changed.notify_all()

    def take(self, message, topic):
        now, stamp = time.monotonic(), struct.unpack_from("<II", message._buff, 4)
        with self.changed:
            if topic in self.sizes:
                self.sizes[topic] = max(self.sizes[topic], len(message._buff))
            for name in NODES:
                if OUTPUT[name] == topic and stamp in self.sent:
                    self.latencies_ms[name].append(1e3 * (now - self.sent[stamp]))

    def wait(self, stamp):
        """The state of a pair, or None where it is not answered in time."""
        with self.changed:
            self.changed.wait_for(lambda: stamp in self.states, ANSWER_S)
            return self.states.get(stamp)

    def forget(self):
        """The stamps that follow may have been used before."""
        with self.changed:
            self.sent.clear()
            self.states.clear()

    def take_sample(self):
        with self.changed:
            taken = {name: sorted(values) for name, values in self.latencies_ms.items()}
            self.latencies_ms = {name: [] for name in NODES}
            sizes, self.sizes = self.sizes, dict.fromkeys(BOUNDED, 0)
            for old in list(self.sent)[:-1000]:
                del self.sent[old]
            for old in list(self.states)[:-1000]:
                del self.states[old]
        return taken, sizes


def quantile(values, fraction):
    return round(values[round(fraction * (len(values) - 1))], 1) if values else float("nan")


class Soak:
    def __init__(self, options):
        self.options = options
        self.recordings = [Recording(folder) for folder in options.folders]
        self.log = open(options.csv + ".log", "w", encoding="utf-8")
        self.publishers = [rospy.Publisher(f"stereo/{eye}/image_rect", Image, queue_size=10) for eye in ("left", "right")]
        self.info_publishers = [rospy.Publisher(f"stereo/{eye}/camera_info", CameraInfo, queue_size=10)
                                for eye in ("left", "right")]
        self.answers = Answers()
        self.nodes = {name: Node(options.programs, name, self.log) for name in NODES}
        self.mount = subprocess.Popen([os.path.join(options.programs, "camera_mount_node"), "_camera_frame:=left_camera_optical",
                                       "_base_from_camera:=0 0 1.65 -1.5707963 0 -1.5707963"], stdout=self.log, stderr=self.log)
        self.stamp_s, self.count, self.unanswered, self.tracked, self.degraded = 1000.0, 0, 0, 0, 0
        self.waited, self.longest_wait, self.worst = 0, 0, "nothing"
        self.waits = {}  # pairs until tracked again, the most, after each kind of event
        self.in_flight = []

    def event(self, name):
        """After this the odometry may need some pairs."""
        self.worst, self.waited = name, 0

    def send(self, recording, index, left, right):
        self.stamp_s += STEP_S
        stamp = rospy.Time.from_sec(round(self.stamp_s, 3))
        with self.answers.changed:
            self.answers.sent[(stamp.secs, stamp.nsecs)] = time.monotonic()
        for info, publisher in zip(recording.infos, self.info_publishers):
            info.header.stamp, info.header.frame_id = stamp, "left_camera_optical"
            publisher.publish(info)
        for image, change, publisher in zip(recording.pairs[index], (left, right), self.publishers):
            message = Image(height=image.shape[0], width=image.shape[1], encoding="mono8", step=image.shape[1],
                            data=change(image).tobytes())
            message.header.stamp, message.header.frame_id = stamp, "left_camera_optical"
            publisher.publish(message)
        self.in_flight.append((stamp.secs, stamp.nsecs))
        self.finish_pairs(IN_FLIGHT - 1)

    def finish_pairs(self, num_left=0):
        while len(self.in_flight) > num_left:
            self.judge(self.answers.wait(self.in_flight.pop(0)))

    def judge(self, state):
        self.waited += 1
        self.unanswered += state is None
        self.degraded += state == OdometryStatus.DEGRADED
        if state == OdometryStatus.TRACKED:
            self.tracked += 1
            self.waits[self.worst] = max(self.waits.get(self.worst, 0), self.waited)
            self.worst, self.waited = "nothing", 0

    def sample(self, writer, start):
        taken, sizes = self.answers.take_sample()
        for name, node in self.nodes.items():
            memory, files, threads = node.needs()
            writer.writerow([self.count, round(time.monotonic() - start), name, node.restarts, round(memory, 2), files, threads,
                             quantile(taken[name], 0.5), quantile(taken[name], 0.99), self.tracked, self.unanswered,
                             *self.answers.dropped, *(sizes[topic] for topic in BOUNDED)])

    def restart(self, turn):
        name = NODES[turn % 3]
        self.finish_pairs()
        self.nodes[name].restart(signal.SIGTERM if turn % 2 == 0 else signal.SIGKILL)
        self.wait_for_nodes()
        self.event(f"restart of {name}")

    def wait_for_nodes(self):
        end = time.monotonic() + 30
        while (any(publisher.get_num_connections() < 2 for publisher in self.publishers) or
               any(subscriber.get_num_connections() < 1 for subscriber in self.answers.subscribers)):
            if time.monotonic() > end:
                raise SystemExit("soak: the nodes did not subscribe within 30 s; see " + self.log.name)
            time.sleep(0.05)

    def run(self):
        self.wait_for_nodes()
        start = time.monotonic()
        with open(self.options.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["pairs", "seconds", "node", "restarts", "resident_mb", "files", "threads", "p50_ms", "p99_ms", "tracked",
                             "unanswered", "dropped_arfm", "dropped_pose", *(topic + "_bytes" for topic in BOUNDED)])
            try:
                for recording in itertools.cycle(self.recordings):
                    self.event("a new recording")
                    for index in recording.back_and_forth():
                        if self.count >= self.options.pairs or time.monotonic() - start > self.options.max_seconds:
                            return
                        if index in (0, len(recording.pairs) - 1) and self.worst == "nothing":
                            self.event("a turn round at full speed")
                        self.step(recording, index)
                        if self.count % SAMPLE_PAIRS == 0:
                            self.sample(writer, start)
                            file.flush()
            finally:
                self.end()

    def step(self, recording, index):
        self.count += 1
        every = self.options.restart_every
        if self.count >= self.options.restart_from and self.count % every == FAULT_PERIOD // 2:  # between two faults
            self.restart(self.count // every)
        name, length, left, right = FAULTS[self.count // FAULT_PERIOD % len(FAULTS)]
        age = self.count % FAULT_PERIOD
        if self.count < FAULT_PERIOD or age >= length:
            left = right = same
        elif age == 0:
            self.event(name)
        if self.count >= FAULT_PERIOD and age == length - 1:
            self.event(name)
            step_s = {"time 60 s back": -60, "time 60 s ahead": 60}.get(name, 0)
            if step_s:
                self.finish_pairs()
                self.answers.forget()
                self.stamp_s += step_s
        if left:
            self.send(recording, index, left, right)
        else:
            self.stamp_s += STEP_S

    def end(self):
        for process in [self.mount, *(node.process for node in self.nodes.values())]:
            process.terminate()
        for process in [self.mount, *(node.process for node in self.nodes.values())]:
            process.wait(30)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--pairs", type=int, required=True)
    parser.add_argument("--restart-every", type=int, required=True)
    parser.add_argument("--restart-from", type=int, required=True)
    parser.add_argument("--max-seconds", type=float, default=float("inf"))
    parser.add_argument("--csv", required=True)
    parser.add_argument("--programs", required=True)
    parser.add_argument("folders", nargs="+")
    options = parser.parse_args()
    rospy.init_node("soak", disable_signals=True)
    soak = Soak(options)
    soak.run()
    with open(options.csv, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    soak_report.summary(soak.count, soak.tracked, soak.degraded, soak.unanswered, float(rows[-1]["seconds"]))
    soak_report.growth(rows, NODES, options.restart_from)
    soak_report.waits(soak.waits)
    soak_report.sizes(rows, BOUNDED)
    if soak.worst != "nothing" and soak.waited > RECOVERY_PAIRS:
        raise SystemExit(f"soak: not tracked in {soak.waited} pairs after {soak.worst}")


if __name__ == "__main__":
    main()
