#!/usr/bin/python3
"""Checks that a bag holds what the odometry needs, and prints its path.

Usage: check_bag.py BAG LEFT_IMAGE RIGHT_IMAGE LEFT_INFO RIGHT_INFO      topics; exit status 1 where one is missing

replay.launch calls it before it starts anything, so that roslaunch ends with its message.
"""
import os
import sys

import rosbag

ARGUMENTS = ("left_image:=", "right_image:=", "left_info:=", "right_info:=")


def find_fault(path, wanted):
    """What keeps the bag from being replayed, in words; empty where nothing does."""
    if not os.path.isfile(path):
        return "no such file (a path is that of the folder you call roslaunch in)"
    try:
        with rosbag.Bag(path) as bag:
            topics = {name: kind.msg_type for name, kind in bag.get_type_and_topic_info()[1].items()}
    except (rosbag.ROSBagException, OSError) as error:
        return f"cannot be read: {error} (rosbag reindex may help)"
    missing = [(argument, topic) for argument, topic in zip(ARGUMENTS, wanted) if topic not in topics]
    if not missing:
        return ""
    raw = wanted[0].replace("image_rect", "image_raw")
    if raw != wanted[0] and raw in topics:
        return f"holds raw images ({raw}): give rectify:=true"
    if wanted[0] + "/compressed" in topics:
        return f"holds compressed images only ({wanted[0]}/compressed): decompress it with image_transport republish"
    cameras = sorted(name for name, kind in topics.items()
                     if kind in ("sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/CameraInfo"))
    if not cameras:
        return "holds neither images nor camera_info: is it the right bag? (rosbag info lists its topics)"
    return (f"has no topic {', '.join(topic for _, topic in missing)}; its cameras are {', '.join(cameras)}: "
            f"give stereo:=, or {' '.join(argument for argument, _ in missing)}")


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    fault = find_fault(sys.argv[1], sys.argv[2:])
    if fault:
        sys.exit(f"ERROR: bag {os.path.abspath(sys.argv[1])}: {fault}")
    print(os.path.abspath(sys.argv[1]))


if __name__ == "__main__":
    main()
