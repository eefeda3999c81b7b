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
SURF = "SurfWhole/oriented/{}/{}/{}"  # points, threads, per cent of the image's side
EXACT = "ExactMatching/{}"
FLANN = "OpenCvMatching<cv::FlannBasedMatcher>/{}"
BRUTE = "OpenCvMatching<cv::BFMatcher>/{}"


def read_medians(path):
    with open(path) as stream:
        report = json.load(stream)
    return {entry["run_name"].replace(SUFFIX, ""): entry for entry in report["benchmarks"]
            if entry.get("aggregate_name") == "median"}


def row(label, entry, against=None, by="cpu_time"):
    ratio = f"{entry[by] / against[by]:.1f}" if against else ""
    recall = f"{100 * entry['recall']:.0f} %" if "recall" in entry else ""
    return (f"| {label} | {entry['points']:.0f} | {entry['real_time']:.2f} | {entry['cpu_time']:.2f} " f"| {ratio} | {recall} |")


def list_features(all_of):
    surf = all_of[SURF.format(1000, 1, 100)]
    rows = [row("SURF, detector", all_of["SurfDetector"]), row("SURF, orientation and descriptor", all_of["SurfDescriptorOnly"]),
            row("**SURF, whole**, 1 thread", surf, surf), row("SURF, whole, 2 threads", all_of[SURF.format(1000, 2, 100)]),
            row("SURF, whole, at every second pixel (as in the odometry, and as dlib), 1 thread",
                all_of["SurfWhole/every_second_pixel/1000/1/100"], surf),
            row("SURF upright, whole, 1 thread", all_of["SurfWhole/upright/1000/1/100"], surf),
            row("`dlib::get_surf_points`, 1 thread", all_of["DlibSurf"], surf),
            row("`cv::SIFT`, 1 thread", all_of["OpenCv<cv::SIFT>/1"], surf),
            row("`cv::SIFT`, 2 threads", all_of["OpenCv<cv::SIFT>/2"]),
            row("`cv::ORB`, 1 thread", all_of["OpenCv<cv::ORB>/1"], surf),
            row("`cv::ORB`, 2 threads", all_of["OpenCv<cv::ORB>/2"])]
    for percent in (50, 71, 141, 200):
        rows.append(row(f"SURF, {(percent / 100) ** 2:.2g} times the pixels", all_of[SURF.format(1000, 1, percent)], surf))
    for points in (500, 2000, 4000):
        rows.append(row(f"SURF, {points} points wanted", all_of[SURF.format(points, 1, 100)], surf))
    return rows


def list_matching(all_of):
    rows = []
    for points in (1000, 2000, 4000):
        exact = all_of[EXACT.format(points)]
        rows += [row("**exact both ways**, same Laplacian sign", exact, exact),
                 row("`cv::FlannBasedMatcher` both ways, with index", all_of[FLANN.format(points)], exact),
                 row("`cv::BFMatcher` both ways", all_of[BRUTE.format(points)], exact)]
    return rows


def list_pair(lines_path, timing_path):
    with open(lines_path) as stream:
        lines = dict(line.strip().split(": ", 1) for line in stream if ": " in line)
    with open(timing_path) as stream:
        timing = list(csv.DictReader(stream))
    others = ("frame", "stamp_s", "total_ms", "memory_mb", "state", "reason", "log_odds", "matches", "inliers")
    stages = [name for name in timing[0] if name not in others]
    medians = ", ".join(f"{stage} {statistics.median(float(r[stage]) for r in timing if r[stage]):.1f}" for stage in stages)
    return (f"median {float(lines['ms_per_pair_median']):.1f} ms, p95 "
            f"{float(lines['ms_per_pair_p95']):.1f} ms, CPU of all threads "
            f"{float(lines['cpu_ms_per_pair']):.1f} ms (medians of the stages, ms: {medians})")


def main():
    features, lines, timing, sequence = sys.argv[1:5]
    all_of = read_medians(features)
    dlib = all_of["DlibSurf"]["cpu_time"] / all_of[SURF.format(1000, 1, 100)]["cpu_time"]
    flann = all_of[FLANN.format(1000)]["cpu_time"]
    load = os.getloadavg()[0]
    text = "\n".join(
        [f"First pair of {sequence} at 1226x370, {os.cpu_count()} cores, load {load:.1f}; medians. "
         "`times` is CPU time over that of the bold line.", "",
         "| | points | ms | CPU ms | times | finds the true nearest |", "|---|---|---|---|---|---|"] +
        list_features(all_of) + list_matching(all_of) + ["", f"SURF takes 1/{dlib:.1f} of dlib's time; exact matching 1/"
         f"{flann / all_of[EXACT.format(1000)]['cpu_time']:.0f} of FLANN's (among points of the same sign of the Laplacian).", "",
         f"Whole pair on {sequence}, in process: {list_pair(lines, timing)}."])
    print(text)


if __name__ == "__main__":
    main()
