"""A table of plans: comma-separated values with the columns robot, resource, enter, leave and serves.

A row is a visit; rows of a robot are in order. An empty `leave` is for ever. Robots are in the order of planning, and
those without rows are unplanned. `serves` is the number of the stop that is served, from 1; it is not read, and columns
may be added.
"""

import csv
import re
from io import StringIO
from itertools import chain

from carp_spec import Instance, Plan, RobotId, Solution, Visit
from carp_spec.documents.decoding import MOST_DIGITS
from carp_spec.rule import DESIGN
from carproof.csv_rows import named, rows_of
from carproof.formats.adapter import Adapter, first_line
from carproof.formats.plans.checks import ids_by_text, require_lawful
from carproof.formats.plans.services import stops_in
from carproof.formats.walks import require_bounded
from carproof.input_rules import Code

COLUMNS = ("robot", "resource", "enter", "leave")
_TICK = re.compile(rf"\d{{1,{MOST_DIGITS}}}")
RIGHT_TABLE = Code(
    "adapter/csv",
    "A table of plans has the columns robot, resource, enter and leave. A row has a robot, a resource, the tick at "
    "which it enters, and that at which it leaves, or nothing if it stays for ever. Ids of the instance print "
    "differently, are not empty and have no carriage return.",
    DESIGN,
)


def read(text: str, instance: Instance, file: str) -> Solution:
    """Read a table; ids that the instance does not have are left to the rules of plans."""
    robots, resources = ids_by_text(instance, RIGHT_TABLE)
    visits: dict[RobotId, list[Visit]] = {}
    for line, row in rows_of(text, file, RIGHT_TABLE, COLUMNS):
        require_bounded(line, file)
        enter, leave = (row[name].strip() for name in ("enter", "leave"))
        robot, resource = named(row["robot"], robots), named(row["resource"], resources)
        if "" in (robot, resource) or not _TICK.fullmatch(enter) or not (leave == "" or _TICK.fullmatch(leave)):
            message = (
                "the row must have a robot, a resource, and whole numbers of ticks, the last of which may be left out"
            )
            raise RIGHT_TABLE.refuse(f"{file}:{line}", message)
        visit = Visit(resource, int(enter), int(leave) if leave else None)
        visits.setdefault(robot, []).append(visit)
    return Solution.of(instance, (Plan(robot, tuple(each)) for robot, each in visits.items()))


def write(instance: Instance, solution: Solution) -> str:
    """Write a table; raises `Refusal` if the solution breaks a rule or the table cannot hold its ids."""
    require_lawful(instance, solution)
    for name in chain(*ids_by_text(instance, RIGHT_TABLE)):
        if not name or "\r" in name:
            raise RIGHT_TABLE.refuse("INSTANCE", f"the id {name!r} must not be empty, and must have no carriage return")
    plans = {plan.robot: plan for plan in solution.plans}
    text = StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow((*COLUMNS, "serves"))
    for id in solution.order:
        serves = stops_in(instance, plans[id])
        for place, visit in enumerate(plans[id].visits):
            leave = "" if visit.leave is None else visit.leave
            stop = serves[place] + 1 if place in serves else ""
            rows.writerow((id, visit.resource, visit.enter, leave, stop))
    return text.getvalue()


def _looks_like(text: str) -> bool:
    return {*COLUMNS} <= {each.strip('" ') for each in first_line(text).removeprefix("\ufeff").split(",")}


ADAPTER = Adapter("csv", f"a table with the columns {', '.join(COLUMNS)}, for every instance", _looks_like, read, write)
