"""The tables of docs/soak.md, of the samples that soak.py took."""
import numpy


def fit(rows, column):
    """Slope a 1,000 pairs, by least squares."""
    if len(rows) < 3:
        return float("nan")
    return numpy.polyfit([float(row["pairs"]) / 1000 for row in rows], [float(row[column]) for row in rows], 1)[0]


def table(title, *columns):
    print(f"\n{title}\n\n| {' | '.join(columns)} |\n|{'---|' * len(columns)}")


def summary(count, tracked, degraded, unanswered, seconds):
    print(f"{count} pairs in {seconds:.0f} s ({count / seconds:.1f} a second): {tracked} tracked, {degraded} degraded, "
          f"{unanswered} without an answer.")


def growth(rows, nodes, restart_from):
    table("Without restarts, from pair 2,000 on (growth a 1,000 pairs by a straight line through the samples):",
          "node", "pairs", "memory, MB", "growth", "files", "growth", "threads", "growth", "p50, ms", "p99, ms", "p99's growth")
    for name in nodes:
        mine = [row for row in rows if row["node"] == name and row["restarts"] == "0" and 2000 <= int(row["pairs"]) <= restart_from]
        if not mine:
            continue
        last = mine[-1]
        timed = [row for row in mine if row["p99_ms"] != "nan"]
        memory = fit(mine, "resident_mb")
        print(f"| {name} | {mine[0]['pairs']} .. {last['pairs']} | {mine[0]['resident_mb']} .. {last['resident_mb']} | {memory:+.3f} MB "
              f"({100 * memory / float(mine[0]['resident_mb']):+.2f} %) | {last['files']} | {fit(mine, 'files'):+.2f} | "
              f"{last['threads']} | {fit(mine, 'threads'):+.2f} | {last['p50_ms']} | {last['p99_ms']} | {fit(timed, 'p99_ms'):+.2f} |")


def waits(waits_by_event):
    table("Pairs until the next tracked one, the most:", "after", "pairs")
    for name, waited in sorted(waits_by_event.items()):
        print(f"| {name} | {waited} |")


def sizes(rows, topics):
    table("Largest messages, bytes, in the first and the last quarter of the pairs:", "topic", "first", "last")
    quarter = max(1, len(rows) // 4)
    for topic in topics:
        taken = [int(row[topic + "_bytes"]) for row in rows]
        print(f"| {topic} | {max(taken[:quarter])} | {max(taken[-quarter:])} |")
