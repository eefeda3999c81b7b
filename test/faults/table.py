"""docs/fault_campaign.md."""
import math
import statistics

from fault import EITHER
from rover import COMMANDED_S
from sight import MAX_ERROR_M, MAX_ERROR_RAD

WATCH_S = 3.0  # after the fault or its limit


def table(rows):
    stops = [1000 * (row["stop_s"] - row["limit_s"]) for row in rows if not row["drives_on"] and row["promise"] != EITHER]
    lines = ["# Faults in the running graph", "",
             "Made by `scripts/measure.sh fault_campaign`: `simulation.launch` as a user starts it, in real time, with an operator",
             "who answers; the bus runs through a tap that notes every command by the steady clock. The rover drives at",
             "0.1 m/s when the fault comes. *Stop* is from the fault to the last frame that moves; the way is that of the",
             "tracks, their own inertia included, until it moves on by good poses, with a warning, or until",
             "%g s after the limit. *Wrong way* is the part of it in which the newest pose that tf told was more than %.2f m or" %
             (WATCH_S, MAX_ERROR_M),
             "%.0f degrees off the truth, whoever told it. Limits are in simulated time, which rendering holds back; they stand" %
             math.degrees(MAX_ERROR_RAD),
             "here in wall time. In each row no node ends that is not ended on purpose, and every motion was commanded within",
             "%g s or warned of." % COMMANDED_S,
             "The camera's node and the CAN adapter of a real rover are not in this graph: here their faults are those of topics",
             "and of UDP ports; on the kernel's own V4L2 and SocketCAN they are in [hardware_faults.md](hardware_faults.md).", "",
             "| | |", "|---|---|",
             "| faults, as promised | %d, %d |" % (len(rows), sum(row["kept"] for row in rows)),
             "| false arrivals | %d |" % sum(row["arrived"] for row in rows),
             "| motions without command or warning | %d |" % sum(row["unwarned"] for row in rows),
             "| way on a wrong pose, worst, m | %.2f |" % max(row["wrong_way_m"] for row in rows)]
    if stops:
        lines.append("| stop after the fault or its limit, median and worst, ms | %.0f, %.0f |" % (statistics.median(stops), max(stops)))
    lines += ["", "| fault | promised | told | limit, s | stop, ms | way, m | wrong way, m | to go on | as promised |", "|" + "---|" * 9]
    for row in rows:
        drives_on = row["drives_on"]
        lines.append("| %s | %s | %s | %s | %s | %.2f | %.2f | %s | %s |" % (
            row["name"], row["promise"], "; ".join(row["told"]), "%.1f" % row["limit_s"] if row["limit_s"] else "",
            "" if drives_on else "%.0f" % (1000 * row["stop_s"]), row["way_m"], row["wrong_way_m"],
            row["go_on"], "yes" if row["kept"] else "NO"))
    return "\n".join(lines) + "\n"
