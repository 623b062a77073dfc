"""A table of comma-separated values with the columns robot, tick and resource: where a robot is from that tick on.

Rows of a robot are in the order of time; one that repeats its resource changes nothing. An empty resource says that it
has left. The log ends at the largest tick.
"""

import re

from carp_spec import Instance, Plan, ResourceId, RobotId
from carp_spec.documents.decoding import MOST_DIGITS
from carp_spec.execution.traces import Trace
from carproof.csv_rows import named, rows_of
from carproof.formats.logs.cells import RIGHT_LOG
from carproof.formats.plans.checks import ids_by_text
from carproof.formats.walks import require_bounded, visits_of

COLUMNS = ("robot", "tick", "resource")


def read(text: str, instance: Instance, file: str) -> Trace:
    """Read a table of an instance whose ids print differently."""
    robots, resources = ids_by_text(instance, RIGHT_LOG)
    if "" in resources:
        raise RIGHT_LOG.refuse("INSTANCE", "no id of a resource may be empty, which says that a robot has left")
    visits: dict[RobotId, list[tuple[ResourceId | None, int]]] = {}
    now = 0
    for line, row in rows_of(text, file, RIGHT_LOG, COLUMNS):
        require_bounded(line, file)
        robot, tick = named(row["robot"], robots), row["tick"].strip()
        if robot == "" or not re.fullmatch(rf"\d{{1,{MOST_DIGITS}}}", tick):
            raise RIGHT_LOG.refuse(
                f"{file}:{line}", "the line must have a robot, a tick, which is a whole number, and a resource"
            )
        done = visits.setdefault(robot, [])
        if done and int(tick) < done[-1][1]:
            raise RIGHT_LOG.refuse(
                f"{file}:{line}", f"the tick must be at least {done[-1][1]}, that of the robot's line before"
            )
        now = max(now, int(tick))
        found = named(row["resource"], resources)
        at = None if found == "" else found
        if not done or done[-1][0] != at:
            done.append((at, int(tick)))
    return Trace(now, tuple(Plan(robot, visits_of(entries)) for robot, entries in visits.items()))
