#!/usr/bin/python3
"""Adds the camera_info that a bag of the EuRoC MAV dataset lacks, rectification included.

Usage: euroc_camera_info.py BAG CAM0_SENSOR_YAML CAM1_SENSOR_YAML OUTPUT_BAG

The sensor.yaml are those in mav0/cam0 and mav0/cam1 of the sequence. The output has the stereo pairs alone and can be
replayed with rectify:=true.
"""
import os
import sys

import numpy as np
import rosbag
import yaml
from sensor_msgs.msg import CameraInfo


class Eye:
    """The calibration of one camera, from a sensor.yaml."""

    def __init__(self, path):
        try:
            with open(path) as file:
                values = yaml.safe_load(file)
            self.size = [int(value) for value in values["resolution"]]
            self.fx, self.fy, self.cx, self.cy = map(float, values["intrinsics"])
            self.distortion = [float(value) for value in values["distortion_coefficients"]]
            self.body_from_eye = np.array(values["T_BS"]["data"], float).reshape(4, 4)
        except (OSError, yaml.YAMLError, KeyError, TypeError, ValueError) as error:
            sys.exit(f"ERROR: {path}: no sensor.yaml of EuRoC: {type(error).__name__} {error}")
        if values.get("distortion_model") != "radial-tangential" or len(self.distortion) != 4:
            sys.exit(f"ERROR: {path}: distortion_model must be radial-tangential with 4 coefficients")

    def undistort(self, pixels):
        """The rays (x, y, 1) of pixels."""
        k1, k2, p1, p2 = self.distortion
        seen = (pixels - [self.cx, self.cy]) / [self.fx, self.fy]
        x, y = seen.T
        for _ in range(20):
            r2 = x * x + y * y
            x, y = ((seen[:, 0] - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / (1 + k1 * r2 + k2 * r2 * r2),
                    (seen[:, 1] - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / (1 + k1 * r2 + k2 * r2 * r2))
        return np.column_stack([x, y, np.ones_like(x)])


def rotate(vector):
    """The rotation matrix of a rotation vector."""
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def find_rotation_vector(matrix):
    """That of a rotation below 180 degrees."""
    axis = np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]]) / 2
    sine = np.linalg.norm(axis)
    return axis if sine < 1e-12 else axis / sine * np.arctan2(sine, (np.trace(matrix) - 1) / 2)


def rectify(left, right):
    """The rotations of both eyes, each by half of what is between them, and P of both."""
    right_from_left = np.linalg.inv(right.body_from_eye) @ left.body_from_eye
    half = rotate(find_rotation_vector(right_from_left[:3, :3]) / 2)
    way = half.T @ right_from_left[:3, 3]  # from the right eye to the left one, seen half way
    x = -way / np.linalg.norm(way)
    y = np.cross([0, 0, 1], x)
    y /= np.linalg.norm(y)
    level = np.array([x, y, np.cross(x, y)])
    rotations = [level @ half, level @ half.T]
    focal = min(left.fy, right.fy)
    last = np.array(left.size) - 1.0
    corners = np.array([[0, 0], [1, 0], [0, 1], [1, 1]]) * last
    rays = np.vstack([eye.undistort(corners) @ rotation.T for eye, rotation in zip((left, right), rotations)])
    centre = last / 2 - focal * (rays[:, :2] / rays[:, 2:]).mean(axis=0)
    projections = []
    for shift in 0, -focal * np.linalg.norm(way):
        projections.append(np.array([[focal, 0, centre[0], shift], [0, focal, centre[1], 0], [0, 0, 1, 0]]))
    return rotations, projections


def make_infos(left, right):
    if left.size != right.size:
        sys.exit(f"ERROR: the images of both cameras must have one resolution, not {left.size} and {right.size}")
    infos = []
    for eye, rotation, projection in zip((left, right), *rectify(left, right)):
        infos.append(CameraInfo(width=eye.size[0], height=eye.size[1], distortion_model="plumb_bob",
                                D=eye.distortion + [0], K=[eye.fx, 0, eye.cx, 0, eye.fy, eye.cy, 0, 0, 1],
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
    infos = dict(zip(("/cam0", "/cam1"), make_infos(Eye(left), Eye(right))))
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
