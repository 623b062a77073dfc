"""A table of comma-separated values with the columns robot, tick and resource: where a robot is from that tick on.

Rows of a robot are in the order of time; one that repeats its resource changes nothing. An empty resource says that it
has left. The log ends at the largest tick.
"""

import csv
import re
from io import StringIO

from carp_spec import Instance, Plan, ResourceId, RobotId
from carp_spec.execution.traces import Trace
from carproof.formats.logs.cells import RIGHT_LOG
from carproof.formats.walks import require_bounded, visits_of

COLUMNS = ("robot", "tick", "resource")


def read(data: bytes, instance: Instance, file: str) -> Trace:
    """Read a table of an instance whose ids print differently."""
    robots = {str(id): id for id in instance.robot}
    resources = {str(id): id for id in instance.graph.index}
    rows = csv.DictReader(StringIO(data.decode("utf-8-sig", errors="replace")))
    if not {*COLUMNS} <= {*(rows.fieldnames or ())}:
        raise RIGHT_LOG.refuse(f"{file}:1", f"the line must name the columns {', '.join(COLUMNS)}")
    visits: dict[RobotId, list[tuple[ResourceId | None, int]]] = {}
    now = 0
    for number, row in enumerate(rows, start=2):
        require_bounded(number, file)
        if None in row:
            message = "the line must have no more values than the first has columns; a value with a comma is quoted"
            raise RIGHT_LOG.refuse(f"{file}:{number}", message)
        robot, tick, resource = (row[name] for name in COLUMNS)
        if robot is None or tick is None or resource is None or not re.fullmatch(r"\d{1,18}", tick.strip()):
            raise RIGHT_LOG.refuse(
                f"{file}:{number}", "the line must have a robot, a tick, which is a whole number, and a resource"
            )
        done = visits.setdefault(robots.get(robot.strip(), robot.strip()), [])
        if done and int(tick) < done[-1][1]:
            raise RIGHT_LOG.refuse(
                f"{file}:{number}", f"the tick must be at least {done[-1][1]}, that of the robot's line before"
            )
        now = max(now, int(tick))
        at = resources.get(resource.strip(), resource.strip()) if resource.strip() else None
        if not done or done[-1][0] != at:
            done.append((at, int(tick)))
    return Trace(now, tuple(Plan(robot, visits_of(entries)) for robot, entries in visits.items()))
