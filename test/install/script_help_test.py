#!/usr/bin/python3
"""Each script of a user, and each name of scripts/measure.sh, says by --help what it is for, at once and without doing it, and
hides no module of Python's own. Each script is named in README.md or CONTRIBUTING.md."""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MAX_SCRIPTS = 12
STANDARD_MODULES = getattr(sys, "stdlib_module_names", {"operator"})  # (Python 3.10)


def find_fault(command):
    try:
        run = subprocess.run(command + ["--help"], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, timeout=60, env={**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]})
    except subprocess.TimeoutExpired:
        return "does not end"
    if run.returncode != 0:
        return f"ends with {run.returncode}: {(run.stderr or run.stdout).strip()[-200:]}"
    return None if "usage" in run.stdout.lower() else f"tells no usage: {run.stdout.strip()[:200]}"


def main():
    scripts = sorted((ROOT / "scripts").iterdir())
    scripts = [path for path in scripts if path.suffix in (".py", ".sh")]
    measure = str(ROOT / "scripts" / "measure.sh")
    listed = subprocess.run([measure], text=True, stdout=subprocess.PIPE, check=True).stdout
    names = [line.split()[0] for line in listed.partition("\nNAME ")[2].splitlines()[1:]]
    pages = (ROOT / "README.md").read_text() + (ROOT / "CONTRIBUTING.md").read_text()
    # Python looks beside a script first: those beside it would import it.
    faults = [f"{path.name} has the name of a module of Python" for path in scripts if path.stem in STANDARD_MODULES]
    faults += [f"{path.name} is named neither in README.md nor in CONTRIBUTING.md" for path in scripts if path.name not in pages]
    if len(scripts) > MAX_SCRIPTS or len(names) < 10:
        faults.append(f"{len(scripts)} scripts, more than {MAX_SCRIPTS}, or {len(names)} names of measure.sh")
    for command in [[str(path)] for path in scripts] + [[measure, name] for name in names]:
        fault = find_fault(command)
        if fault:
            faults.append(f"{' '.join(command)}: {fault}")
    print(*faults, f"{len(scripts)} scripts, {len(names)} names, {len(faults)} faults", sep="\n")
    sys.exit(len(faults) > 0)


if __name__ == "__main__":
    main()
