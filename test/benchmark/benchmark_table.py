#!/usr/bin/python3
"""Prints the table of scripts/measure.sh benchmark.

Usage: benchmark_table.py FEATURES.json LINES TIMING.csv SEQUENCE
"""
import csv
import json
import os
import statistics
import sys

SUFFIX = "/process_time/real_time"
SURF = "SurfWhole/oriented/1000/1/100"  # points, threads, per cent of the image's side
DLIB, EXACT, FLANN = "DlibSurf", "ExactMatching/1000", "OpenCvMatching<cv::FlannBasedMatcher>/1000"
OTHERS = ("frame", "stamp_s", "total_ms", "memory_mb", "state", "reason", "log_odds", "matches", "inliers")  # than stages
# Label, benchmark, and that whose CPU time its own is compared with.
ROWS = [
    ("SURF, detector", "SurfDetector", None), ("SURF, orientation and descriptor", "SurfDescriptorOnly", None),
    ("**SURF, whole**, 1 thread", SURF, SURF), ("SURF, whole, 2 threads", "SurfWhole/oriented/1000/2/100", None),
    ("SURF, whole, at every second pixel (as in the odometry, and as dlib), 1 thread", "SurfWhole/every_second_pixel/1000/1/100", SURF),
    ("SURF upright, whole, 1 thread", "SurfWhole/upright/1000/1/100", SURF), ("`dlib::get_surf_points`, 1 thread", DLIB, SURF),
    ("`cv::SIFT`, 1 thread", "OpenCv<cv::SIFT>/1", SURF), ("`cv::SIFT`, 2 threads", "OpenCv<cv::SIFT>/2", None),
    ("`cv::ORB`, 1 thread", "OpenCv<cv::ORB>/1", SURF), ("`cv::ORB`, 2 threads", "OpenCv<cv::ORB>/2", None)]
ROWS += [(f"SURF, {(percent / 100) ** 2:.2g} times the pixels", f"SurfWhole/oriented/1000/1/{percent}", SURF) for percent in (50, 71, 141, 200)]
ROWS += [(f"SURF, {points} points wanted", f"SurfWhole/oriented/{points}/1/100", SURF) for points in (500, 2000, 4000)]
ROWS += [(label, f"{benchmark}/{points}", f"ExactMatching/{points}") for points in (1000, 2000, 4000) for label, benchmark in (
    ("**exact both ways**, same Laplacian sign", "ExactMatching"),
    ("`cv::FlannBasedMatcher` both ways, with index", "OpenCvMatching<cv::FlannBasedMatcher>"),
    ("`cv::BFMatcher` both ways", "OpenCvMatching<cv::BFMatcher>"))]


def row(medians, label, benchmark, against):
    entry = medians[benchmark]
    ratio = f"{entry['cpu_time'] / medians[against]['cpu_time']:.1f}" if against else ""
    recall = f"{100 * entry['recall']:.0f} %" if "recall" in entry else ""
    return f"| {label} | {entry['points']:.0f} | {entry['real_time']:.2f} | {entry['cpu_time']:.2f} | {ratio} | {recall} |"


def main():
    features, lines, timing, sequence = sys.argv[1:5]
    with open(features) as stream:
        medians = {entry["run_name"].replace(SUFFIX, ""): entry for entry in json.load(stream)["benchmarks"]
                   if entry.get("aggregate_name") == "median"}
    with open(lines) as stream:
        pair = {key: float(value) for key, value in (line.split(": ", 1) for line in stream if "_ms" in line or "ms_" in line)}
    with open(timing) as stream:
        pairs = list(csv.DictReader(stream))
    stages = ", ".join(f"{stage} {statistics.median(float(one[stage]) for one in pairs if one[stage]):.1f}"
                       for stage in pairs[0] if stage not in OTHERS)
    dlib, exact = (medians[slow]["cpu_time"] / medians[fast]["cpu_time"] for slow, fast in ((DLIB, SURF), (FLANN, EXACT)))
    print(f"First pair of {sequence} at 1226x370, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; medians. "
          "`times` is CPU time over that of the bold line.", "",
          "| | points | ms | CPU ms | times | finds the true nearest |", "|---|---|---|---|---|---|",
          *(row(medians, *one) for one in ROWS), "",
          f"SURF takes 1/{dlib:.1f} of dlib's time; exact matching 1/{exact:.0f} of FLANN's (among points of the same sign of the "
          "Laplacian).", "",
          f"Whole pair on {sequence}, in process: median {pair['ms_per_pair_median']:.1f} ms, p95 {pair['ms_per_pair_p95']:.1f} ms, "
          f"CPU of all threads {pair['cpu_ms_per_pair']:.1f} ms (medians of the stages, ms: {stages}).", sep="\n")


if __name__ == "__main__":
    main()
