"""A row of the campaign."""
import dataclasses
from typing import Callable

from rover import UNCERTAIN


class NotPermitted(Exception):
    """The machine does not let this fault be injected."""


EITHER, BY_ITSELF = "drives on, or stops and says why", "by itself, with a warning"
HELD_UP = "chassis_node was held up"
# What pauses a drive (docs/rover.md): it goes on by itself, with a warning, where the pose is good again within 3 s.
PAUSES = {UNCERTAIN, "pose is stale", "no pose", "pose is invalid", "camera's exposure has not settled",
          "odometry does not tell its epoch", "map frame is no longer told", HELD_UP}


@dataclasses.dataclass
class Fault:
    name: str
    inject: Callable
    promise: str  # reasons of drive_status, any of them with " or ", "drives on", EITHER, or "-": nobody is left to tell one
    mend: Callable = lambda campaign: None
    limit_s: float = 0.0
    ends_graph: bool = False  # nothing can be asked of the graph afterwards
    is_load: bool = False  # holds the campaign itself up
    ends_node: bool = False  # ends the process of a node
    by_velocity: bool = False  # the rover is driven by cmd_vel, not to a goal
    may_go_on: bool = False  # where it only pauses the drive: poses come again while the rover is still watched
    max_wrong_way_m: float = 0.10  # of the tracks while the pose that is told is wrong
    is_well: Callable = lambda campaign: True  # what else must hold when the rover has been watched
