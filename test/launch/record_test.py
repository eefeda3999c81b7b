#!/usr/bin/python3
"""launch/record.launch records whole pairs, who called start, and a ring of bags that leaves earlier drives alone.

Usage: record_test.py      in a shell that knows the package; a master of its own
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from ports import find_free_port  # noqa: E402

os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % find_free_port()

import rosbag  # noqa: E402
import rospy  # noqa: E402
from sensor_msgs.msg import CameraInfo, Image  # noqa: E402
from std_msgs.msg import Bool  # noqa: E402

EVERY_NTH = 5
PATIENCE_S = 60
EARLIER = "drive_2000-01-01-00-00-00_0.bag"
SIDES = ("left", "right")


class Camera:
    """Pairs at 20 Hz, of which the right image is missing now and then."""

    def __init__(self, width, height):
        self.kinds = [(camera, name, kind) for camera in SIDES for name, kind in (("image_raw", Image), ("camera_info", CameraInfo))]
        self.publishers = {(camera, name): rospy.Publisher("/stereo/%s/%s" % (camera, name), kind, queue_size=10)
                           for camera, name, kind in self.kinds}
        self.image = Image(width=width, height=height, step=width, encoding="mono8", data=os.urandom(width * height))

    def publish(self, index):
        stamp = rospy.Time(1000 + index // 20, index % 20 * 50000000)
        for camera, name, kind in self.kinds:
            is_missing = camera == "right" and name == "image_raw" and (index < 3 or index % 7 == 0)
            message = self.image if kind is Image else CameraInfo(width=self.image.width, height=self.image.height)
            message.header.stamp = stamp
            if not is_missing:
                self.publishers[camera, name].publish(message)
        time.sleep(0.05)

    def is_listened_to(self):
        return all(publisher.get_num_connections() > 0 for publisher in self.publishers.values())


def wait(condition, what):
    end = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError("nothing of it in %g s: %s" % (PATIENCE_S, what))
        time.sleep(0.05)


def bags_in(folder):
    return sorted(path for path in folder.iterdir() if ".bag" in path.name and path.name != EARLIER)


def record(folder, camera, num_pairs, *arguments):
    """Records while the camera tells so many pairs."""
    command = ["roslaunch", "arfm_vo", "record.launch", "folder:=%s" % folder, "min_space:=0", "every_nth_pair:=%d" % EVERY_NTH]
    stops = rospy.Publisher("emergency_stop", Bool, queue_size=1)
    launch = subprocess.Popen(command + list(arguments), stdout=subprocess.DEVNULL)
    try:
        wait(lambda: camera.is_listened_to() and stops.get_num_connections() > 0, "subscribers")
        stops.publish(Bool(True))
        rospy.loginfo("start called by /somebody: started")
        for index in range(num_pairs):
            camera.publish(index)
    finally:
        launch.send_signal(signal.SIGINT)
        launch.wait(PATIENCE_S)


def check_contents(folder):
    record(folder, Camera(64, 48), 120)
    bags = bags_in(folder)
    assert len(bags) == 1 and bags[0].suffix == ".bag", bags
    stamps, topics = {camera: [] for camera in SIDES}, set()
    is_start_told = False
    with rosbag.Bag(str(bags[0])) as bag:
        for topic, message, _ in bag.read_messages():
            topics.add(topic)
            is_start_told |= topic == "/rosout_agg" and message.msg.startswith("start called by /somebody")
            for camera in SIDES:
                if topic == "/black_box/%s/image_raw" % camera:
                    stamps[camera].append(message.header.stamp)
    assert stamps["left"] == stamps["right"], "pairs are torn: %s" % stamps
    assert 10 <= len(stamps["left"]) <= 120 // EVERY_NTH, stamps["left"]
    assert is_start_told and "/emergency_stop" in topics, topics
    assert {"/black_box/%s/camera_info" % camera for camera in SIDES} <= topics, topics


def check_ring(folder):
    """1 MB a bag, 2 bags and the one that is written, and some 10 MB to record.

    rosbag ends a bag where what it has on the disk exceeds 1 MiB: the chunk in its memory (768 KiB) and a picture go beyond.
    """
    earlier = folder / EARLIER
    earlier.write_bytes(b"of an earlier drive")
    record(folder, Camera(640, 480), 120, "size_mb:=1", "num_bags:=2")
    bags = bags_in(folder)
    size_mb = sum(path.stat().st_size for path in bags) / 1e6
    assert 1 <= len(bags) <= 3 and size_mb < 3 * 2.15, "%.1f MB in %s" % (size_mb, bags)
    assert any(not path.name.endswith("_0.bag") for path in bags), "the ring has not gone round: %s" % bags
    assert earlier.read_bytes() == b"of an earlier drive"


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it, and so do its children
    master = subprocess.Popen(["roscore", "-p", os.environ["ROS_MASTER_URI"].rpartition(":")[2]], stdout=subprocess.DEVNULL)
    try:
        rospy.init_node("record_test", disable_signals=True)
        for check in check_contents, check_ring:
            with tempfile.TemporaryDirectory() as folder:
                check(pathlib.Path(folder))
            print("%s: passed" % check.__name__)
    finally:
        try:
            rospy.signal_shutdown("done")
        except AttributeError:
            pass  # Debian 11: its rospy calls Thread.isAlive, which its Python 3.9 has no more
        master.terminate()
        master.wait()


if __name__ == "__main__":
    main()
