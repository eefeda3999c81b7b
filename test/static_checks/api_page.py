#!/usr/bin/python3
"""Writes docs/api.md: topics, services, tf and parameters of every node, from the nodes' --help and the option structs.

Usage: scripts/measure.sh api_page [PROGRAM_DIR] [--check]      default: _b/devel/lib/arfm_vo

With --check nothing is written; exit status 1 where the page is not what the code says.
"""
import glob
import os
import re
import subprocess
import sys

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGE = os.path.join(ROOT, "docs", "api.md")
SHARED = "OdometryOptions"  # the algorithm's options, which several nodes have: told once
ENUMS, RANGES = {}, {}  # of read_enums() and read_ranges()


def read_structs():
    """{struct: ([(key or None, member)], {member: (type, meaning)})} of all structs with VisitFields."""
    structs = {}
    for path in sorted(glob.glob(ROOT + "/include/**/*.h", recursive=True) + glob.glob(ROOT + "/nodes/*.cpp")):
        with open(path) as file:
            text = file.read()
        for match in re.finditer(r"^struct (\w+) \{\n(.*?)^\};", text, re.M | re.S):
            name, body = match.groups()
            if "VisitFields" in body or "ARFM_FIELDS" in body:
                structs[name] = (read_visits(body), read_members(body))
    return structs


def read_visits(body):
    fields = re.search(r"ARFM_FIELDS\((.*?)\)\n", body, re.S)
    if fields:
        return [(None if field[0] == "(" else field, field.strip("()")) for field in re.split(r",\s*", fields.group(1))]
    calls = re.findall(r'visit\("(\w+)",\s*(\w+)\)|^\s*(\w+)\.VisitFields\(visit\)', body, re.M)
    return [(key or None, member or plain) for key, member, plain in calls]


def read_members(body):
    members, last, above = {}, [], ""
    for line in re.sub(r"([=,])\n\s+", r"\1 ", body).splitlines():  # a declaration of several lines
        more = re.match(r"\s+///< ?(.*)", line)
        before = re.match(r"\s+/// (.*)", line)
        field = re.match(r"  ([\w:<>, ]+?) (\w+(?: = [^;]*)?(?:, \w+(?: = [^;]*)?)*)(?:\{.*\})?;(?:\s*///< ?(.*))?$", line)
        if more and last:  # a comment that goes on
            for member in last:
                members[member] = (members[member][0], members[member][1] + " " + more.group(1))
        elif before:
            above += " " + before.group(1)
        elif field:
            last = [part.split(" = ")[0].strip() for part in re.split(r",(?![^{(]*[})])", field.group(2))]
            last = [member for member in last if re.fullmatch(r"\w+", member)]
            for member in last:
                members[member] = (field.group(1).strip(), field.group(3) or above.strip())
            above = ""
        else:
            above = ""
    return members


def read_enums():
    """{enum: [names of its values]} of all enums that options hold, by their ListNames."""
    enums = {}
    for path in glob.glob(ROOT + "/include/**/*.h", recursive=True):
        with open(path) as file:
            for name, kind in re.findall(r'\{"(\w+)",\s*(\w+)::k\w+\}', file.read()):
                enums.setdefault(kind, []).append(name)
    return enums


def read_ranges():
    """{struct: {member: range}} from what the structs' Check() says of a value out of its range."""
    ranges = {}
    for path in glob.glob(ROOT + "/include/**/*.h", recursive=True) + glob.glob(ROOT + "/[sn]*/**/*.cpp", recursive=True):
        with open(path) as file:
            text = file.read()
        checks = re.findall(r"^void (\w+)::Check\(\) const \{\n(.*?)^\}", text, re.M | re.S)
        for struct, body in re.findall(r"^struct (\w+) \{\n(.*?)^\};", text, re.M | re.S):
            checks += [(struct, check) for check in re.findall(r"^  void Check\(\) const \{(.*?)^  \}", body, re.M | re.S)]
        for struct, body in checks:
            ranges.setdefault(struct, {}).update(read_conditions(body))
    return ranges


def read_conditions(body):
    """{member: range} of a Check()."""
    conditions = {}
    for kind, low, high, key in re.findall(r'Require(InRange|Above)\(\w+, ([^,]+), ([^,]+), "([\w.]+)"\)', body):
        text = f"{low}..{high}" if kind == "InRange" else f"({low}, {high}]"
        conditions[key.split(".")[-1]] = text.replace("M_PI", "pi")
    for call in re.findall(r"Require\((.*?)\);", body, re.S):
        message = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', call))
        names, must, rule = message.partition(" must ")
        if must and not re.search(r'"\s*\+|\+\s*"', call):  # whole sentences only
            for name in re.findall(r"[\w.]+", names):
                conditions[name.split(".")[-1]] = shorten(rule)
    return conditions


def shorten(rule):
    """What a value must be, as short as a column needs it."""
    rule = rule.partition(":")[0].replace(", in this order", "").replace(", both positive", "")
    for long, short in ((r"^be in ", ""), (r"^be positive$", "> 0"), (r"^not be negative$", ">= 0"),
                        (r"^be at least ", ">= "), (r"^be above ", "> "), (r"^be ", "")):
        rule = re.sub(long, short, rule)
    return rule


def find_meanings(structs, struct, prefix=""):
    """{full key: (type, range, meaning)} of a struct, those within it as well."""
    meanings = {}
    visits, members = structs[struct]
    for key, member in visits:
        kind, meaning = members.get(member, ("", ""))
        inner = kind.replace("std::", "").split("::")[-1]
        if key is None:
            meanings.update(find_meanings(structs, inner, prefix))
        elif inner in structs:
            meanings.update(find_meanings(structs, inner, prefix + key + "/"))
        else:
            known = ENUMS.get(inner, [])
            allowed = ", ".join(known) if known else RANGES.get(struct, {}).get(member, "")
            meanings[prefix + key] = (inner, allowed, meaning)
    return meanings


def flatten(tree, prefix=""):
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from flatten(value, prefix + key + "/")
        else:
            yield prefix + key, value


def format_value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else str(value)


def format_table(defaults, meanings):
    lines = ["| parameter | type | default | range | meaning |", "|---|---|---|---|---|"]
    for key, value in defaults:
        kind, allowed, meaning = meanings.get(key, ("", "", ""))
        lines.append(f"| `{key}` | {kind} | `{format_value(value)}` | {allowed} | {meaning.replace('|', '/')} |")
    return "\n".join(lines) + "\n"


def read_nodes():
    """[(node, its options struct)] from the nodes' main functions."""
    nodes = []
    for path in sorted(glob.glob(ROOT + "/nodes/*_node.cpp")):
        with open(path) as file:
            text = file.read()
        match = re.search(r"RunNode<[\w:]+,\s*(?:arfm_vo::)?(\w+)>|TellHelp<(?:arfm_vo::)?(\w+)>", text)
        nodes.append((os.path.basename(path)[:-4], match.group(1) or match.group(2)))
    return nodes


def make_page(program_dir):
    ENUMS.update(read_enums())
    RANGES.update(read_ranges())
    structs = read_structs()
    shared = find_meanings(structs, SHARED)
    page = ["# Nodes\n", "Made by `scripts/measure.sh api_page` from the code; `NODE --help` prints the same without a master. "
            "Topics, services and\nparameters stand below the namespace of the node, those with ~ below the node's "
            "name; frames are parameters. A value\nout of its range and an unknown parameter end the node with an "
            "error that names them. Lengths in m, angles in rad,\ntimes in s, where the name does not say otherwise.\n"]
    algorithm = {}
    for node, struct in read_nodes():
        said = subprocess.run([os.path.join(program_dir, node), "--help"], check=True, text=True, stdout=subprocess.PIPE).stdout
        about, parameters = split_help(said)
        defaults = list(flatten(yaml.safe_load(parameters)))
        meanings = find_meanings(structs, struct)
        own = [(key, value) for key, value in defaults if key not in shared]
        algorithm.update({key: value for key, value in defaults if key in shared})
        page.append(f"## {node}\n\n```\n{about}\n```\n")
        if len(own) < len(defaults):
            page.append("The algorithm's options below, and\n")
        page.append(format_table(own, meanings))
    page.append("## The algorithm\n\nOf arfm_node, pose_node and ba_node: give all of them the same, by `config:=FILE` "
                "of the launch files.\n")
    page.append(format_table(algorithm.items(), shared))
    reasons = subprocess.run([os.path.join(program_dir, "kitti_odometry"), "--print-reasons"], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    page.append("## Why a pair has no pose, or one to be wary of\n\nIn `status`, on the console and in `timing.csv` "
                "(with the log odds that the pose is the ground's, and not that\nof something that moves on its own).\n")
    page.append(reasons)
    return "\n".join(page)


def split_help(said):
    """What a node does, and its parameters as YAML."""
    rest = said.partition("\n\n")[2]
    about, _, parameters = rest.partition("\n\nprivate parameters and their defaults, as YAML:\n\n")
    return about, parameters


def main():
    if {"--help", "-h"} & set(sys.argv):
        print(__doc__)
        return
    folders = [word for word in sys.argv[1:] if word != "--check"]
    if len(folders) > 1:
        sys.exit(__doc__)
    page = make_page(folders[0] if folders else os.path.join(ROOT, "_b/devel/lib/arfm_vo"))
    if "--check" not in sys.argv:
        with open(PAGE, "w") as file:
            file.write(page)
        return
    with open(PAGE) as file:
        if file.read() != page:
            sys.exit("docs/api.md is not what the code says: run scripts/measure.sh api_page")


if __name__ == "__main__":
    main()
