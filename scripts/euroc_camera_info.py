#!/usr/bin/python3
"""Adds the camera_info that a bag of the EuRoC MAV dataset lacks, rectification included.

Usage: euroc_camera_info.py BAG CAM0_SENSOR_YAML CAM1_SENSOR_YAML OUTPUT_BAG

The sensor.yaml are those in mav0/cam0 and mav0/cam1 of the sequence. The output has the stereo pairs alone and can be
replayed with rectify:=true.
"""
import os
import sys

import cv2
import numpy as np
import rosbag
import yaml
from sensor_msgs.msg import CameraInfo


class Camera:
    """The calibration of one camera, from a sensor.yaml."""

    def __init__(self, path):
        try:
            with open(path) as file:
                values = yaml.safe_load(file)
            self.size = [int(value) for value in values["resolution"]]
            self.fx, self.fy, self.cx, self.cy = map(float, values["intrinsics"])
            self.distortion = [float(value) for value in values["distortion_coefficients"]]
            self.body_from_camera = np.array(values["T_BS"]["data"], float).reshape(4, 4)
        except (OSError, yaml.YAMLError, KeyError, TypeError, ValueError) as error:
            sys.exit(f"ERROR: {path}: no sensor.yaml of EuRoC: {type(error).__name__} {error}")
        if values.get("distortion_model") != "radial-tangential" or len(self.distortion) != 4:
            sys.exit(f"ERROR: {path}: distortion_model must be radial-tangential with 4 coefficients")


def rectify(left, right):
    """The rotations of both cameras, and P of both."""
    right_from_left = np.linalg.inv(right.body_from_camera) @ left.body_from_camera
    matrices = [np.array([[camera.fx, 0, camera.cx], [0, camera.fy, camera.cy], [0, 0, 1]]) for camera in (left, right)]
    rotations_and_projections = cv2.stereoRectify(
        matrices[0], np.array(left.distortion), matrices[1], np.array(right.distortion), tuple(left.size),
        right_from_left[:3, :3], right_from_left[:3, 3], flags=cv2.CALIB_ZERO_DISPARITY, alpha=-1)[:4]
    return rotations_and_projections[:2], rotations_and_projections[2:]


def make_infos(left, right):
    if left.size != right.size:
        sys.exit(f"ERROR: the images of both cameras must have one resolution, not {left.size} and {right.size}")
    infos = []
    for camera, rotation, projection in zip((left, right), *rectify(left, right)):
        infos.append(CameraInfo(width=camera.size[0], height=camera.size[1], distortion_model="plumb_bob",
                                D=camera.distortion + [0], K=[camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1],
                                R=list(rotation.ravel()), P=list(projection.ravel())))
    return infos


def add_infos(source, infos, target):
    counts = dict.fromkeys(infos, 0)
    for topic, image, stamp in source.read_messages(topics=[name + "/image_raw" for name in infos]):
        name = topic[:-len("/image_raw")]
        info = infos[name]
        if (image.width, image.height) != (info.width, info.height):
            sys.exit(f"ERROR: {topic}: images of {image.width}x{image.height}, its sensor.yaml has {info.width}x{info.height}")
        info.header = image.header
        target.write(topic, image, stamp)
        target.write(name + "/camera_info", info, stamp)
        counts[name] += 1
    return counts


def main():
    if {"-h", "--help"} & set(sys.argv):
        sys.exit(print(__doc__))
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    bag, left, right, output = sys.argv[1:]
    if os.path.exists(output):
        sys.exit(f"ERROR: {output}: exists already")
    infos = dict(zip(("/cam0", "/cam1"), make_infos(Camera(left), Camera(right))))
    try:
        with rosbag.Bag(bag) as source, rosbag.Bag(output, "w") as target:
            counts = add_infos(source, infos, target)
    except (rosbag.ROSBagException, OSError) as error:
        sys.exit(f"ERROR: {bag}: {error}")
    if not all(counts.values()):
        os.remove(output)
        sys.exit(f"ERROR: {bag}: has no images on " + ", ".join(f"{name}/image_raw" for name in counts if not counts[name]))
    print(f"{output}: {counts['/cam0']} left, {counts['/cam1']} right images; replay it with rectify:=true")


if __name__ == "__main__":
    main()
