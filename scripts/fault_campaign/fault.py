"""A row of the campaign."""
import dataclasses
from typing import Callable


class NotPermitted(Exception):
    """The machine does not let this fault be injected."""


@dataclasses.dataclass
class Fault:
    name: str
    inject: Callable
    promise: str  # reasons of drive_status, any of them with " or ", "drives on", or "-" where nobody is left to tell one
    mend: Callable = lambda campaign: None
    limit_s: float = 0.0
    ends_graph: bool = False  # nothing can be asked of the graph afterwards
    is_load: bool = False  # holds the campaign itself up
    is_well: Callable = lambda campaign: True  # what else must hold when the rover has been watched
