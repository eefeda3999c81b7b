#!/usr/bin/python3
"""The trajectory files of a run, read as evo reads them (its file_interface.py and trajectory.py).

Usage: evo_formats_test.py PROGRAM_DIR BAG
"""
import csv
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PROGRAM_DIR, BAG = sys.argv[1:3]


def read_matrix(path, num_columns):
    """csv_read_matrix: one space between entries, none at the end of a row; lines with # are comments."""
    with open(path) as file:
        rows = list(csv.reader((line for line in file if not line.startswith("#")), delimiter=" "))
    assert rows and all(len(row) == num_columns for row in rows), f"{path}: not {num_columns} entries in each row"
    return np.array(rows).astype(float)


def is_so3(rotation):
    return (np.allclose(np.linalg.det(rotation), 1, atol=1e-6) and np.allclose(rotation.T @ rotation, np.eye(3), atol=1e-6))


class EvoFormatsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="arfm_vo_evo_")
        cls.folder = cls.directory.name
        subprocess.run([os.path.join(PROGRAM_DIR, "bag_odometry"), BAG, "--output", cls.folder], check=True,
                       stdout=subprocess.DEVNULL, timeout=300)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def test_kitti_files_hold_rigid_poses_of_twelve_entries(self):
        for name in "poses.txt", "poses_online.txt":
            poses = read_matrix(os.path.join(self.folder, name), 12).reshape(-1, 3, 4)
            self.assertEqual(len(poses), 36, name)
            self.assertTrue(all(is_so3(pose[:, :3]) for pose in poses), name)

    def test_the_tum_file_holds_ascending_stamps_and_unit_quaternions(self):
        table = read_matrix(os.path.join(self.folder, "trajectory.tum"), 8)
        self.assertTrue(np.all(np.diff(table[:, 0]) > 0))
        np.testing.assert_allclose(np.linalg.norm(table[:, 4:], axis=1), 1, atol=1e-6)

    def test_both_formats_hold_the_same_trajectory(self):
        kitti = read_matrix(os.path.join(self.folder, "poses.txt"), 12).reshape(-1, 3, 4)
        tum = read_matrix(os.path.join(self.folder, "trajectory.tum"), 8)
        np.testing.assert_allclose(tum[:, 1:4], kitti[:, :, 3], atol=1e-6)
        x, y, z, w = tum[:, 4:].T  # evo reads TUM's quaternions with w last
        np.testing.assert_allclose(1 - 2 * (x * x + y * y), kitti[:, 2, 2], atol=1e-6)
        np.testing.assert_allclose(2 * (x * z + w * y), kitti[:, 0, 2], atol=1e-6)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
