"""Walks over cells, tick by tick: the common semantics of all text formats of other planners.

They are walks of classical multi-agent path finding (MAPF): every robot is present from tick 0, moves or waits in each
tick, and stays at its goal for ever. Following and rotations are allowed, swaps are not, and a move takes one tick.
carproof's rules mean the same for an instance with `park` and with durations and capacities of one; other values of an
instance take precedence. Waiting at the end of a walk is part of one visit for ever. The checker reports a cell that
the instance does not have, a jump, and a walk that does not end at the goal.
"""

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

from carp_spec import Instance, Plan, Refusal, ResourceId, RobotId, Rule, Solution, Visit, judge
from carp_spec.rule import DESIGN, rule
from carproof.generate.grid import cell_id

Cell: TypeAlias = tuple[int, int]
Walk: TypeAlias = Sequence[tuple[Cell, int]]
"""Cells, each with a tick at which the robot is there; the ticks rise, and the robot stays between them."""

MOST_CELLS = 60_000_000
"""A log of 50 million takes 9 GB while it is judged, and more than 18 GB if it breaks a rule."""


@rule(
    "adapter/instance",
    "Walks over cells are of an instance in which robots park and are released at 0, and in which every resource has "
    "a position of its own.",
    DESIGN,
)
def instance_has_walks(instance: Instance) -> bool:
    """Whether plans of the instance can be walks over cells."""
    positions = {(each.x, each.y) for each in instance.graph.resources if each.x is not None and each.y is not None}
    all_there = all(robot.release == 0 for robot in instance.robots)
    return instance.after_goal == "park" and all_there and len(positions) == len(instance.graph.resources)


@rule("adapter/size", f"Walks have at most {MOST_CELLS} cells together, waiting counted tick by tick.", DESIGN)
def walks_are_bounded(cells: int) -> bool:
    """Whether this many cells fit in memory."""
    return cells <= MOST_CELLS


@rule(
    "adapter/solution",
    "A solution is written in a format of other tools only if it breaks no rule, and without unplanned robots where "
    "the format has no place for them.",
    DESIGN,
)
def solution_has_walks(instance: Instance, solution: Solution, partial: bool) -> bool:
    """Whether the solution can be written; `partial` formats can leave robots out."""
    return judge(instance, solution).valid and (partial or not solution.unplanned)


WALK_RULES: tuple[Rule[..., Any], ...] = (instance_has_walks, walks_are_bounded, solution_has_walks)


def require_walks(instance: Instance) -> None:
    """Raise `Refusal` if the instance is not one of walks."""
    if not instance_has_walks(instance):
        message = "robots must park and be released at 0, and every resource must have a position of its own"
        raise Refusal("document", "INSTANCE", instance_has_walks.id, message)


def require_bounded(cells: int, where: str) -> None:
    """Raise `Refusal` if there are too many cells."""
    if not walks_are_bounded(cells):
        message = f"the walks must have at most {MOST_CELLS} cells together, and have {cells}"
        raise Refusal("limit", where, walks_are_bounded.id, message)


def solution_of_walks(instance: Instance, walks: Mapping[RobotId, Walk]) -> Solution:
    """The solution in which robots make these walks; a robot without a walk is unplanned."""
    require_walks(instance)
    name = namer(instance)
    plans = (Plan(id, _visits(walks[id], name)) for id in instance.robot if id in walks)
    return Solution.of(instance, plans)


def namer(instance: Instance) -> Callable[[Cell], ResourceId]:
    """What names cells: each by the resource there, or, where there is none, by an id that no resource has."""
    resources = {(each.x, each.y): each.id for each in instance.graph.resources}

    def name_of(cell: Cell) -> ResourceId:
        if cell in resources:
            return resources[cell]
        name = cell_id(*cell)
        while name in instance.graph.resource:
            name += "'"
        return name

    return name_of


def _visits(walk: Walk, name: Callable[[Cell], ResourceId]) -> tuple[Visit, ...]:
    entries = [walk[at] for at in range(len(walk)) if at == 0 or walk[at][0] != walk[at - 1][0]]
    return visits_of([(name(cell), tick) for cell, tick in entries])


def visits_of(entries: Sequence[tuple[ResourceId | None, int]]) -> tuple[Visit, ...]:
    """The visits of a robot that enters these resources at these ticks, and none from a tick on without a resource."""
    ends: list[int | None] = [*(tick for _, tick in entries[1:]), None]
    return tuple(Visit(at, tick, end) for (at, tick), end in zip(entries, ends, strict=True) if at is not None)


def walks_of_solution(instance: Instance, solution: Solution, *, partial: bool) -> Mapping[RobotId, Walk]:
    """The walk of each plan, with each visit once; raises `Refusal` if the format cannot hold the solution."""
    require_walks(instance)
    if not solution_has_walks(instance, solution, partial):
        wrong = [str(each) for each in judge(instance, solution).violations]
        what = f"it breaks a rule: {wrong[0]}" if wrong else f"it leaves robots unplanned: {len(solution.unplanned)}"
        raise Refusal("document", "SOLUTION", solution_has_walks.id, f"the format cannot hold it: {what}")
    plans = {plan.robot: plan for plan in solution.plans}
    return {
        id: [(cell_of(instance, each.resource), each.enter) for each in plans[id].visits]
        for id in instance.robot
        if id in plans
    }


def cell_of(instance: Instance, id: ResourceId) -> Cell:
    """The position of a resource that has one."""
    resource = instance.graph.resource[id]
    return (resource.x or 0, resource.y or 0)


def tick_by_tick(walks: Mapping[RobotId, Walk]) -> Mapping[RobotId, Sequence[Cell]]:
    """The cell of each robot at each tick up to its arrival."""
    require_bounded(sum(walk[-1][1] + 1 for walk in walks.values()), "SOLUTION")
    return {
        robot: [*(cell for (cell, enter), (_, leave) in pairwise(walk) for _ in range(enter, leave)), walk[-1][0]]
        for robot, walk in walks.items()
    }


def last_arrival(cells: Mapping[RobotId, Sequence[Cell]]) -> int:
    """The tick at which the last robot arrives, 0 without robots; `cells` are those of each robot tick by tick."""
    return max((len(each) - 1 for each in cells.values()), default=0)
