#!/usr/bin/python3
"""What a pair costs, beside other programs in the same minutes; writes docs/benchmark.md.

Usage: scripts/measure.sh cost [NAME=PROGRAM ...] [FOLDER ...]      FOLDER: default those of ../shared/data and rendered drives
Each PROGRAM (an older kitti_odometry, or a loop around another odometry, built elsewhere) runs in turn with ours as
`PROGRAM FOLDER --output DIR` and prints ms_per_pair_median, ms_per_pair_p95 and cpu_ms_per_pair (all threads) like it, without
the decoding of the images. Instructions, decoding too: the first 12 pairs by callgrind (valgrind).
"""
import csv
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from readme_section import replace_section  # noqa: E402

NUM_RUNS, NUM_COUNTED = 5, 12
PROGRAMS = pathlib.Path(os.environ.get("BUILD_DIR", "_b")) / "devel/lib/arfm_vo"
SHARED = pathlib.Path(os.environ.get("ARFM_VO_SHARED", "../shared")) / "data"
GIVEN = ("kitti/odometry_06_000-050", "kitti/raw_2011_09_26_drive_0001", "kitti/odometry_05_100-159", "kitti/odometry_04_000-050",
         "handheld/tumvi_room1")
RENDERED = {"rendered, 0.1 m/s, 10 pairs a second": "--pairs 60 --path straight --step 0.01",
            "rendered, 0.1 m/s, 5 pairs a second": "--pairs 60 --path straight --step 0.02",
            "rendered, at rest": "--pairs 40 --path rest",
            "rendered, 1624x1234": "--pairs 24 --path straight --step 0.1 --width 1624 --height 1234"}


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"cost: {' '.join(map(str, command))}: exit status {done.returncode}: {done.stderr.strip()}")
    return done


def measure(program, folder, output):
    """Median, p95 and CPU, ms, of one run."""
    said = dict(line.split(": ", 1) for line in run(program, folder, "--output", output).stdout.splitlines() if ": " in line)
    return [float(said[figure]) for figure in ("ms_per_pair_median", "ms_per_pair_p95", "cpu_ms_per_pair")]


def row(name, programs, folder, work):
    rounds = [[measure(program, folder, work / peer) for peer, program in programs.items()] for _ in range(NUM_RUNS)]
    medians = [[statistics.median(figures) for figures in zip(*runs)] for runs in zip(*rounds)]
    with open(work / "arfm_vo" / "timing.csv") as stream:
        needed = [bool(pair["features"]) for pair in csv.DictReader(stream)]
    counted = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", programs["arfm_vo"], folder, "--pairs",
                  str(NUM_COUNTED), "--output", work / "counted").stderr
    instructions = int(re.search(r"Collected : (\d+)", counted)[1]) / NUM_COUNTED / 1e6
    cells = [name, f"{sum(needed)} of {len(needed)}", f"{instructions:.0f}", *(", ".join(f"{figure:.1f}" for figure in one) for one in medians),
             *(f"{medians[0][2] / other[2]:.2f}" for other in medians[1:])]
    return "| " + " | ".join(cells) + " |"


def main(arguments):
    if not shutil.which("valgrind"):
        sys.exit("cost: valgrind is missing (apt-get install valgrind)")
    peers = dict(argument.split("=", 1) for argument in arguments if "=" in argument)
    folders = {pathlib.Path(folder).name: folder for folder in arguments if "=" not in folder}
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        if not folders:
            folders = {pathlib.Path(name).name: SHARED / name for name in GIVEN if (SHARED / name).is_dir()}
            for i, (name, options) in enumerate(RENDERED.items()):
                folders[name] = work / f"rendered_{i}"
                run(PROGRAMS / "render_sequence", folders[name], "--threads", str(os.cpu_count()), *options.split())
        head = ["recording", "with features", "instructions", "arfm_vo", *peers, *(f"CPU over {peer}'s" for peer in peers)]
        lines = [f"Median, p95 and CPU, ms a pair: medians of {NUM_RUNS} runs in turn, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}. "
                 "Instructions: millions a pair, decoding included.", "", "| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
        lines += [row(name, {"arfm_vo": PROGRAMS / "kitti_odometry", **peers}, folder, work) for name, folder in folders.items()]
    print("\n".join(lines))
    replace_section("docs/benchmark.md", "cost", "\n".join(lines))


if __name__ == "__main__":
    print(__doc__) if sys.argv[1:2] in (["-h"], ["--help"]) else main(sys.argv[1:])
