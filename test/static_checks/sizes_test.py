#!/usr/bin/python3
"""Keeps files, functions and folders small, and the shell of scripts too.

Lines: a source 250, a header 120, a function of the product 60; CMakeLists.txt 150. Files: a folder 25. Scripts (Python and
shell) in all: MAX_SCRIPT_LINES. What is larger stands in LARGER with its size, which may only fall.
Usage: sizes_test.py [PACKAGE_DIR]
"""
import collections
import pathlib
import re
import sys

MAX_LINES = {".cpp": 250, ".inl": 250, ".py": 250, ".sh": 250, ".h": 120}
MAX_FUNCTION_LINES, MAX_FILES, MAX_BUILD_LINES, MAX_SCRIPT_LINES = 60, 25, 150, 6088
FOLDERS = ("cmake", "config", "docs", "include", "launch", "msg", "nodes", "scripts", "src", "test", "urdf")
LARGER = {
    "docs": 32, "include/arfm_vo/odometry": 30, "src/odometry": 35, "test/nodes": 33, "test/recordings": 26,
    "src/mapping/local_map.cpp": 259, "test/bundle_adjustment/bundle_adjustment_test.cpp": 299,
    "test/bundle_adjustment/bundle_scene.h": 133, "test/features/plain_surf.h": 195, "test/hardware/pan_tilt_test.cpp": 263,
    "test/nodes/chassis_node_test.cpp": 335, "test/nodes/odometry_chain_test.cpp": 292,
    "test/pose/pose_estimator_test.cpp": 270, "test/pose/pose_refinement_test.cpp": 254, "test/ros/valid_messages.h": 149,
    "test/simulation/fault_table_test.cpp": 419, "test/simulation/simulated_drive.h": 146,
}
NO_FUNCTION = re.compile(r"\s*(namespace|class|struct|enum|union|extern|using|template <[^>]*> (class|struct))\b")


def list_files(package):
    files = [path for folder in FOLDERS for path in (package / folder).rglob("*") if path.is_file()]
    return [path for path in files if "corpus" not in path.parts and "__pycache__" not in path.parts]


def find_long_functions(lines):
    """(first line, number of lines) of the functions that are too long, in files as clang-format leaves them."""
    for indent in "", "  ":
        start = None
        for i, line in enumerate(lines):
            if re.match(indent + r"[A-Za-z~]", line):
                start = i
            elif line.startswith(indent + "}") and start is not None:
                if i - start >= MAX_FUNCTION_LINES and not NO_FUNCTION.match(lines[start]):
                    yield start + 1, i - start + 1
                start = None


def measure(package):
    """{name: (size, limit)} of all that has a limit."""
    sizes, per_folder, num_script_lines = {}, collections.Counter(), 0
    for path in list_files(package):
        name = str(path.relative_to(package))
        per_folder[str(path.parent.relative_to(package))] += 1
        if path.suffix not in MAX_LINES:
            continue
        lines = path.read_text().splitlines()
        sizes[name] = len(lines), MAX_LINES[path.suffix]
        num_script_lines += len(lines) if path.suffix in (".py", ".sh") else 0
        if path.suffix in (".cpp", ".h") and not name.startswith("test/"):
            for line, size in find_long_functions(lines):
                sizes[f"{name}, a function"] = size, MAX_FUNCTION_LINES
    sizes.update((folder, (size, MAX_FILES)) for folder, size in per_folder.items())
    sizes["CMakeLists.txt"] = len((package / "CMakeLists.txt").read_text().splitlines()), MAX_BUILD_LINES
    sizes["Python and shell, lines in all"] = num_script_lines, MAX_SCRIPT_LINES
    return sizes


def main():
    package = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2])
    assert list(find_long_functions(["int F() {"] + ["  a;"] * 59 + ["}"])) == [(1, 61)]
    sizes = measure(package)
    faults = [f"{name}: {size}, more than {LARGER.get(name, limit)}" for name, (size, limit) in sizes.items()
              if size > LARGER.get(name, limit)]
    faults += [f"{name}: no longer larger than others, to be taken from LARGER" for name in LARGER
               if sizes.get(name, (0, 1))[0] <= sizes.get(name, (0, 1))[1]]
    print(*sorted(faults), f"{len(sizes)} sizes, {len(LARGER)} known to be larger, "
          f"{sizes['Python and shell, lines in all'][0]} lines of Python and shell, {len(faults)} faults", sep="\n")
    sys.exit(len(faults) > 0)


if __name__ == "__main__":
    main()
