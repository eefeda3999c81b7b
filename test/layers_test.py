#!/usr/bin/python3
"""Fails on an include of a higher layer, and on a ROS include in the core.

The layers and what each may use are read from the arfm_layer() lines of CMakeLists.txt, so that the build file is the
one table. Usage: layers_test.py [PACKAGE_DIR]
"""
import pathlib
import re
import sys

WITH_ROS = {"ros", "rover", "nodes"}
ROS_HEADERS = re.compile(
    r"^(ros|tf2?(_\w+)?|nodelet|pluginlib|class_loader|roscpp|xmlrpcpp|rosbag|rosgraph_msgs|image_transport|"
    r"cv_bridge|camera_info_manager|message_filters|diagnostic_updater|diagnostic_msgs|dynamic_reconfigure|actionlib|"
    r"(std|sensor|nav|geometry|visualization|move_base)_msgs|std_srvs)/")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def read_layers(cmake_text):
    """{layer: set of the layers that it may use, itself among them}, through all depths."""
    layers = {}
    for call in re.finditer(r"^arfm_layer\(([^)]*)\)", cmake_text, re.MULTILINE):
        words = call.group(1).split()
        name, used, is_depends = words[0], set(), False
        for word in words[1:]:
            if word in ("FOLDER", "FILES", "WITHOUT", "DEPENDS", "LIBRARIES", "PRECOMPILED"):
                is_depends = word == "DEPENDS"
            elif is_depends:
                if word not in layers:
                    raise SystemExit(f"CMakeLists.txt: layer {name} depends on {word}, which is not declared above it")
                used |= layers[word]
        layers[name] = used | {name}
    return layers


def find_violations(package, layers):
    files = [f for folder in ("include/arfm_vo", "src", "nodes") for f in (package / folder).rglob("*")
             if f.suffix in (".h", ".cpp")]
    violations, num_includes = [], 0
    for file in sorted(files):
        parts = file.relative_to(package).parts
        layer = "nodes" if parts[0] == "nodes" else parts[2 if parts[0] == "include" else 1]
        if layer not in layers and layer != "nodes":
            violations.append(f"{'/'.join(parts)}: folder {layer} is no layer of CMakeLists.txt")
            continue
        allowed = set(layers) if layer == "nodes" else layers[layer]
        if layer == "ros" and "rover" in layers:  # of layers that only its folder rover is linked with, headers alone
            allowed = layers["rover"] if "rover" in parts else layers["rover"] - {"rover"}
        for number, line in enumerate(file.read_text().splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            num_includes += 1
            header = include.group(1)
            where = f"{'/'.join(parts)}:{number}: {header}"
            own = re.match(r"arfm_vo/(?:ros/(?=rover/))?(\w+)/", header)
            is_message = re.match(r"arfm_vo/\w+\.h$", header)
            if own and own.group(1) not in allowed:
                violations.append(f"{where}: layer {layer} may not use {own.group(1)}")
            if (is_message or ROS_HEADERS.match(header)) and layer not in WITH_ROS:
                violations.append(f"{where}: ROS in the core")
    return violations, len(files), num_includes


def check_itself():
    """The check must see what it is there for."""
    layers = read_layers("arfm_layer(base)\narfm_layer(image DEPENDS base LIBRARIES ros)\narfm_layer(ros DEPENDS image)")
    assert layers == {"base": {"base"}, "image": {"base", "image"}, "ros": {"base", "image", "ros"}}, layers
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        package = pathlib.Path(folder)
        for name, text in {"include/arfm_vo/base/a.h": '#include "arfm_vo/image/b.h"\n',
                "src/image/b.cpp": '#include "arfm_vo/base/a.h"\n#include <ros/ros.h>\n#include <arfm_vo/Status.h>\n',
                "src/ros/c.cpp": '#include <ros/ros.h>\n#include "arfm_vo/image/b.h"\n', "src/attic/d.cpp": ""}.items():
            (package / name).parent.mkdir(parents=True, exist_ok=True)
            (package / name).write_text(text)
        violations, _, _ = find_violations(package, layers)
        assert len(violations) == 4, violations


def main():
    check_itself()
    package = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1])
    layers = read_layers((package / "CMakeLists.txt").read_text())
    violations, num_files, num_includes = find_violations(package, layers)
    if num_includes == 0:
        raise SystemExit(f"{package}: no sources found")
    print("\n".join(violations))
    print(f"{len(layers)} layers, {num_files} files, {num_includes} includes, {len(violations)} violations")
    raise SystemExit(1 if violations else 0)


if __name__ == "__main__":
    main()
