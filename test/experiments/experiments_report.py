#!/usr/bin/python3
"""Writes docs/experiments.md and its pictures from what scripts/measure.sh experiments has measured.

Usage: experiments_report.py WORK_DIR DOCS_DIR
Every figure and every verdict follows from the files in WORK_DIR.
"""
import csv
import os
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

STRATEGIES = ["surf", "surf_ransac", "surf_flann", "surf_flann_ransac"]
STRATEGY_NAMES = {"surf": "SURF", "surf_ransac": "SURF+RANSAC", "surf_flann": "SURF+FLANN",
                  "surf_flann_ransac": "SURF+FLANN+RANSAC"}
RUN_NAMES = {**{name: label + ", T 0.8" for name, label in STRATEGY_NAMES.items()},
             "paper_adaptive": "SURF+FLANN+RANSAC, T from variance",
             "paper_fixed_0.6": "SURF+FLANN+RANSAC, T 0.6", "best": "ours (config/arfm.yaml)"}
PAPER_RULE = "variance_over_mean_squared"
PAPER_ERROR_PERCENT, PAPER_SECONDS = 0.53, 7.25
PAPER_SEQUENCE = "04"
RATIO = 0.8  # of the comparison of methods
OTHERS_PICTURES = "_experiments"
COLORS = plt.rcParams["axes.prop_cycle"].by_key()["color"]


def show(source, docs, name, caption):
    """The lines that show a picture, which is copied beside the page; not there: none. Recordings are not ours to
    publish: their pictures, but for plots (.png), stay out of the repository, in a folder that git ignores."""
    if not os.path.exists(source):
        return []
    is_ours = "rendered" in name or name.endswith(".png")
    folder = os.path.join(docs, "experiments") if is_ours else OTHERS_PICTURES
    os.makedirs(folder, exist_ok=True)
    shutil.copy(source, os.path.join(folder, name))
    if is_ours:
        return [f"{caption}:\n\n![{caption}](experiments/{name})\n"]
    return [f"{caption}: `{OTHERS_PICTURES}/{name}`\n"]


class Matching:
    """The rows of matching.csv."""

    def __init__(self, path):
        with open(path) as stream:
            self.rows = list(csv.DictReader(stream))
        for row in self.rows:
            for key in ("points", "matches", "correct"):
                row[key] = int(row[key])
            row["ratio"], row["ms"] = float(row["ratio"]), float(row["ms"])
        self.sets = list(dict.fromkeys(row["set"] for row in self.rows))
        learnt = {row["set"] for row in self.rows if row["rule"] == "false_matches"}
        self.stereo = [name for name in self.sets if name in learnt]
        self.planar = [name for name in self.sets if name not in learnt]

    def check(self):
        """Without ratio test some points are always each other's nearest: a method that never has
        matches was not measured, and must not be judged."""
        for name in self.sets:
            for method in {row["method"] for row in self.select(experiment="method", set=name)}:
                if not any(row["matches"] for row in self.near(1, experiment="method", set=name,
                                                               method=method)):
                    sys.exit(f"experiments: {method} on {name} has no match at all: nothing is written")

    def select(self, **wanted):
        return [row for row in self.rows if all(row[key] == value for key, value in wanted.items())]

    def near(self, ratio, **wanted):
        return [row for row in self.select(**wanted) if abs(row["ratio"] - ratio) < 1e-6]


class Pairs:
    """Matches and right ones of the same kind, one value a pair."""

    def __init__(self, rows):
        self.matches = np.array([row["matches"] for row in rows], float)
        self.correct = np.array([row["correct"] for row in rows], float)
        self.ratio = np.array([row["ratio"] for row in rows])
        self.ms = np.array([row["ms"] for row in rows])

    def share(self):
        return self.correct.sum() / max(1, self.matches.sum())


def share_of(row):
    return row["correct"] / row["matches"] if row["matches"] else np.nan


def interval(values):
    """95 % interval of a statistic over resampled pairs, from its values."""
    low, high = np.percentile(values, [2.5, 97.5])
    return low, high


def resample(num, draws=1000):
    return np.random.default_rng(1).integers(0, num, (draws, num))


def share_interval(pairs):
    chosen = resample(len(pairs.matches))
    return interval(pairs.correct[chosen].sum(1) / np.maximum(1, pairs.matches[chosen].sum(1)))


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def save(figure, docs, name):
    figure.tight_layout()
    figure.savefig(os.path.join(docs, "experiments", name), dpi=75)
    plt.close(figure)
    return f"experiments/{name}"


def read_lines(path):
    """`key: value` lines as numbers."""
    values = {}
    if os.path.exists(path):
        for line in open(path):
            key, _, value = line.partition(":")
            try:
                values[key.strip()] = float(value)
            except ValueError:
                pass
    return values


def read_positions(path):
    return np.loadtxt(path).reshape(-1, 3, 4)[:, :, 3]


def read_timing(path):
    with open(path) as stream:
        return np.array([float(row["total_ms"]) for row in csv.DictReader(stream)])


# Fig. 5 ------------------------------------------------------------------------------------------


def curve_of(matching, name):
    ratios = sorted({row["ratio"] for row in matching.select(experiment="curve", set=name)})
    return ratios, [Pairs(matching.near(ratio, experiment="curve", set=name)) for ratio in ratios]


def draw_curves(matching, docs):
    figure, axes = plt.subplots(2, len(matching.sets), figsize=(2.6 * len(matching.sets), 5.2),
                                sharex=True, squeeze=False)
    for column, name in enumerate(matching.sets):
        pairs = list(dict.fromkeys(r["pair"] for r in matching.select(experiment="curve", set=name)))
        for pair in pairs:
            rows = matching.select(experiment="curve", set=name, pair=pair)
            ratios = [row["ratio"] for row in rows]
            adaptive = matching.select(experiment="rule", set=name, pair=pair, rule=PAPER_RULE)[0]
            line = axes[0][column].plot(ratios, [row["matches"] for row in rows], lw=1)[0]
            shares = [share_of(row) for row in rows]
            axes[1][column].plot(ratios, shares, lw=1, color=line.get_color())
            axes[0][column].plot(adaptive["ratio"], adaptive["matches"], "o", ms=4,
                                 color=line.get_color())
            axes[1][column].plot(adaptive["ratio"], share_of(adaptive), "o", ms=4,
                                 color=line.get_color())
        axes[0][column].set_title(name, fontsize=8)
        axes[1][column].set_xlabel("ratio threshold T")
        axes[1][column].set_ylim(0, 1.02)
    axes[0][0].set_ylabel("matches")
    axes[1][0].set_ylabel("share of right ones")
    return save(figure, docs, "fig05_ratio_threshold.png")


def write_curves(matching, docs, claims):
    picture = draw_curves(matching, docs)
    rows, grows, falls = [], True, True
    for name in matching.sets:
        ratios, curve = curve_of(matching, name)
        totals, shares = [c.matches.sum() for c in curve], [c.share() for c in curve]
        grows &= bool(np.all(np.diff(totals) >= 0))
        falls &= shares[-1] < shares[0]
        chosen = [c for r, c in zip(ratios, curve) if round(r, 2) in (0.4, 0.6, 0.8, 0.9, 1.0)]
        rows.append([name, len(curve[0].matches)] +
                    [f"{c.matches.mean():.0f}, {100 * c.share():.1f} %" for c in chosen])
    claims.append(["5", "a larger threshold gives more matches, a smaller share of them right",
                   "reproduced" if grows and falls else "not reproduced",
                   "matches grow with T on every set, the share of right ones falls from first to last T"
                   if grows and falls else "see the table"])
    return f"""## Fig. 5: matches against the ratio threshold

Lines: image pairs. Dots: where the paper's adaptive threshold (variance / mean²) falls. Exhaustive
search both ways, both keypoints each other's nearest.

![matches and share of right ones against T]({picture})

Matches a pair and the share of right ones, mean over the pairs:

""" + table(["set", "pairs", "T 0.4", "T 0.6", "T 0.8", "T 0.9", "no test"], rows)


# Figs 6, 7 ---------------------------------------------------------------------------------------


def gain_over_fixed(matching, names, rule):
    """Right matches more than a fixed threshold with the same share of right ones has, with its 95 %
    interval over resampled pairs; None where no fixed threshold has that share."""
    rule_pairs = Pairs([r for n in names for r in matching.select(experiment="rule", set=n, rule=rule)])
    ratios = sorted({row["ratio"] for row in matching.select(experiment="curve", set=names[0])})
    curve = [Pairs([r for n in names for r in matching.near(t, experiment="curve", set=n)])
             for t in ratios]

    def gain(chosen):
        share = rule_pairs.correct[chosen].sum() / max(1, rule_pairs.matches[chosen].sum())
        shares = np.array([c.correct[chosen].sum() / max(1, c.matches[chosen].sum()) for c in curve])
        correct = np.array([c.correct[chosen].sum() for c in curve])
        order = np.argsort(shares)
        fixed = np.interp(share, shares[order], correct[order])
        return rule_pairs.correct[chosen].sum() / max(1, fixed) - 1

    num = len(rule_pairs.matches)
    return gain(np.arange(num)), interval([gain(chosen) for chosen in resample(num, 300)])


def write_rules(matching, runs, work, docs, claims):
    text = ["## Figs 6, 7: adaptive against fixed thresholds"]
    verdicts = {}
    for title, names in (("rectified stereo", matching.stereo), ("homographies", matching.planar)):
        if not names:
            continue
        rules = list(dict.fromkeys(
            row["rule"] for row in matching.select(experiment="rule", set=names[0])))
        rows = []
        for rule in rules:
            pairs = Pairs([r for n in names for r in matching.select(experiment="rule", set=n, rule=rule)])
            low, high = share_interval(pairs)
            gain, (gain_low, gain_high) = gain_over_fixed(matching, names, rule)
            verdicts[title, rule] = gain_low, gain_high, pairs
            rows.append([rule, f"{pairs.ratio.mean():.2f} ± {pairs.ratio.std():.2f}",
                         f"{pairs.matches.mean():.0f}", f"{pairs.correct.mean():.0f}",
                         f"{100 * pairs.share():.1f} ({100 * low:.1f} .. {100 * high:.1f})",
                         f"{100 * gain:+.1f} ({100 * gain_low:+.1f} .. {100 * gain_high:+.1f})"])
        text.append(f"\n### On {title} ({', '.join(names)}; {len(pairs.matches)} pairs)\n")
        text.append(table(["rule of T", "T", "matches", "right", "share of right ones, %",
                           "right ones against a fixed T with the same share, %"], rows))
    text.append("\nIn brackets: 95 % interval over resampled pairs. The last column is the one that "
                "counts: any T trades number for share, so a rule helps only where it has more right "
                "matches than the fixed T that has its share.\n")
    claims.append(judge_adaptive(verdicts))
    text.append(answer_adaptive(verdicts, runs))
    for name in (matching.stereo[:1] + matching.planar[:1]):
        for kind in ("fixed_0.6", "adaptive"):
            file = f"{name}_{kind}.jpg"
            text += show(os.path.join(work, "pictures", file), docs, f"fig07_{file}",
                         f"{name}, {kind.replace('_', ' ')} (green right, red wrong)")
    return "\n".join(text)


def read_rule(config):
    """The rule of the threshold and the fixed ratio that a configuration sets."""
    keys = {}
    for line in open(os.path.join(os.path.dirname(__file__), "..", "..", "config", config)):
        key, _, value = line.partition(":")
        if key.strip() in ("rule", "fixed_ratio"):
            keys[key.strip()] = value.strip()
    return f"{keys['rule']} ({keys['fixed_ratio'] if keys['rule'] == 'fixed' else PAPER_RULE})"


def answer_adaptive(verdicts, all_runs):
    """The plain answer to the question whether an adaptive threshold helps."""
    words = []
    for (title, rule), (low, high, _) in verdicts.items():
        if not rule.startswith("fixed"):
            word = "helps" if low > 0 else "harms" if high < 0 else "makes no difference that can be told"
            words.append(f"* `{rule}` on {title}: {word}.")
    rows = []
    for name, runs in all_runs.items():
        errors = {run.config: run.values.get("t_rel_short_percent", np.nan) for run in runs}
        rows.append([name] + [f"{errors.get(config, np.nan):.2f}" for config in
                              ("paper_adaptive", "paper_fixed_0.6", "surf_flann_ransac")])
    return ("""### Does an adaptive threshold help?

By right matches against the fixed T of the same share:

""" + "\n".join(words) + """

By the odometry, mean translation error over 10 .. 50 m in %, all else the paper's:

""" + table(["sequence", "T from variance", "T 0.6", "T 0.8"], rows) + f"""

`config/arfm.yaml` uses the rule {read_rule("arfm.yaml")}, `config/arfm_paper.yaml` the rule
{read_rule("arfm_paper.yaml")}. What follows contrast instead is the number of points: each image gives
its strongest ones up to the number wanted.
""")


def judge_adaptive(verdicts):
    helps, parts = [], []
    for (title, rule), (low, high, pairs) in verdicts.items():
        if rule == PAPER_RULE:
            fixed = verdicts[title, "fixed 0.6"][2]
            more = pairs.correct.sum() > fixed.correct.sum() and pairs.share() >= fixed.share()
            helps.append(low > 0 or more)
            parts.append(f"{title}: {pairs.correct.mean():.0f} right matches of {pairs.matches.mean():.0f}"
                         f" against {fixed.correct.mean():.0f} of {fixed.matches.mean():.0f} at T 0.6")
    learnt = [v for (_, rule), v in verdicts.items() if rule == "false_matches"]
    if learnt:
        low, high, _ = learnt[0]
        word = "better than" if low > 0 else "worse than" if high < 0 else "no different from"
        parts.append(f"the rule that learns from surely wrong matches is {word} a fixed T "
                     f"({100 * low:+.1f} .. {100 * high:+.1f} %)")
    return ["6, 7", "the adaptive threshold (from the variance) finds more matches, more of them right, "
            "than T 0.6", "reproduced" if all(helps) else "not reproduced", "; ".join(parts)]


# Figs 8, 9 ---------------------------------------------------------------------------------------


def write_strategies(matching, work, docs, claims):
    rows, shares, speed = [], {}, {}
    for name in matching.sets:
        for strategy in STRATEGIES:
            pairs = Pairs(matching.select(experiment="strategy", set=name, strategy=strategy, rule="fixed"))
            shares[name, strategy] = pairs.share()
            speed[name, strategy] = np.median(pairs.ms)
            rows.append([name, STRATEGY_NAMES[strategy], f"{pairs.matches.mean():.0f}",
                         f"{pairs.correct.mean():.0f}", f"{100 * pairs.share():.1f}",
                         f"{np.median(pairs.ms):.1f}"])
    better = sum(shares[n, "surf_flann_ransac"] > shares[n, "surf_flann"] for n in matching.sets)
    best = sum(shares[n, "surf_flann_ransac"] >= max(shares[n, s] for s in STRATEGIES[:3])
               for n in matching.sets)
    num = len(matching.sets)
    faster = sum(speed[n, "surf_flann"] < speed[n, "surf"] for n in matching.sets)
    claims.append(["8, 9", "RANSAC raises the share of right matches",
                   "reproduced" if better == num else "not reproduced", f"on {better} of {num} sets"])
    claims.append(["8, 9", "SURF+FLANN+RANSAC has the largest share of the four",
                   "reproduced" if best == num else "not reproduced", f"on {best} of {num} sets"])
    claims.append(["8, 9", "FLANN is the faster search",
                   "reproduced" if faster == num else "not reproduced",
                   f"faster than our exhaustive search on {faster} of {num} sets, at 1000 points"])
    text = ["## Figs 8, 9: the four strategies\n", "At T 0.8, mean a pair; time of the matching alone. On graf what lies before the wall (the rail and "
            "the car at the lower edge) counts as wrong: the homography is the wall's.\n",
            table(["set", "strategy", "matches", "right", "share, %", "ms"], rows), ""]
    name = (matching.planar or matching.stereo)[0]
    for strategy in STRATEGIES:
        text += show(os.path.join(work, "pictures", f"{name}_{strategy}.jpg"), docs, f"fig08_{name}_{strategy}.jpg",
                     f"{name}, {STRATEGY_NAMES[strategy]}")
    return "\n".join(text)


# Figs 10, 11, 14 to 17 ---------------------------------------------------------------------------


class Run:
    """One run of the odometry."""

    def __init__(self, folder, config):
        self.config, self.folder = config, folder
        self.values = read_lines(os.path.join(folder, "lines"))
        self.ran = os.path.exists(os.path.join(folder, "poses.txt"))
        if not self.ran:
            return
        self.path = read_positions(os.path.join(folder, "poses.txt"))
        self.ms = read_timing(os.path.join(folder, "timing.csv"))
        truth = os.path.join(folder, "truth.txt")
        self.truth = read_positions(truth)[:len(self.path)] if os.path.exists(truth) else None

    def distance(self):
        return np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(self.truth, axis=0), axis=1))])

    def error(self):
        """Distance from the truth, m, both starting at the first pose."""
        return np.linalg.norm(self.path - self.truth, axis=1)

    def row(self):
        if not self.ran:
            return [RUN_NAMES[self.config]] + ["failed"] + ["-"] * 5
        end = 100 * self.error()[-1] / max(self.distance()[-1], 1e-9) if self.truth is not None else np.nan
        short = self.values.get("t_rel_short_percent", np.nan)
        return [RUN_NAMES[self.config], f"{self.values.get('lost', np.nan):.0f}",
                "-" if np.isnan(short) else f"{short:.2f}",
                f"{self.values.get('ate_rmse_m', np.nan):.3g}", f"{end:.2f}",
                f"{np.median(self.ms):.0f}", f"{self.values.get('cpu_ms_per_pair', np.nan):.0f}"]


def draw_runs(runs, sequence, docs, title):
    runs = [run for run in runs if run.ran]
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.2))
    if runs and runs[0].truth is not None:
        axes[0].plot(runs[0].truth[:, 0], runs[0].truth[:, 2], "k", lw=3, alpha=0.35, label="truth")
    for i, run in enumerate(runs):
        color, width = COLORS[i % len(COLORS)], 2 if run.config == "best" else 1
        axes[0].plot(run.path[:, 0], run.path[:, 2], color=color, lw=width, label=RUN_NAMES[run.config])
        if run.truth is not None:
            axes[1].plot(run.distance(), run.error(), color=color, lw=width)
        axes[2].plot(run.ms, color=color, lw=width)
    axes[0].set(xlabel="x, m", ylabel="z, m", title=title)
    spans = [np.ptp(run.path[:, axis]) for run in runs for axis in (0, 2)]
    if max(spans) < 5 * min(spans):
        axes[0].axis("equal")
    else:
        axes[0].set_title(title + " (scales differ)")
    axes[0].legend(fontsize=7)
    axes[1].set(xlabel="distance driven, m", ylabel="distance from the truth, m")
    axes[2].set(xlabel="pair", ylabel="ms a pair", yscale="log")
    return save(figure, docs, f"odometry_{sequence}.png")


RUN_HEADER = ["run", "lost", "short, %", "ATE, m", "end error, %", "ms a pair", "CPU ms a pair"]


def read_runs(work):
    root = os.path.join(work, "runs")
    return {name: [Run(os.path.join(root, name, config), config) for config in RUN_NAMES]
            for name in sorted(os.listdir(root))}


def write_odometry(all_runs, docs, claims):
    text = ["## Figs 10, 11: trajectories, error and time of the strategies\n",
            "short: mean translation error over 10 .. 50 m; ATE after alignment; end error of the distance "
            "driven; at most 100 pairs of each sequence. Times are those of this run of the command.\n"]
    best = []
    for name, runs in all_runs.items():
        if name.startswith("rendered"):
            continue
        picture = draw_runs(runs, name, docs, name)
        text += [f"### {name}\n", table(RUN_HEADER, [run.row() for run in runs]), "",
                 f"![trajectories, error, time]({picture})\n"]
        errors = {r.config: r.values.get("t_rel_short_percent", np.inf) for r in runs if r.ran}
        best.append(min(STRATEGIES, key=lambda s: errors.get(s, np.inf)) == "surf_flann_ransac")
    claims.append(["10, 11", "of the four strategies SURF+FLANN+RANSAC has the least translation error",
                   "reproduced" if best and all(best) else "not reproduced",
                   f"least on {sum(best)} of {len(best)} sequences; the pose has its own RANSAC, which does "
                   "the same work again"])
    return "\n".join(text)


def write_indoor(all_runs, work, docs, claims):
    name = "rendered_1624x1234"
    if name not in all_runs:
        return ""
    runs = all_runs[name]
    picture = draw_runs(runs, name, docs, "rendered, 1624x1234")
    claims.append(["14, 15", "indoor run of 6 pairs of 1624x1234", "not comparable",
                   "the paper's images are not public; a rendered terrain of the same size and number "
                   "stands for them"])
    text = ["## Figs 14, 15: 6 pairs of 1624x1234\n",
            "The paper's hall is not public. In its place: a rendered terrain with known truth.\n",
            table(RUN_HEADER, [run.row() for run in runs]), "", f"![trajectories]({picture})\n"]
    return "\n".join(text + copy_depths(work, docs, name))


def copy_depths(work, docs, name):
    return show(os.path.join(work, "pictures", f"{name}_depths.jpg"), docs, f"depths_{name}.jpg",
                "Features coloured by depth, red near to blue far")


def write_outdoor(all_runs, work, docs, claims):
    text = ["## Figs 16, 17: the outdoor run\n",
            f"The paper: {PAPER_ERROR_PERCENT} % after 100 m, {PAPER_SECONDS} s a pair.\n"]
    rows = []
    for name, runs in all_runs.items():
        for run in runs:
            if run.config not in ("best", "paper_adaptive") or not run.ran or run.truth is None:
                continue
            if name.startswith("rendered"):
                continue
            distance, error = run.distance(), run.error()
            end = 100 * error[-1] / distance[-1]
            rows.append([name, RUN_NAMES[run.config], f"{distance[-1]:.1f}", f"{error[-1]:.2f}",
                         f"{end:.2f}", f"{np.median(run.ms) / 1000:.3f}"])
            if run.config == "best":
                claims += judge_outdoor(name, distance[-1], end, np.median(run.ms) / 1000)
        if not name.startswith("rendered"):
            text += [f"{name}:\n"] + copy_depths(work, docs, name)
    text.insert(2, table(["sequence", "run", "driven, m", "error at the end, m", "error at the end, %",
                          "s a pair"], rows) + "\n\nTrajectories and error over distance are above.\n")
    return "\n".join(text)


def judge_outdoor(name, driven, end, seconds):
    is_papers = name == PAPER_SEQUENCE
    reached = end <= PAPER_ERROR_PERCENT
    error = ("reproduced" if reached else "not reproduced") if is_papers else "not comparable"
    why = "" if is_papers else f"the paper ran KITTI {PAPER_SEQUENCE}, this is {name}: "
    return [["17", f"error of {PAPER_ERROR_PERCENT} % of the way at the end", error,
             f"{why}{end:.2f} % of {driven:.0f} m"],
            ["17", f"{PAPER_SECONDS} s a pair", "reproduced" if seconds <= PAPER_SECONDS else "not reproduced",
             f"{seconds:.3f} s on {name}, {PAPER_SECONDS / seconds:.0f} times faster, on this machine"]]


# Figs 12, 13 -------------------------------------------------------------------------------------


def write_calibration(work, docs, claims):
    text, names = ["## Figs 12, 13: calibration\n"], []
    for name in sorted(os.listdir(os.path.join(work, "calibration"))):
        folder = os.path.join(work, "calibration", name)
        values = read_lines(os.path.join(work, "calibration_" + name))
        if not values:
            continue
        names.append(name)
        rows = [[key, f"{value:g}"] for key, value in values.items()]
        text += [f"### {name}\n", table(["", ""], rows), ""]
        if name.startswith("rendered"):
            text += compare_with_truth(values, read_lines(os.path.join(work, "calibration_truth")))
        for picture in ("coverage.png", "rectified.jpg"):
            text += show(os.path.join(folder, picture), docs, f"fig12_{name}_{picture}", os.path.splitext(picture)[0])
    if not any(name.startswith("rendered") for name in names):
        text.append("No rendered board: `render_board_set` is not built here.\n")
    claims.append(["12, 13", "calibration of the camera", "not comparable",
                   "the paper's camera is not here; " + (", ".join(names) or "no set") + " in its place"])
    return "\n".join(text)


def compare_with_truth(values, truth):
    """Rows for the values that the truth holds too."""
    rows = [[key, f"{truth[key]:g}", f"{values[key]:g}", f"{100 * (values[key] / truth[key] - 1):+.3f}"]
            for key in ("fx_left", "fx_right", "baseline_m") if truth.get(key) and key in values]
    return [table(["", "truth", "found", "off, %"], rows), ""] if rows else []


# Item 8 ------------------------------------------------------------------------------------------


def share_at(matching, name, method, num_correct):
    """Share of right matches at the threshold that gives so many right ones; nan if none does."""
    ratios = sorted({row["ratio"] for row in matching.select(experiment="method", set=name, method=method)})
    curve = [Pairs(matching.near(ratio, experiment="method", set=name, method=method)) for ratio in ratios]
    correct = [pairs.correct.sum() for pairs in curve]
    if num_correct > correct[-1]:
        return np.nan
    return np.interp(num_correct, correct, [pairs.share() for pairs in curve])


def draw_methods(matching, methods, docs):
    columns = (len(matching.sets) + 1) // 2
    figure, axes = plt.subplots(2, columns, figsize=(3.6 * columns, 6.4), squeeze=False)
    for axis, name in zip(axes.flat, matching.sets):
        for method in methods:
            ratios = sorted({r["ratio"] for r in matching.select(experiment="method", set=name, method=method)})
            curve = [Pairs(matching.near(t, experiment="method", set=name, method=method)) for t in ratios]
            line = axis.plot([c.correct.sum() for c in curve], [c.share() for c in curve], label=method,
                             lw=2 if method == "SURF" else 1)[0]
            at = next(c for t, c in zip(ratios, curve) if abs(t - RATIO) < 1e-6)
            axis.plot(at.correct.sum(), at.share(), "o", color=line.get_color())
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("right matches")
    for axis in axes[:, 0]:
        axis.set_ylabel("share of right ones")
    axes[0][0].legend(fontsize=7)
    for axis in list(axes.flat)[len(matching.sets):]:
        axis.axis("off")
    return save(figure, docs, "methods.png")


def write_methods(matching, docs, claims):
    methods = list(dict.fromkeys(row["method"] for row in matching.select(experiment="method")))
    rows, at, better = [], {}, {}
    for name in matching.sets:
        for method in methods:
            pairs = Pairs(matching.near(RATIO, experiment="method", set=name, method=method))
            at[name, method] = pairs
            rows.append([name, method, f"{pairs.matches.sum():.0f}", f"{pairs.correct.sum():.0f}",
                         f"{100 * pairs.share():.1f}", f"{np.median(pairs.ms):.1f}"])
    for other in ("cv::SIFT", "cv::ORB", "cv::AKAZE"):
        for name in matching.planar:
            ours, theirs = at[name, "SURF"], at[name, other]
            equal = share_at(matching, name, "SURF", theirs.correct.sum())
            better[other, name] = (ours.correct.sum() >= theirs.correct.sum() and
                                   ours.share() >= theirs.share())
            rows_entry = [other, name, f"{ours.correct.sum():.0f} : {theirs.correct.sum():.0f}",
                          f"{100 * ours.share():.1f} : {100 * theirs.share():.1f}",
                          "yes" if better[other, name] else "no",
                          f"{100 * equal:.1f} : {100 * theirs.share():.1f}"]
            at.setdefault("compared", []).append(rows_entry)
        if matching.planar:
            won = sum(better[other, name] for name in matching.planar)
            claims.append(["item 8", f"SURF has at least {other}'s right matches and share (T {RATIO})",
                           f"on {won} of {len(matching.planar)} sets", "same matcher, number of points "
                           "and threshold"])
    picture = draw_methods(matching, methods, docs)
    return f"""## Under hard changes: against cv::SIFT, cv::ORB and cv::AKAZE

Scale and rotation (boat), viewpoint (graf), light (leuven), blur (bikes), the road, and rendered
terrain with little texture and a low sun. The same matcher for all (cv::BFMatcher both ways, each
other's nearest, T {RATIO}), at most 1000 points an image; SURF, SIFT, ORB and AKAZE keep their strongest
points. `SURF` has two octaves; `SURF spread` is our default for odometry, three octaves with the points
spread over the image; `SURF as published` is without what we changed. Sums over the pairs of a set; ms: finding and describing, one image.

""" + table(["set", "method", "matches", "right", "share, %", "ms"], rows) + f"""

![right matches and share]({picture})

Lines: T from 0.5 to 1; dots: T {RATIO}. Ours against theirs:

""" + table(["against", "set", f"right, T {RATIO}", "share, %", "at least theirs in both",
             "share at their number of right ones, %"], at.get("compared", []))


def main():
    if {"--help", "-h"} & set(sys.argv):
        print(__doc__)
        return
    work, docs = sys.argv[1:3]
    Matching(os.path.join(work, "matching.csv")).check()
    shutil.rmtree(os.path.join(docs, "experiments"), ignore_errors=True)
    os.makedirs(os.path.join(docs, "experiments"))
    matching, runs, claims = Matching(os.path.join(work, "matching.csv")), read_runs(work), []
    sections = [write_curves(matching, docs, claims), write_rules(matching, runs, work, docs, claims),
                write_strategies(matching, work, docs, claims), write_odometry(runs, docs, claims),
                write_calibration(work, docs, claims), write_indoor(runs, work, docs, claims),
                write_outdoor(runs, work, docs, claims), write_methods(matching, docs, claims)]
    head = """# The paper's experiments, repeated

Written by `scripts/measure.sh experiments`; every figure, picture and verdict below comes from one run of it.
Right matches: by homography to 3 px on the oxford sets; on stereo pairs rows within 2 px and, where
dense stereo sees a disparity, within 3 px of it. `not comparable`: the paper's input is not there.

""" + table(["Fig.", "claim", "verdict", "measured"], claims)
    path = os.path.join(docs, "experiments.md")
    with open(path + ".new", "w") as stream:
        stream.write("\n\n".join([head] + [section for section in sections if section]) + "\n")
    os.rename(path + ".new", path)


if __name__ == "__main__":
    main()
