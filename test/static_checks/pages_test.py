#!/usr/bin/python3
"""Keeps the pages true: links lead somewhere, docs/index.md names each page, README.md is one page, the files of the table of
equations are there and name them, the drawing has each layer of the odometry, each row of docs/hazards.md names its test, and
what a mutation replaces is there.

Usage: pages_test.py [PACKAGE_DIR]
"""
import pathlib
import re
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "mutation"))
from protections import PROTECTIONS  # noqa: E402

MAX_README_BYTES = 10000
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
EQUATION = re.compile(r"\beqs? (\d+(?:, \d+)*)")


def find_dead_links(page):
    return [f"{page.name}: no {target}" for target in LINK.findall(page.read_text())
            if not target.startswith(("http:", "https:", "mailto:")) and not (page.parent / target).exists()]


def numbers(text):
    return {number for found in EQUATION.findall(text) for number in found.split(", ")}


def find_faults_of_table(package, text):
    """Of the rows | eq N | what | `file`, `file` |."""
    faults, seen = [], set()
    for row in re.findall(r"^\| ((?:eqs?|Figs?\.?) [^|]*) \|[^|]*\| ([^|]*) \|$", text, re.M):
        files = [package / name for name in re.findall(r"`([^`]+)`", row[1])]
        faults += [f"{row[0]}: no {file}" for file in files if not file.is_file()]
        told = set().union(*(numbers(file.read_text()) for file in files if file.is_file()))
        faults += [f"{row[0]}: none of its files names eq {number}" for number in numbers(row[0]) - told]
        seen |= numbers(row[0])
    return faults + [f"eq {number} has no row" for number in map(str, range(1, 9)) if number not in seen]


def find_untested(package, text):
    """Rows of tables whose last cell names no test: gtest's Suite.Case, or a row of a campaign."""
    sources = [path.read_text() for path in (package / "test").rglob("*.cpp")]
    known = {".".join(case) for source in sources for case in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", source, re.M)}
    for page in "fault_campaign", "faults", "hardware_faults":
        known.update(re.findall(r"^\| ([^|]*?) \|", (package / "docs" / (page + ".md")).read_text(), re.M))
    rows = re.findall(r"^\|(?!.*\n\|--)[^-].*\|(.*)\|$", text, re.M)
    tests = [(row, re.findall(r"`([^`]+)`", row)) for row in rows]
    return [f"hazards.md: no test: {row}" for row, names in tests if not names or not known.issuperset(names)]


def main():
    package = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2])
    docs = package / "docs"
    pages = sorted(docs.glob("*.md"))
    faults = [fault for page in pages + [package / "README.md", package / "CONTRIBUTING.md"] for fault in find_dead_links(page)]
    index = (docs / "index.md").read_text()
    faults += [f"docs/index.md does not name {page.name}" for page in pages if f"({page.name})" not in index and page.stem != "index"]
    size = len((package / "README.md").read_bytes())
    faults += [f"README.md: {size} bytes, more than {MAX_README_BYTES}"] * (size > MAX_README_BYTES)
    faults += [f"protections.py: {p.name}: not once in {p.file}: {p.old}" for p in PROTECTIONS
               if (package / p.file).read_text().count(p.old) != 1]
    work = (docs / "how_it_works.md").read_text()
    faults += find_faults_of_table(package, work)
    drawing = work.partition("```\n")[2].partition("```")[0]
    layers = re.findall(r"^arfm_layer\((\w+)", (package / "CMakeLists.txt").read_text(), re.M)
    layers = layers[:layers.index("odometry") + 1]
    faults += [f"how_it_works.md: the drawing lacks the layer {layer}" for layer in layers if layer not in drawing]
    faults += find_untested(package, (docs / "hazards.md").read_text())
    print(*faults, f"{len(pages)} pages, README.md {size} bytes, {len(faults)} faults", sep="\n")
    sys.exit(len(faults) > 0)


if __name__ == "__main__":
    main()
