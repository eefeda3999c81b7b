"""The tables of docs/fault_campaign.md."""
import statistics

from fault import EITHER

WATCH_S = 3.0  # after the fault or its limit


def tables(rows):
    """By the names of their sections."""
    stops = [1000 * (row["stop_s"] - row["limit_s"]) for row in rows if not row["drives_on"] and row["promise"] != EITHER]
    summary = ["| | |", "|---|---|",
               "| faults, as promised | %d, %d |" % (len(rows), sum(row["kept"] for row in rows)),
               "| false arrivals | %d |" % sum(row["arrived"] for row in rows),
               "| motions without command or warning | %d |" % sum(row["unwarned"] for row in rows),
               "| distance by a wrong pose, worst, m | %.2f |" % max(row["wrong_way_m"] for row in rows)]
    if stops:
        summary.append("| stop after the fault or its limit, median and worst, ms | %.0f, %.0f |" % (statistics.median(stops), max(stops)))
    lines = ["| fault | promised | reported | limit, s | stop, ms | distance, m | by a wrong pose, m | resumes | as promised |", "|" + "---|" * 9]
    for row in rows:
        drives_on = row["drives_on"]
        lines.append("| %s | %s | %s | %s | %s | %.2f | %.2f | %s | %s |" % (
            row["name"], row["promise"], "; ".join(row["told"]), "%.1f" % row["limit_s"] if row["limit_s"] else "",
            "" if drives_on else "%.0f" % (1000 * row["stop_s"]), row["way_m"], row["wrong_way_m"],
            row["go_on"], "yes" if row["kept"] else "NO"))
    return {"summary": "\n".join(summary), "rows": "\n".join(lines)}
