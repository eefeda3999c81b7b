#!/usr/bin/python3
"""Breaks the code in many ways, one at a time, and tells which of them the tests notice.

1. Protections of the driving (protections.py): each is removed in turn.
2. With --sample N: N of the changes that fixed rules (rules.py) make to src/driving: conditions negated or
   dropped, signs and limits changed, lines removed.
With FOLDER, such as src/pose: the second only, of the sources there, and the table as Markdown at the end. Without any
argument: with a sample of 200, and the tables of docs/mutation.md are written (hours).

All changes are compiled in at once, each behind a switch that the environment sets (ARFM_VO_MUTANT), so that there is
one build, of each source alone. Run it in a checkout without changes: the sources are changed in place and put back at the
end. Builds into BUILD_DIR (default _b_mutants). Exit status 0 where all protections are noticed.
"""
import argparse
import os
import pathlib
import random
import re
import subprocess
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from protections import PROTECTIONS  # noqa: E402
from readme_section import replace_section  # noqa: E402
from rules import find_changes  # noqa: E402
from switch import Source  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("BUILD_DIR", ROOT / "_b_mutants"))
PROGRAMS = BUILD / "devel/lib/arfm_vo"
CTEST = ["ctest", "--output-on-failure", "--test-dir", str(BUILD), "-R"]

# What a suite takes: targets to build, and the command.
SUITES = {"driving": (["test_driving"], [str(PROGRAMS / "test_driving")]),
    "hardware": (["test_hardware"], [str(PROGRAMS / "test_hardware"), "--gtest_filter=Chassis*:ToChassis*:BusLock*"]),
    "simulation": (["test_simulation"],
                   [str(PROGRAMS / "test_simulation"), "--gtest_filter=FaultTable*:WrongPose*:SlippedBelt*:Fence*:SimulatedChassis*"]),
    "ros": (["test_ros"], [str(PROGRAMS / "test_ros"), "--gtest_filter=-*HeadSweep*:BagSequence*"])}
for suite in ("pose", "tracking", "odometry", "simulated_run"):
    SUITES[suite] = (["test_" + suite], [str(PROGRAMS / ("test_" + suite))])
for suite, targets in (("chassis_node", ["chassis_node", "test_chassis_node"]),
                       ("clock_stall", ["chassis_node", "test_chassis_node"]),
                       ("pan_tilt", ["pan_tilt_node", "test_pan_tilt"]),
                       ("stereo_camera", ["stereo_camera_node", "test_stereo_camera"]),
                       ("odometry_chain_nodes", ["all", "test_odometry_chain"]), ("kitti_player", ["all", "test_kitti_player"]),
                       ("live_poses", ["all", "test_live_poses"]), ("drive_panel", ["all", "test_drive_panel"]),
                       ("ba_node", ["all"])):
    SUITES[suite] = (targets, CTEST + ["^_ctest_arfm_vo_rostest_test_nodes_%s.test$" % suite])
SUITES["simulated_graph"] = (["chassis_node", "simulator_node", "arfm_vo_nodelets", "truth_path_node", "pan_tilt_node"],
                             CTEST + ["^_ctest_arfm_vo_rostest_test_nodes_simulation.test$"])
# Of a suite: some times what it takes with nothing changed.
SLOWER, LIMITS_S = 5, {}
COMPILE_LIMIT_S, TIMED_OUT = 300, 124
# How gtest and rostest tell of a test that failed.
FAILED = re.compile(r"\[  FAILED  \] ([\w.]+)|rosunit-\w+/(\w+)\]\[FAILURE\]")
BASIC = ("driving", "simulation", "hardware")
# The suites that are to notice the changes by rule to a folder's sources.
FOLDERS = {"src/driving": BASIC, "src/pose": ("pose",), "src/tracking": ("tracking", "odometry"),
           "src/odometry": ("odometry", "simulated_run"),
           "src/ros": ("ros", "live_poses", "ba_node", "kitti_player", "odometry_chain_nodes")}
# The same of those sources that another node's test runs.
FILES = {"chassis_": ("ros", "chassis_node"), "published_camera|camera_node": ("ros", "stereo_camera"),
         "pan_tilt_node": ("ros", "pan_tilt"), "drive_panel": ("ros", "drive_panel"),
         "simulator_node|transforms": ("ros", "simulated_graph")}


def suites_of_file(folder, file):
    return next((suites for names, suites in FILES.items() if folder == "src/ros" and re.search(names, file)), FOLDERS[folder])


def find_failure(suite, number):
    """The first test of a suite that fails with the change of this number switched on; nothing where none does."""
    environment = {**os.environ, "ARFM_VO_MUTANT": str(number), "GTEST_FAIL_FAST": "1", "GTEST_BRIEF": "1"}
    start_s = time.monotonic()
    try:
        ended = subprocess.run(SUITES[suite][1], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               timeout=LIMITS_S.get(suite))
    except subprocess.TimeoutExpired:
        return suite + " (time-out)"
    LIMITS_S.setdefault(suite, 60 + SLOWER * (time.monotonic() - start_s))
    if ended.returncode == 0:
        return None
    found = FAILED.search(ended.stdout.decode(errors="replace"))
    return found.group(1) or found.group(2) if found else suite + " (ended)"


def notice(suites, number):
    """The first test that fails; nothing where none does."""
    return next(filter(None, (find_failure(suite, number) for suite in suites)), None)


def configure():
    (BUILD / "devel/lib/python3/dist-packages").mkdir(parents=True, exist_ok=True)
    subprocess.run(["cmake", "-S", str(ROOT), "-B", str(BUILD), "-G", "Ninja", "-DARFM_VO_UNITY=OFF"], check=True, stdout=subprocess.DEVNULL)


def build(suites):
    targets = sorted({target for suite in suites for target in SUITES[suite][0]})
    made = subprocess.run(["ninja", "-C", str(BUILD), "-j2", "arfm_vo_generate_messages_py"] + targets, capture_output=True, text=True)
    if made.returncode != 0:
        sys.exit("does not build:\n" + "\n".join(line for line in made.stdout.splitlines() if "error" in line))


def compile_command(path):
    """How ninja compiles a file, to find the changes that do not compile."""
    commands = subprocess.run(["ninja", "-C", str(BUILD), "-t", "commands"], capture_output=True, text=True).stdout
    return next(line for line in commands.splitlines() if line.endswith(str(path)) and " -c " in line)


def drop_what_does_not_compile(source):
    command = compile_command(source.path) + " -fsyntax-only -fmax-errors=0"
    while True:
        source.write()
        said = subprocess.run(["timeout", str(COMPILE_LIMIT_S), "sh", "-c", command], cwd=BUILD, capture_output=True, text=True)
        if said.returncode == 0:
            return
        if said.returncode == TIMED_OUT:
            print("%s: left out, takes too long to compile with all changes" % source.file, flush=True)
            source.by_rule = []
            return source.restore()
        wrong = {int(line.split(":")[1]) for line in said.stderr.splitlines() if source.file in line.split(":")[0] and " error:" in line}
        if not source.drop_lines(wrong):
            sys.exit("does not compile:\n" + said.stderr)


def table(rows, header):
    return "\n".join(["", "| %s |" % " | ".join(header), "|" + "---|" * len(header)] + ["| %s |" % " | ".join(row) for row in rows])


def try_all(changes, suites_of):
    """[(change, suite that noticed it or None)]."""
    tried = []
    for change in changes:
        noticed = notice(suites_of(change), change.number)
        print("%-70s %s" % (change.name, noticed or "NOT NOTICED"), flush=True)
        tried.append((change, noticed))
    return tried


def try_switched(sources, changes, suites, suites_of):
    """The same, with the switches in the sources meanwhile."""
    try:
        for source in sources:
            source.write()
        build(suites)
        broken = notice(sorted(suites), 0)
        if broken:
            sys.exit("%s fails with nothing changed" % broken)
        return try_all(changes, suites_of)
    finally:
        for source in sources:
            source.restore()
        build(suites)


def try_protections(text):
    sources = {}
    changes = []
    for protection in PROTECTIONS:
        if text in protection.name or text in protection.file:
            source = sources.setdefault(protection.file, Source(ROOT, protection.file, len(sources)))
            changes.append(source.protect(protection))
    suites = {suite for change in changes for suite in change.suites}
    return try_switched(sources.values(), changes, suites, lambda change: change.suites)


def try_rules(folder, size, seed):
    """What became of a sample, and how many changes it was drawn from."""
    paths = sorted((ROOT / folder).rglob("*.cpp"))
    sources = [Source(ROOT, str(path.relative_to(ROOT)), i) for i, path in enumerate(paths)]
    try:
        for source in sources:
            find_changes(source)
            drop_what_does_not_compile(source)
    except BaseException:
        for source in sources:
            source.restore()
        raise
    possible = [change for source in sources for change in source.by_rule]
    sample = random.Random(seed).sample(possible, min(size, len(possible)))
    suites = {change.number: suites_of_file(folder, change.file) for change in sample}
    return try_switched(sources, sample, {one for some in suites.values() for one in some},
                        lambda change: suites[change.number]), len(possible)


def tell_protections(tried):
    rows = [(change.name, "`%s`" % change.file, noticed or "**not noticed**") for change, noticed in tried]
    return "%d of %d are noticed.\n" % (sum(bool(noticed) for _, noticed in tried), len(tried)) + table(rows, ("protection", "in", "noticed by"))


def tell_sample(folder, sampled, seed, num_possible):
    survivors = [change for change, noticed in sampled if not noticed]
    text = ("%d changes of %s, drawn (seed %d) from %d that the rules of `test/mutation/rules.py` make: %d are\n"
            "noticed (%.0f %%). Those that are not:\n" % (len(sampled), folder, seed, num_possible, len(sampled) - len(survivors),
                                                         100 * (1 - len(survivors) / len(sampled))))
    return text + table([(change.file.split("/")[-1] + ":%d" % change.line, change.rule, "`%s`" % change.text.replace("|", "\\|"))
                         for change in survivors], ("place", "change", "line"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", choices=sorted(FOLDERS), metavar="FOLDER", help=" ".join(sorted(FOLDERS)))
    parser.add_argument("--only", default="", help="protections whose name or file holds this")
    parser.add_argument("--rules-only", action="store_true", help="no protections")
    parser.add_argument("--sample", type=int, default=0, help="of the changes by rule")
    parser.add_argument("--seed", type=int, default=1, help="of the sample")
    parser.add_argument("--output", metavar="PAGE", help="whose tables are replaced")
    arguments = parser.parse_args(sys.argv[1:] or ["--sample", "200", "--output", str(ROOT / "docs/mutation.md")])
    if subprocess.run(["git", "status", "--porcelain", "src", "include", "nodes"], cwd=ROOT, capture_output=True).stdout:
        sys.exit("mutants: src, include and nodes must be as committed")
    configure()
    if arguments.folder:
        sampled, num_possible = try_rules(arguments.folder, arguments.sample or 60, arguments.seed)
        print(tell_sample(arguments.folder, sampled, arguments.seed, num_possible))
        return 0
    protections = [] if arguments.rules_only else try_protections(arguments.only)
    sampled, num_possible = try_rules("src/driving", arguments.sample, arguments.seed) if arguments.sample else ([], 0)
    for what, tried in ("protections", protections), ("changes by rule", sampled):
        print("%s: %d of %d noticed" % (what, sum(bool(noticed) for _, noticed in tried), len(tried)))
    if arguments.output and protections:
        replace_section(arguments.output, "protections", tell_protections(protections))
    if arguments.output and sampled:
        replace_section(arguments.output, "sample", tell_sample("src/driving", sampled, arguments.seed, num_possible))
    return 0 if all(noticed for _, noticed in protections) else 1


if __name__ == "__main__":
    sys.exit(main())
