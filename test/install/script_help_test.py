#!/usr/bin/python3
"""Each script of a user says by --help what it is for, at once and without doing it, and hides no module of Python's own.

Usage: script_help_test.py SCRIPTS_DIR
"""
import os
import pathlib
import subprocess
import sys

# Parts of other scripts, not called by a user; and mutants.sh, which looks at the working copy first.
STANDARD_MODULES = getattr(sys, "stdlib_module_names", {"operator"})  # (Python 3.10)
PARTS = {"help.sh", "kitti_folders.sh", "ports.py", "soak_report.py", "mutants.sh"}


def find_fault(script):
    if script.stem in STANDARD_MODULES:  # Python looks beside a script first: those beside it would import it
        return "has the name of a module of Python"
    command = ["/usr/bin/python3" if script.suffix == ".py" else "bash", str(script), "--help"]
    try:
        run = subprocess.run(command, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             timeout=60, env={**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]})
    except subprocess.TimeoutExpired:
        return "does not end"
    if run.returncode != 0:
        return f"ends with {run.returncode}: {(run.stderr or run.stdout).strip()[-200:]}"
    return None if "usage" in run.stdout.lower() else f"tells no usage: {run.stdout.strip()[:200]}"


def main():
    scripts = sorted(path for path in pathlib.Path(sys.argv[1]).iterdir()
                     if path.suffix in (".py", ".sh") and path.name not in PARTS)
    if not scripts:
        sys.exit(f"{sys.argv[1]}: no scripts")
    faults = [f"{path.name}: {fault}" for path in scripts for fault in [find_fault(path)] if fault]
    print(*faults, f"{len(scripts)} scripts, {len(faults)} faults", sep="\n")
    sys.exit(len(faults) > 0)


if __name__ == "__main__":
    main()
