#!/usr/bin/python3
"""Runs the command blocks of Markdown pages as they stand there, in order, in one fresh shell in the package's folder.

Usage: readme_blocks.py PAGE ...

A comment above a block tells what the test does with it:
  <!-- readme_blocks: skip, REASON -->      nothing: it cannot run unattended, or takes too long
  <!-- readme_blocks: ends after N s -->    its last command does not end by itself: Ctrl-C after so long
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from ports import find_free_port  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
BLOCK = re.compile(r"(?:<!-- readme_blocks: ([^>]*) -->\n)?```(?:sh|bash)\n(.*?)```", re.S)
# What roslaunch says of a node that ends badly, while it goes on.
FAILURES = ("process has died [pid", "Traceback")
# Debian 11: roslaunch and rospy call Thread.isAlive as they end, which its Python 3.9 has no more.
EXCUSED, EXCUSED_WITHIN_LINES = "has no attribute 'isAlive'", 10
# rviz crashes in one of 140 starts on Debian 12's software renderer (docs/proof.md): a block in which it does is run once more.
CRASH, ONCE_MORE = "\\[rviz-.*exit code -11", "rviz's renderer has crashed: the block is run once more"


def read_blocks(path):
    """[("page:line", what the test does with it, commands)]"""
    with open(path) as file:
        text = file.read()
    return [(f"{os.path.basename(path)}:{text.count(chr(10), 0, match.start(2)) + 1}", match.group(1) or "run", match.group(2))
            for match in BLOCK.finditer(text)]


def find_end(todo):
    """After how many seconds a block is ended; None where it ends by itself."""
    match = re.fullmatch(r"ends after (\d+) s", todo)
    return int(match.group(1)) if match else None


def write_script(blocks):
    """One shell script of all blocks, which names each block's page and line before it runs it."""
    script = ["set -eo pipefail", "trap 'kill $(jobs -p) 2> /dev/null || true' EXIT"]  # nothing runs on behind a block that fails
    for place, todo, commands in blocks:
        script.append(f'echo "== {place}"')
        end_s = find_end(todo)
        if end_s is None:
            script.append(commands)
        else:  # its own process group, as a terminal's Ctrl-C reaches all of it
            script.append(f"run_block() {{ timeout -s INT -k 30 {end_s} bash -e <<'END' 2>&1 | tee \"$HOME/said\"\n{commands}END\n}}\n"
                          f"code=0; run_block || code=$?; ! grep -q '{CRASH}' \"$HOME/said\" || "
                          f'{{ echo "{ONCE_MORE}"; code=0; run_block || code=$?; }}\n'
                          f'[ $code -eq 124 ] || {{ echo "ended by itself with $code"; exit 1; }}')
    return "\n".join(script) + "\n"


def find_failures(said):
    """The lines of what was said that tell of a failure; a crash of rviz does where its block was not run once more after it."""
    def is_tried_again(i):
        return ONCE_MORE in next((text for text in said[i:] if text.startswith("== ") or ONCE_MORE in text), "")
    return [text.strip() for i, text in enumerate(said) if any(failure in text for failure in FAILURES)
            and not ("Traceback" in text and any(EXCUSED in line for line in said[i:i + EXCUSED_WITHIN_LINES]))
            and not (re.search(CRASH, text) and is_tried_again(i))]


def run(script, folder, home):
    """What a fresh shell says of the script; ends the test where it fails."""
    environment = {"PATH": "/usr/bin:/bin:/usr/sbin:/sbin", "HOME": home, "LANG": "C.UTF-8",
                   "ROS_MASTER_URI": f"http://localhost:{find_free_port()}"}
    shell = ["bash", "--norc", "-c", script]
    if shutil.which("xvfb-run"):
        shell = ["xvfb-run", "-a"] + shell
    process = subprocess.Popen(shell, cwd=folder, env=environment, text=True, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    said = []
    for text in process.stdout:
        print(text, end="", flush=True)
        said.append(text)
    code = process.wait()
    block = next((text.strip() for text in reversed(said) if text.startswith("== ")), "the first block")
    if code != 0:
        sys.exit(f"{block}: this block ended with {code}")
    failed = find_failures(said)
    if failed:
        sys.exit("a block says: " + failed[0])


def main():
    blocks = [block for page in sys.argv[1:] for block in read_blocks(page)]
    chosen = [block for block in blocks if block[1] == "run" or find_end(block[1])]
    for place, todo, _ in blocks:
        print(f"{place}: {todo}")
        if todo != "run" and not find_end(todo) and not todo.startswith("skip, "):
            sys.exit(f"{place}: a comment that the test does not know: {todo}")
    if not chosen:
        sys.exit("there is no block to run")
    with tempfile.TemporaryDirectory(prefix="arfm_vo_readme_") as home:
        run(write_script(chosen), ROOT, home)
    print(f"{len(chosen)} of {len(blocks)} blocks were run")


if __name__ == "__main__":
    main()
