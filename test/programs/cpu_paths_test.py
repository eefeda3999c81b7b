#!/usr/bin/python3
"""The code for a CPU with AVX2 and that for every CPU give the same trajectory but for rounding.

Usage: cpu_paths_test.py PROGRAM_DIR BASELINE_LIBRARY
"""
import math
import os
import pathlib
import subprocess
import sys
import tempfile

MAX_SHARE_OF_WAY = 1e-4
PAIRS = 30
SKIPPED = 77


def positions(path):
    rows = [[float(word) for word in line.split()] for line in path.read_text().splitlines()]
    return [(row[3], row[7], row[11]) for row in rows]


def drive(programs, sequence, output, **environment):
    subprocess.run([programs / "kitti_odometry", sequence, "--output", output], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, **environment})
    return [positions(output / name) for name in ("poses_online.txt", "poses.txt")]


def main():
    if " avx2 " not in pathlib.Path("/proc/cpuinfo").read_text():
        print("SKIPPED: this CPU has no AVX2")
        return SKIPPED
    programs, library = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        subprocess.run([programs / "render_sequence", work / "curve", "--path", "curve", "--pairs", str(PAIRS)], check=True,
                       stdout=subprocess.DEVNULL)
        fast = drive(programs, work / "curve", work / "fast")
        baseline = drive(programs, work / "curve", work / "baseline", LD_PRELOAD=library)
    for name, mine, other in zip(("live", "after the drive"), fast, baseline):
        way = sum(math.dist(*step) for step in zip(mine, mine[1:]))
        share = max(math.dist(*pair) for pair in zip(mine, other)) / way
        print(f"{name}: {100 * share:.5f} % of {way:.2f} m, allowed {100 * MAX_SHARE_OF_WAY} %")
        if len(mine) != PAIRS or len(other) != PAIRS or way < 1 or not share <= MAX_SHARE_OF_WAY:
            return 1
    if fast == baseline:
        print("no difference at all: was the baseline's code run?")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
