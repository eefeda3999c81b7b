#!/usr/bin/python3
"""Lays a trajectory beside the ground truth of the bag that it came from.

Usage: pair_with_truth.py TRAJECTORY.tum BAG OUTPUT_DIR [TRUTH_TOPIC]

Writes OUTPUT_DIR/estimate.txt and OUTPUT_DIR/truth.txt (KITTI format, one line a common stamp) for
evaluate_trajectory. Exits with 3 where the bag holds no truth.
"""
import os
import sys

import numpy as np
import rosbag

MAX_STAMP_DIFFERENCE_S = 1e-3


def pose_matrix(position, quaternion):
    """[3 x 4] of a position and a quaternion (x, y, z, w)."""
    x, y, z, w = np.asarray(quaternion, float) / np.linalg.norm(quaternion)
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return np.column_stack([rotation, position])


def read_truth(bag_path, topic):
    truth = []
    with rosbag.Bag(bag_path) as bag:
        for _, message, _ in bag.read_messages(topics=[topic]):
            p, q = message.pose.position, message.pose.orientation
            truth.append((message.header.stamp.to_sec(),
                          pose_matrix([p.x, p.y, p.z], [q.x, q.y, q.z, q.w])))
    return truth


def main():
    if {"--help", "-h"} & set(sys.argv):
        print(__doc__)
        return
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    tum_path, bag_path, output = sys.argv[1:4]
    truth = read_truth(bag_path, sys.argv[4] if len(sys.argv) == 5 else '/stereo/ground_truth')
    if not truth:
        print('pair_with_truth: %s holds no ground truth' % bag_path)
        sys.exit(3)
    stamps = np.array([stamp for stamp, _ in truth])
    os.makedirs(output, exist_ok=True)
    lines = {'estimate': [], 'truth': []}
    for row in np.loadtxt(tum_path, ndmin=2):
        nearest = int(np.argmin(np.abs(stamps - row[0])))
        if abs(stamps[nearest] - row[0]) > MAX_STAMP_DIFFERENCE_S:
            continue
        lines['estimate'].append(pose_matrix(row[1:4], row[4:8]))
        lines['truth'].append(truth[nearest][1])
    for name, matrices in lines.items():
        np.savetxt(os.path.join(output, name + '.txt'), [m.ravel() for m in matrices], fmt='%.9e')
    print('common_frames: %d of %d' % (len(lines['truth']), len(truth)))


if __name__ == '__main__':
    main()
