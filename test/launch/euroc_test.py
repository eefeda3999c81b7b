#!/usr/bin/python3
"""A bag as the EuRoC MAV dataset has them, with the README's recipe: euroc_camera_info.py, then replay.launch.

Usage: euroc_test.py BUILD_DIR SOURCE_DIR
"""
import os
import sys
import unittest

import numpy as np
import rosbag
import yaml
from launch_case import FIXTURE, SOURCE_DIR, LaunchCase
from sensor_msgs.msg import Imu

sys.path.insert(0, os.path.join(SOURCE_DIR, "scripts"))
import euroc_camera_info  # noqa: E402  (beside the other scripts)

# T_BS of the dataset's own V1 sequences.
BODY_FROM_CAM0 = [[0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975],
                  [0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768],
                  [-0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949], [0, 0, 0, 1]]
BODY_FROM_CAM1 = [[0.0125552670891, -0.999755099723, 0.0182237714554, -0.0198435579556],
                  [0.999598781151, 0.0130119051815, 0.0251588363115, 0.0453689425024],
                  [-0.0253898008918, 0.0179005838253, 0.999517347078, 0.00786212447038], [0, 0, 0, 1]]


class EurocTest(LaunchCase):
    def write_sensor(self, name, body_from_camera, intrinsics, distortion, resolution):
        with open(os.path.join(self.folder, name), "w") as file:
            yaml.safe_dump({"sensor_type": "camera", "camera_model": "pinhole", "rate_hz": 20, "resolution": resolution,
                            "T_BS": {"rows": 4, "cols": 4, "data": np.ravel(body_from_camera).tolist()},
                            "intrinsics": intrinsics, "distortion_model": "radial-tangential",
                            "distortion_coefficients": distortion}, file)
        return os.path.join(self.folder, name)

    def write_fixture(self):
        """The fixture as that dataset would have it; its cameras as they are, on the dataset's body."""
        right = np.array(BODY_FROM_CAM0) @ [[1, 0, 0, 0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        intrinsics = [393.75, 393.75, 239.5, 179.5]
        names = {"/stereo/left/image_rect": "/cam0/image_raw", "/stereo/right/image_rect": "/cam1/image_raw"}
        with rosbag.Bag(FIXTURE) as source, rosbag.Bag(os.path.join(self.folder, "euroc.bag"), "w") as bag:
            for topic, message, stamp in source.read_messages(topics=list(names)):
                message.header.frame_id = names[topic].split("/")[1]
                bag.write(names[topic], message, stamp)
                bag.write("/imu0", Imu(header=message.header), stamp)
        return [self.write_sensor("cam0.yaml", BODY_FROM_CAM0, intrinsics, [0.0] * 4, [480, 360]),
                self.write_sensor("cam1.yaml", right, intrinsics, [0.0] * 4, [480, 360])]

    def add_infos(self, *files):
        return self.run_command(os.path.join(SOURCE_DIR, "scripts", "euroc_camera_info.py"), "euroc.bag", *files, "stereo.bag")

    def test_the_rectification_is_that_which_is_published_for_the_dataset(self):
        resolution = [752, 480]
        left = self.write_sensor("cam0.yaml", BODY_FROM_CAM0, [458.654, 457.296, 367.215, 248.375],
                                 [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05], resolution)
        right = self.write_sensor("cam1.yaml", BODY_FROM_CAM1, [457.587, 456.134, 379.999, 255.238],
                                  [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05], resolution)
        infos = euroc_camera_info.make_infos(euroc_camera_info.Camera(left), euroc_camera_info.Camera(right))
        # LEFT.R, RIGHT.R and bf / fx of ORB-SLAM2's EuRoC.yaml, by OpenCV.
        np.testing.assert_allclose(infos[0].R[:3], [0.999966347530033, -0.001422739138722922, 0.008079580483432283], atol=1e-9)
        np.testing.assert_allclose(infos[1].R[:3], [0.9999633526194376, -0.003625811871560086, 0.007755443660172947], atol=1e-9)
        self.assertAlmostEqual(-infos[1].P[3] / infos[1].P[0], 47.90639384423901 / 435.2046959714599, places=9)

    def test_a_bag_of_the_dataset_is_replayed(self):
        code, said = self.add_infos(*self.write_fixture())
        self.assertEqual(code, 0, said)
        self.assertIn("36 left, 36 right images", said)
        code, console = self.launch(
            "replay.launch", "rviz:=false", "end_delay_s:=3", "bag:=stereo.bag", "rectify:=true", "rate:=0.5",
            "left_image:=/cam0/image_raw", "right_image:=/cam1/image_raw", "left_info:=/cam0/camera_info",
            "right_info:=/cam1/camera_info")
        self.assertEqual(code, 0, console)
        self.assertIn("36 pairs: 36 with a pose", console)

    def test_what_is_wrong_is_told(self):
        left, right = self.write_fixture()
        self.assertIn("none.yaml: no sensor.yaml of EuRoC", self.add_infos(left, "none.yaml")[1])
        wide = self.write_sensor("wide.yaml", BODY_FROM_CAM1, [400.0] * 4, [0.0] * 4, [752, 480])
        self.assertIn("must have one resolution", self.add_infos(left, wide)[1])
        os.rename(os.path.join(self.folder, "euroc.bag"), os.path.join(self.folder, "other.bag"))
        os.symlink(FIXTURE, os.path.join(self.folder, "euroc.bag"))
        code, said = self.add_infos(left, right)
        self.assertNotEqual(code, 0)
        self.assertIn("has no images on /cam0/image_raw, /cam1/image_raw", said)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "stereo.bag")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
