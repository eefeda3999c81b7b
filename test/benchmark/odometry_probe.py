#!/usr/bin/python3
"""Watches a running odometry chain from outside until it is ended by SIGTERM, then prints one line of figures.

Usage: odometry_probe.py START_S          START_S: time.time() at which roslaunch was started
Prints: first_pose_s pairs poses dropped_arfm dropped_pose pairs_per_s latency_p50_ms latency_p95_ms rss_early_mb rss_end_mb
Latency is wall time from a pair's camera_info to its odometry, both as received here.
"""
import pathlib
import re
import struct
import sys
import threading
import time

import rospy
from rospy.msg import AnyMsg
from arfm_vo.msg import OdometryStatus

NODES = re.compile(rb"__name:=(arfm_node|pose_node|ba_node|odometry_manager)\b")


def stamp_of(message):
    """The stamp of a message that begins with a header, as (secs, nsecs)."""
    return struct.unpack_from("<II", message._buff, 4)


def resident_mb():
    """Resident memory of all processes of the chain."""
    pages = 0
    for process in pathlib.Path("/proc").iterdir():
        try:
            if process.name.isdigit() and NODES.search((process / "cmdline").read_bytes()):
                pages += int((process / "statm").read_text().split()[1])
        except OSError:
            pass
    return pages * 4096 / 1e6


def quantile(values, fraction):
    return sorted(values)[round(fraction * (len(values) - 1))] if values else float("nan")


class Probe:
    def __init__(self, start_s):
        self.start_s = start_s
        self.first_pose_s = float("nan")
        self.published = {}
        self.latencies_ms = []
        self.arrivals = []
        self.dropped = (0, 0)
        self.resident = []
        rospy.Subscriber("/stereo/left/camera_info", AnyMsg, self.take_pair, queue_size=1000, tcp_nodelay=True)
        rospy.Subscriber("/odom", AnyMsg, self.take_pose, queue_size=1000, tcp_nodelay=True)
        rospy.Subscriber("/status", OdometryStatus, self.take_status, queue_size=1000)
        threading.Thread(target=self.watch_memory, daemon=True).start()

    def take_pair(self, message):
        self.published[stamp_of(message)] = time.time()

    def take_pose(self, message):
        now = time.time()
        if not self.arrivals:
            self.first_pose_s = now - self.start_s
        self.arrivals.append(now)
        published = self.published.get(stamp_of(message))
        if published is not None:
            self.latencies_ms.append(1e3 * (now - published))

    def take_status(self, status):
        self.dropped = (status.num_dropped_arfm, status.num_dropped_pose)

    def watch_memory(self):
        while not rospy.is_shutdown():
            megabytes = resident_mb()
            if self.arrivals and megabytes > 0:
                self.resident.append(megabytes)
            time.sleep(0.25)

    def report(self):
        span_s = self.arrivals[-1] - self.arrivals[0] if len(self.arrivals) > 1 else float("nan")
        early = self.resident[len(self.resident) // 4] if self.resident else float("nan")
        end = max(self.resident[-4:], default=float("nan"))
        return (f"{self.first_pose_s:.2f} {len(self.published)} {len(self.arrivals)} {self.dropped[0]} "
                f"{self.dropped[1]} {(len(self.arrivals) - 1) / span_s:.1f} {quantile(self.latencies_ms, 0.5):.1f} "
                f"{quantile(self.latencies_ms, 0.95):.1f} {early:.0f} {end:.0f}")


def main():
    # In wall time whatever /use_sim_time says: nothing here waits for ROS time.
    rospy.init_node("odometry_probe", anonymous=True, disable_signals=False)
    probe = Probe(float(sys.argv[1]))
    rospy.spin()
    print(probe.report(), flush=True)


if __name__ == "__main__":
    main()
