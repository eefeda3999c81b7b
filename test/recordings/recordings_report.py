#!/usr/bin/env python3
"""Prints the report of recordings.csv (test/recordings, scripts/measure.sh recordings) as Markdown.
Usage: recordings_report.py RECORDINGS_CSV [tune|judge]"""
import csv
import math
import statistics
import sys

PROPERTIES = ["source", "motion", "scene", "stride", "direction", "swap", "cut", "light", "noise", "fov", "baseline", "width"]
MAX_WORST = 12  # seeds listed a kind


def total(rows, column):
    return sum(float(row[column]) for row in rows)


def median_ratio(rows):
    ratios = [float(row["length_ratio"]) for row in rows if math.isfinite(float(row["length_ratio"]))]
    return statistics.median(ratios) if ratios else math.nan


def nees(rows):
    """Mean over the rendered recordings without a fault; elsewhere the truth is not exact."""
    rows = [row for row in rows if row["kind"] == "rendered" and row["fault"] == "none"]
    pairs = total(rows, "nees_pairs")
    return total(rows, "nees_sum") / pairs if pairs else math.nan


def sigma_over_error(rows):
    """Over all tracked pairs: what the bound is asked of. The longest drives weigh most."""
    error = total(rows, "error2_sum")
    return math.sqrt(total(rows, "sigma2_sum") / error) if error else math.nan


def median_sigma_over_error(rows):
    """Median over the recordings, where a car's metres do not hide a rover's millimetres."""
    ratios = [math.sqrt(float(row["sigma2_sum"]) / float(row["error2_sum"])) for row in rows if float(row["error2_sum"])]
    return statistics.median(ratios) if ratios else math.nan


def show(number, digits=2):
    return f"{number:.{digits}f}" if math.isfinite(number) else "-"


def cells(rows):
    trackable, tracked = total(rows, "trackable"), total(rows, "tracked")
    percent = 100 * tracked / trackable if trackable else math.nan
    counts = [f"{total(rows, name):.0f}" for name in ("judged", "trackable", "lost", "degraded", "wrong", "other_wrong")]
    return [str(len(rows))] + counts + [show(percent, 1), show(sigma_over_error(rows)),
                                        show(median_sigma_over_error(rows)), show(nees(rows), 1), show(median_ratio(rows), 4)]


# What is said of the recordings without and with a fault: label, what is asked, and how it is found.
MEASURES = (
    ("lost of the trackable pairs", "<= 2 without a fault", lambda rows: f"{total(rows, 'lost'):.0f}"),
    ("degraded", "<= 20 without a fault", lambda rows: f"{total(rows, 'degraded'):.0f}"),
    ("wrong of the tracked", "<= 1 in 1000 with a fault", lambda rows: f"{total(rows, 'wrong'):.0f} of {total(rows, 'tracked'):.0f}"),
    ("wrong where it cannot be tracked", "0", lambda rows: f"{total(rows, 'other_wrong'):.0f}"),
    ("tracked of the trackable, %", ">= 90 with a fault", lambda rows: show(100 * total(rows, "tracked") / max(1, total(rows, "trackable")), 1)),
    ("sigma / rms error", "<= 3 with a fault", lambda rows: show(sigma_over_error(rows))),
    ("its median over the recordings", "", lambda rows: show(median_sigma_over_error(rows))),
    ("NEES, rendered", "3 to 9", lambda rows: show(nees(rows))))


def failures(rows, with_fault):
    """Bounds that the rows miss, in words."""
    missed = []
    tracked, trackable, wrong = (total(rows, name) for name in ("tracked", "trackable", "wrong"))
    if with_fault:
        if wrong > tracked / 1000:
            missed.append(f"wrong {wrong:.0f} of {tracked:.0f} tracked")
        if tracked < 0.9 * trackable:
            missed.append(f"{100 * tracked / trackable:.1f} % tracked")
        if sigma_over_error(rows) > 3:
            missed.append(f"sigma {sigma_over_error(rows):.1f} times the error")
    else:
        if total(rows, "lost") > 2:
            missed.append(f"lost {total(rows, 'lost'):.0f}")
        if total(rows, "degraded") > 20:
            missed.append(f"degraded {total(rows, 'degraded'):.0f}")
        if wrong:
            missed.append(f"wrong {wrong:.0f}")
        if math.isfinite(nees(rows)) and not 3 <= nees(rows) <= 9:
            missed.append(f"NEES {nees(rows):.1f}")
    if total(rows, "other_wrong"):
        missed.append(f"wrong where it cannot be tracked: {total(rows, 'other_wrong'):.0f}")
    return ", ".join(missed)


def print_table(rows, names, with_fault):
    print("\n| property | recordings | pairs | trackable | lost | degraded | wrong | wrong of the rest | tracked % | "
          "sigma / rms error | its median | NEES | length ratio | misses |")
    print("|---" * 14 + "|")
    for name in names:
        for value in sorted({row[name] for row in rows}):
            part = [row for row in rows if row[name] == value]
            print(f"| {name} {value} | " + " | ".join(cells(part)) + f" | {failures(part, with_fault)} |")


def print_worst(rows, column):
    worst = sorted((row for row in rows if float(row[column]) > 0), key=lambda row: -float(row[column]))
    for row in worst[:MAX_WORST]:
        what = ", ".join(row[name] for name in ("source", "motion", "scene", "fault", "direction", "swap", "cut", "light"))
        print(f"| {row['seed']} | {column} {row[column]} of {row['judged']} | {what}, stride {row['stride']} | "
              f"{show(float(row['worst_sigmas']), 1)} |")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    half = sys.argv[2] if len(sys.argv) > 2 else ""
    rows = [row for row in rows if not half or row["half"] == half]
    if not rows:
        sys.exit(f"recordings_report.py: {sys.argv[1]}: no recording of that half")
    clean = [row for row in rows if row["fault"] == "none"]
    faulty = [row for row in rows if row["fault"] != "none"]
    rendered = total([row for row in rows if row["kind"] == "rendered"], "pairs")
    print(f"{len(rows)} recordings{half and ' of the half to ' + half}, {total(rows, 'pairs'):.0f} pairs, {rendered:.0f} of them rendered; "
          f"it took {total(rows, 'seconds') / 60:.0f} min.\n")
    print("| | asked | " + "without a fault | with a fault |\n|---|---|---|---|")
    for label, asked, measure in MEASURES:
        print(f"| {label} | {asked} | {measure(clean)} | {measure(faulty)} |")
    print("\n## Without a fault, by property")
    print_table(clean, ["kind"] + PROPERTIES, False)
    print("\n## With a fault, by property")
    print_table(faulty, ["fault", "kind"] + PROPERTIES, True)
    print("\n## Worst seeds\n\nOne of them, pair by pair: `_b/devel/lib/arfm_vo/recordings OUTPUT --seed N --verbose`; as a KITTI "
          "folder: `--seed N --dump FOLDER`.\n")
    print("| seed | | recording | largest error / sigma |\n|---|---|---|---|")
    for part, column in ((clean, "lost"), (clean, "degraded"), (clean, "wrong"), (faulty, "wrong"), (faulty, "lost"),
                         (rows, "other_wrong")):
        print_worst(part, column)


main()
