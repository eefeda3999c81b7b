#!/usr/bin/python3
"""The code for a CPU with AVX2 and that for every CPU, glibc's and OpenCV's too, give the same trajectory to the last byte.

Usage: cpu_paths_test.py PROGRAM_DIR BASELINE_LIBRARY
"""
import os
import pathlib
import subprocess
import sys
import tempfile

PAIRS = 30
SKIPPED = 77
BASELINE = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4",
    "OPENCV_CPU_DISABLE": "SSE4.1,SSE4.2,AVX,FP16,AVX2,FMA3,AVX512F,AVX512-SKX",
}


def drive(programs, sequence, output, environment):
    run = subprocess.run([programs / "kitti_odometry", sequence, "--output", output], check=True, stdout=subprocess.DEVNULL,
                         stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})
    files = {name: (output / name).read_bytes() for name in ("poses_online.txt", "poses.txt")}
    return files, "baseline code" in run.stderr


def main():
    if " avx2 " not in pathlib.Path("/proc/cpuinfo").read_text():
        print("SKIPPED: this CPU has no AVX2")
        return SKIPPED
    programs, library = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        subprocess.run([programs / "render_sequence", work / "curve", "--path", "curve", "--pairs", str(PAIRS)], check=True,
                       stdout=subprocess.DEVNULL)
        fast, is_baseline = drive(programs, work / "curve", work / "fast", {})
        baseline, is_other_baseline = drive(programs, work / "curve", work / "baseline", {"LD_PRELOAD": library, **BASELINE})
    if is_baseline or not is_other_baseline:
        print("the baseline's code ran in the first drive, or not in the second")
        return 1
    for name, text in fast.items():
        if text.count(b"\n") != PAIRS:
            print(f"{name}: {text.count(bytes([10]))} poses instead of {PAIRS}")
            return 1
        if text != baseline[name]:
            print(f"{name}: not the same bytes")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
