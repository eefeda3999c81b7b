#!/usr/bin/python3
"""Refuses arguments of roslaunch that its launch file does not have; roslaunch itself passes over them.

Usage: check_arguments.py LAUNCH_FOLDER      called by its launch files; the command line is that of the parent, roslaunch
"""
import difflib
import os
import sys
import xml.etree.ElementTree as xml


def list_arguments(path):
    """The names that may be given to a launch file, with those of the files that it passes all to."""
    document = xml.parse(path).getroot()
    names = {arg.get("name") for arg in document.findall("arg") if arg.get("value") is None}
    for include in document.iter("include"):
        if include.get("pass_all_args") == "true":
            names |= list_arguments(os.path.join(os.path.dirname(path), os.path.basename(include.get("file"))))
    return names


def find_launch_file(words, folder):
    """That of the folder which a command line names; None where it is another's, or none."""
    for before, word in zip(words, words[1:]):
        if word.endswith(".launch"):
            path = os.path.join(folder, word) if before == "arfm_vo" else os.path.abspath(word)
            return path if os.path.isfile(path) and os.path.samefile(os.path.dirname(path), folder) else None
    return None


def find_fault(words, folder):
    """What is wrong with the arguments of a command line, in words; empty where nothing is."""
    path = find_launch_file(words, folder)
    given = [word.split(":=")[0] for word in words if ":=" in word and not word.startswith("_")]
    if path is None or not given:
        return ""
    known = list_arguments(path)
    for name in given:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            advice = f"is {near[0]}:= meant?" if near else f"roslaunch --ros-args {path} lists those it has"
            return f"{os.path.basename(path)} has no argument {name}:= ({advice})"
    return ""


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(f"/proc/{os.getppid()}/cmdline") as file:
        fault = find_fault(file.read().split("\0"), sys.argv[1])
    if fault:
        sys.exit("ERROR: " + fault)


if __name__ == "__main__":
    main()
