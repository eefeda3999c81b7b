#!/usr/bin/python3
"""Measures SURF and matching against what Debian offers; writes docs/benchmark.md.

Usage: scripts/measure.sh benchmark [LEFT.png RIGHT.png]      default: the first pair of KITTI 06 in ../shared/data
"""
import json
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from readme_section import replace_section  # noqa: E402

SUFFIX = "/process_time/real_time"
SURF = "SurfWhole/oriented/1000/1/100"  # points, threads, per cent of the image's side
DLIB, EXACT, FLANN = "DlibSurf", "ExactMatching/1000", "OpenCvMatching<cv::FlannBasedMatcher>/1000"
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


def main(arguments):
    folder = pathlib.Path(os.environ.get("ARFM_VO_SHARED", "../shared")) / "data/kitti/odometry_06_000-050"
    left, right = arguments or [str(folder / image / "000000.png") for image in ("image_0", "image_1")]
    subprocess.run(["scripts/build.sh", "features_benchmark"], stdout=subprocess.DEVNULL, check=True)
    program = pathlib.Path(os.environ.get("BUILD_DIR", "_b")) / "devel/lib/arfm_vo/features_benchmark"
    measured = subprocess.run([program, "--benchmark_repetitions=5", "--benchmark_min_time=0.2", "--benchmark_format=json",
                               "--benchmark_enable_random_interleaving=true"], stdout=subprocess.PIPE, check=True,
                              env={**os.environ, "ARFM_VO_PAIR": left + ":" + right}).stdout
    medians = {entry["run_name"].replace(SUFFIX, ""): entry for entry in json.loads(measured)["benchmarks"]
               if entry.get("aggregate_name") == "median"}
    dlib, exact = (medians[slow]["cpu_time"] / medians[fast]["cpu_time"] for slow, fast in ((DLIB, SURF), (FLANN, EXACT)))
    lines = [f"{left} at load {os.getloadavg()[0]:.1f} of {os.cpu_count()} cores; medians. `times` is CPU time over that of the bold line.",
             "", "| | points | ms | CPU ms | times | finds the true nearest |", "|---|---|---|---|---|---|",
             *(row(medians, *one) for one in ROWS), "",
             f"SURF takes 1/{dlib:.1f} of dlib's time; exact matching 1/{exact:.0f} of FLANN's (among points of the same sign of the "
             "Laplacian)."]
    print("\n".join(lines))
    replace_section("docs/benchmark.md", "benchmark", "\n".join(lines))


if __name__ == "__main__":
    print(__doc__) if sys.argv[1:2] in (["-h"], ["--help"]) else main(sys.argv[1:])
