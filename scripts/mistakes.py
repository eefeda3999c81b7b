#!/usr/bin/python3
"""Makes the mistakes of new users on the fixture and writes docs/mistakes.md: what the console says, and how soon.

Usage: mistakes.py [BUILD_DIR]      default _b; exit status 1 where a mistake is not told within 10 s of the nodes' start
"""
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

import rosbag
import rospy
from ports import find_free_port
from sensor_msgs.msg import CompressedImage

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "_b"))
FIXTURE = os.path.join(ROOT, "rosbag_fixtures", "terrain.bag")
LIMIT_S = 10


def without(*ends):
    return lambda topic, message: None if topic.endswith(ends) else (topic, message)


def change(end, edit):
    """Applies `edit` to the messages whose topic ends so."""
    def apply(topic, message):
        if topic.endswith(end):
            edit(message)
        return topic, message
    return apply


def scale_baseline(factor):
    def edit(message):
        message.P = [factor * value if i == 3 else value for i, value in enumerate(message.P)]
    return change("right/camera_info", edit)


def delay(message):
    message.header.stamp += rospy.Duration(0.002)


def make_float(message):
    message.encoding, message.step, message.data = "32FC1", 4 * message.width, bytes(4 * len(message.data))


def narrow(message):
    message.width -= 8


def darken(message):
    message.data = bytes(len(message.data))


def compress(topic, message):
    if not topic.endswith("image_rect"):
        return topic, message
    return topic + "/compressed", CompressedImage(message.header, "png", b"")


def swap(topic, message):
    if "/left/" in topic:
        return topic.replace("left", "right"), message
    return topic.replace("right", "left"), message


PROGRAMS = BUILD + "/devel/lib/arfm_vo/"
REPLAY = "replay.launch rviz:=false bag:=input.bag "
LIVE = ("odometry.launch & sleep 3; rosbag play --quiet input.bag & "
        "wait %1")  # as beside a camera of one's own
# (mistake, change of the bag, arguments of roslaunch, the thing and the remedy that one line of the console must name)
MISTAKES = [
    ("no such bag", None, "replay.launch rviz:=false bag:=none.bag", "none.bag: no such file", "path is that of the folder"),
    ("damaged bag", "half", REPLAY, "input.bag: cannot be read", "rosbag reindex"),
    ("wrong namespace", None, REPLAY + "stereo:=/cam", "its cameras are /stereo/left", "give stereo:="),
    ("one eye in the bag", without("right/image_rect"), REPLAY, "has no topic /stereo/right/image_rect", "right_image:="),
    ("no camera_info in the bag", without("left/camera_info"), REPLAY, "has no topic /stereo/left/camera_info", "left_info:="),
    ("raw images", lambda topic, message: (topic.replace("image_rect", "image_raw"), message), REPLAY,
     "raw images (/stereo/left/image_raw)", "give rectify:=true"),
    ("no camera runs", None, "odometry.launch", "/stereo/left/image_rect", "start the camera or the bag"),
    ("stamps 2 ms apart", change("right/image_rect", delay), REPLAY, "2.000 ms apart", "approx_sync:=true"),
    ("no tf to the camera", None, LIVE, "tf base_link <- left_camera_optical", "base_from_camera:="),
    ("baseline in mm", scale_baseline(1000), REPLAY, "baseline of 200 m", "Give the calibration lengths in m"),
    ("baseline 0", scale_baseline(0), REPLAY, "P[3] is 0", "calibrate the cameras as a stereo pair"),
    ("wrong sign of the baseline", scale_baseline(-1), REPLAY, "baseline of -0.2 m", "exchange their topics"),
    ("swapped eyes", swap, REPLAY, "P[3] is", "exchange their topics"),
    ("float image", change("left/image_rect", make_float), REPLAY, "32FC1", "publish mono8"),
    ("wrong size", change("right/image_rect", narrow), REPLAY, "/stereo/right/image_rect is ", "set the camera to the size it was calibrated at"),
    ("black images", change("image_rect", darken), REPLAY, "dark, blurred or without texture", "light, exposure, lens cap"),
    ("mistyped launch argument", None, REPLAY + "base_fram:=robot", "base_fram:=", "is base_frame:= meant"),
    ("mistyped parameter", "config", REPLAY + "config:=config.yaml", "frontend.no_such_key: unknown key", "known here"),
    ("no display", None, REPLAY.replace("rviz:=false", "rviz:=true"), "no display", "give rviz:=false"),
    ("wrong bag", without("image_rect", "camera_info"), REPLAY, "neither images nor camera_info", "is it the right bag"),
    ("compressed images only", compress, REPLAY, "holds compressed images only", "image_transport republish"),
    ("second instance", None, "odometry.launch & sleep 4; roslaunch arfm_vo odometry.launch",
     "/pose_node runs already", "namespace:="),
    ("no CAN interface", None, "chassis.launch can:=can9", "CAN interface 'can9': ", "can:="),
    ("no camera", "config", "camera.launch config:=$PWD/camera.yaml", "/dev/no_left_eye (", "stereo_camera_node --list"),
    ("no serial line", None, "pan_tilt.launch port:=/dev/no_head", "serial port '/dev/no_head' (", "port:= names it"),
    ("wrong board", None, PROGRAMS + "render_board_set board --pairs 1 --width 320 > /dev/null; echo started with pid; " + PROGRAMS +
     "calibrate_stereo board --board 9x6 --square 0.10 --output out", "a board of 9x6", "are these its inner corners"),
]


def write_input(folder, edit):
    path = os.path.join(folder, "input.bag")
    if callable(edit):
        with rosbag.Bag(FIXTURE) as source, rosbag.Bag(path, "w") as bag:
            for topic, message, stamp in source.read_messages():
                changed = edit(topic, message)
                if changed:
                    bag.write(*changed, stamp)
        return
    with open(FIXTURE, "rb") as source, open(path, "wb") as bag:
        bag.write(source.read(1000000 if edit == "half" else -1))
    with open(os.path.join(folder, "config.yaml"), "w") as file:
        file.write("frontend: {no_such_key: 1}\n")
    with open(os.path.join(folder, "camera.yaml"), "w") as file:
        file.write("{left_device: /dev/no_left_eye, right_device: /dev/no_right_eye}\n")


def watch(folder, arguments, *wanted):
    """The console's line and the time to it since the nodes started (or since the call, where none does), s."""
    environment = {**os.environ, "PWD": folder, "ROS_MASTER_URI": f"http://localhost:{find_free_port()}"}
    environment.pop("DISPLAY", None)
    mode = "set -m;" if "&" in arguments or ";" in arguments else "exec"
    call = arguments if arguments.startswith(PROGRAMS) else f"roslaunch arfm_vo {arguments}"
    command = f". {BUILD}/devel/setup.bash; {mode} {call}"
    run = subprocess.Popen(["bash", "-c", command], env=environment, cwd=folder, text=True, errors="replace",
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    signal.alarm(60)
    start, found = time.monotonic(), None
    is_started = False
    try:
        for line in run.stdout:
            if "started with pid" in line and "master" not in line and not is_started:
                start, is_started = time.monotonic(), True
            if all(text.lower() in line.lower() for text in wanted):
                found = (re.sub(r"\x1b\[\d*m|\[ *(WARN|INFO|ERROR|FATAL)\] \[[\d., ]*\]: ", "", line).strip(),
                         time.monotonic() - start)
                break
    except TimeoutError:
        pass
    signal.alarm(0)
    for process in find_session(run.pid):  # roslaunch first, which ends its nodes
        os.kill(process, signal.SIGINT)
    run.stdout.read()
    run.wait()
    return found


def find_session(leader):
    """The bash, roslaunch and rosbag processes of the session that was started."""
    listed = subprocess.run(["ps", "-o", "pid=,args=", "--sid", str(leader)], text=True, stdout=subprocess.PIPE).stdout
    rows = [line.split(None, 1) for line in listed.splitlines()]
    return [int(pid) for pid, command in rows if "roslaunch" in command or "rosbag" in command]


def give_up(*_):
    raise TimeoutError


def main():
    if {"--help", "-h"} & set(sys.argv):
        print(__doc__)
        return
    signal.signal(signal.SIGALRM, give_up)
    rows, num_late = [], 0
    for mistake, edit, arguments, thing, remedy in MISTAKES:
        with tempfile.TemporaryDirectory(prefix="arfm_vo_mistake_") as folder:
            write_input(folder, edit)
            found = watch(folder, arguments, thing, remedy)
            text, time_s = found or ("NOTHING", float("inf"))
            num_late += time_s > LIMIT_S
            rows.append(f"| {mistake} | {text.replace(folder, '.').replace('|', '/')} | {time_s:.1f} |")
            print(rows[-1], flush=True)
    with open(os.path.join(ROOT, "docs", "mistakes.md"), "w") as page:
        page.write("# What the console says of mistakes\n\nMade by `scripts/mistakes.py`, which makes each on the fixture and "
                   "checks that one line names the thing and the\nremedy; the time is from the start of the nodes, or from "
                   "the call where none is started.\n\n"
                   "| mistake | console | s |\n|---|---|---|\n" + "\n".join(rows) + "\n")
    sys.exit(num_late > 0)


if __name__ == "__main__":
    main()
