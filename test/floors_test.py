#!/usr/bin/python3
"""Fails on an include of a higher floor, and on a ROS include below the roof.

The floors and what each may use are read from the arfm_floor() lines of CMakeLists.txt, so that the build file is the
one table. Usage: floors_test.py [PACKAGE_DIR]
"""
import pathlib
import re
import sys

ROOF = {"ros", "nodes"}
ROS_HEADERS = re.compile(
    r"^(ros|tf2?(_\w+)?|nodelet|pluginlib|class_loader|roscpp|xmlrpcpp|rosbag|rosgraph_msgs|image_transport|"
    r"cv_bridge|camera_info_manager|message_filters|diagnostic_updater|diagnostic_msgs|dynamic_reconfigure|"
    r"(std|sensor|nav|geometry|visualization)_msgs|std_srvs)/")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def read_floors(cmake_text):
    """{floor: set of the floors that it may use, itself among them}, through all depths."""
    floors = {}
    for call in re.finditer(r"^arfm_floor\(([^)]*)\)", cmake_text, re.MULTILINE):
        words = call.group(1).split()
        name, used, is_depends = words[0], set(), False
        for word in words[1:]:
            if word in ("DEPENDS", "LIBRARIES", "TEST_LIBRARIES"):
                is_depends = word == "DEPENDS"
            elif is_depends:
                if word not in floors:
                    raise SystemExit(f"CMakeLists.txt: floor {name} depends on {word}, which is not declared above it")
                used |= floors[word]
        floors[name] = used | {name}
    return floors


def find_violations(package, floors):
    files = [f for folder in ("include/arfm_vo", "src", "nodes") for f in (package / folder).rglob("*")
             if f.suffix in (".h", ".cpp")]
    violations, num_includes = [], 0
    for file in sorted(files):
        parts = file.relative_to(package).parts
        floor = "nodes" if parts[0] == "nodes" else parts[2 if parts[0] == "include" else 1]
        if floor not in floors and floor != "nodes":
            violations.append(f"{'/'.join(parts)}: folder {floor} is no floor of CMakeLists.txt")
            continue
        allowed = set(floors) if floor == "nodes" else floors[floor]
        for number, line in enumerate(file.read_text().splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            num_includes += 1
            header = include.group(1)
            where = f"{'/'.join(parts)}:{number}: {header}"
            own = re.match(r"arfm_vo/(\w+)/", header)
            is_message = re.match(r"arfm_vo/\w+\.h$", header)
            if own and own.group(1) not in allowed:
                violations.append(f"{where}: floor {floor} may not use {own.group(1)}")
            if (is_message or ROS_HEADERS.match(header)) and floor not in ROOF:
                violations.append(f"{where}: ROS below the roof")
    return violations, len(files), num_includes


def check_itself():
    """The check must see what it is there for."""
    floors = read_floors("arfm_floor(base)\narfm_floor(image DEPENDS base LIBRARIES ros)\narfm_floor(ros DEPENDS image)")
    assert floors == {"base": {"base"}, "image": {"base", "image"}, "ros": {"base", "image", "ros"}}, floors
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        package = pathlib.Path(folder)
        for name, text in {
                "include/arfm_vo/base/a.h": '#include "arfm_vo/image/b.h"\n',
                "src/image/b.cpp": '#include "arfm_vo/base/a.h"\n#include <ros/ros.h>\n#include <arfm_vo/Status.h>\n',
                "src/ros/c.cpp": '#include <ros/ros.h>\n#include "arfm_vo/image/b.h"\n',
                "src/attic/d.cpp": ""}.items():
            (package / name).parent.mkdir(parents=True, exist_ok=True)
            (package / name).write_text(text)
        violations, _, _ = find_violations(package, floors)
        assert len(violations) == 4, violations


def main():
    check_itself()
    package = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1])
    floors = read_floors((package / "CMakeLists.txt").read_text())
    violations, num_files, num_includes = find_violations(package, floors)
    if num_includes == 0:
        raise SystemExit(f"{package}: no sources found")
    print("\n".join(violations))
    print(f"{len(floors)} floors, {num_files} files, {num_includes} includes, {len(violations)} violations")
    raise SystemExit(1 if violations else 0)


if __name__ == "__main__":
    main()
