#!/usr/bin/python3
"""The trajectory files of a run, read as evo reads them (its file_interface.py and trajectory.py).

Usage: evo_formats_test.py PROGRAM_DIR BAG
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy as np


def read_matrix(path, num_columns):
    """csv_read_matrix: one space between entries, none at the end of a row; lines with # are comments."""
    rows = list(csv.reader((line for line in path.read_text().splitlines() if not line.startswith("#")), delimiter=" "))
    assert rows and all(len(row) == num_columns for row in rows), f"{path}: not {num_columns} entries in each row"
    return np.array(rows).astype(float)


with tempfile.TemporaryDirectory(prefix="arfm_vo_evo_") as output:
    subprocess.run([pathlib.Path(sys.argv[1]) / "bag_odometry", sys.argv[2], "--output", output], check=True, timeout=300)
    kitti, live = (read_matrix(pathlib.Path(output) / name, 12).reshape(-1, 3, 4) for name in ("poses.txt", "poses_online.txt"))
    tum = read_matrix(pathlib.Path(output) / "trajectory.tum", 8)
assert len(kitti) == len(live) == len(tum) == 36
for rotation in np.concatenate((kitti, live))[:, :, :3]:
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-6)
    np.testing.assert_allclose(np.linalg.det(rotation), 1, atol=1e-6)
assert np.all(np.diff(tum[:, 0]) > 0), "stamps that do not ascend"
np.testing.assert_allclose(np.linalg.norm(tum[:, 4:], axis=1), 1, atol=1e-6)
np.testing.assert_allclose(tum[:, 1:4], kitti[:, :, 3], atol=1e-6)
x, y, z, w = tum[:, 4:].T  # evo reads TUM's quaternions with w last
np.testing.assert_allclose(1 - 2 * (x * x + y * y), kitti[:, 2, 2], atol=1e-6)
np.testing.assert_allclose(2 * (x * z + w * y), kitti[:, 0, 2], atol=1e-6)
