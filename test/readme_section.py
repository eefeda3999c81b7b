#!/usr/bin/python3
"""Puts the text of standard input between the marks of a section in a Markdown file, in place of what stands there.

What measures something writes its tables so; the page says around them what they mean. No text at all is an error.
Usage: readme_section.py FILE NAME      marks: a line that begins with <!-- NAME: begin and one that is <!-- NAME: end -->
"""
import os
import re
import sys


def replace_section(path, name, text):
    """The file as a whole is there at any time, old or new."""
    if not text.strip():
        sys.exit(f"{path}: nothing to put into {name}")
    with open(path) as stream:
        content = stream.read()
    marks = re.compile(rf"(^<!-- {re.escape(name)}: begin.*?-->\n).*?(^<!-- {re.escape(name)}: end -->$)", re.M | re.S)
    if not marks.search(content):
        sys.exit(f"{path}: no lines '<!-- {name}: begin ..' and '<!-- {name}: end -->'")
    with open(path + ".new", "w") as stream:
        stream.write(marks.sub(lambda match: match[1] + text.rstrip("\n") + "\n" + match[2], content))
    os.rename(path + ".new", path)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    replace_section(sys.argv[1], sys.argv[2], sys.stdin.read())
