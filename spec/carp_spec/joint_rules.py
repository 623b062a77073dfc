"""The rules of plans together: `joint/...` and `solution/...`."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, pairwise
from operator import itemgetter
from typing import TypeAlias

from carp_spec.model import Instance, Move, Plan, ResourceId, RobotId, Solution
from carp_spec.rule import DESIGN, MORS, Breach, Rule, Violation, of_robots, violation_rule

Change: TypeAlias = tuple[int, int, RobotId]
"""A tick at which a stay of the robot begins, with 1, or ends, with -1."""


@violation_rule(
    "joint/capacity",
    "At no tick do more robots occupy a resource than its capacity. A robot occupies it from the tick at which it "
    "enters up to, not including, the tick at which it leaves.",
    f"paper, section II; {MORS}",
)
def capacity_is_kept(instance: Instance, plans: Sequence[Plan]) -> Iterator[Breach]:
    return _crowded(instance, plans)


@violation_rule(
    "joint/following",
    "Where following is forbidden, at no tick are more robots in a resource than its capacity; a robot that leaves at "
    "tick t still counts at t. Where there is room for one, a robot enters only after a free tick.",
    DESIGN,
)
def following_is_avoided(instance: Instance, plans: Sequence[Plan]) -> Iterator[Breach]:
    if instance.following == "forbidden":
        yield from _crowded(instance, plans, instance.gap, ", with a free tick after each robot")


def _crowded(instance: Instance, plans: Sequence[Plan], gap: int = 0, more: str = "") -> Iterator[Breach]:
    """The resources that are too full if each stay lasts `gap` ticks longer."""
    changes: dict[ResourceId, list[Change]] = defaultdict(list)
    for plan in plans:
        for visit in plan.visits:
            if visit.leave is None:
                changes[visit.resource].append((visit.enter, 1, plan.robot))
            elif visit.enter < visit.leave:
                changes[visit.resource] += [(visit.enter, 1, plan.robot), (visit.leave + gap, -1, plan.robot)]
    arrival = {robot: position for position, robot in enumerate(instance.robot)}
    for resource in instance.graph.resources:
        for start, end, crowd in _crowds(resource.capacity, changes[resource.id]):
            robots = tuple(sorted(crowd, key=arrival.__getitem__))
            yield robots, resource.id, start, end, f"capacity {resource.capacity}{more}"


def _crowds(capacity: int, changes: list[Change]) -> Iterator[tuple[int, int | None, set[RobotId]]]:
    """The maximal intervals with too many robots at each tick, and all robots present at one of them."""
    stays: Counter[RobotId] = Counter()
    crowd: set[RobotId] = set()
    start: int | None = None
    for tick, at_tick in groupby(sorted(changes, key=itemgetter(0)), key=itemgetter(0)):
        changing = set()
        for _, change, robot in at_tick:
            changing.add(robot)
            stays[robot] += change
            if not stays[robot]:
                del stays[robot]
        if len(stays) <= capacity:
            if start is not None:
                yield start, tick, crowd
            start = None
        elif start is None:
            start, crowd = tick, set(stays)
        else:
            crowd |= changing
    if start is not None:
        yield start, None, crowd


@violation_rule(
    "joint/exchange",
    "No two robots make the moves (r, s) and (s, r) at the same tick, whatever the capacities. A robot makes the move "
    "(r, s) at the tick at which it leaves r and enters s.",
    DESIGN,
)
def exchanges_are_avoided(instance: Instance, plans: Sequence[Plan]) -> Iterator[Breach]:
    movers: dict[tuple[int, Move], list[RobotId]] = defaultdict(list)
    for plan in plans:
        for visit, following in pairwise(plan.visits):
            if visit.resource in instance.graph.index and following.resource in instance.graph.index:
                movers[following.enter, (visit.resource, following.resource)].append(plan.robot)
    index = instance.graph.index
    met = [(tick, move) for tick, move in movers if index[move[0]] < index[move[1]] and (tick, move[::-1]) in movers]
    for tick, (source, target) in sorted(met, key=lambda key: (key[0], index[key[1][0]], index[key[1][1]])):
        robots = tuple(dict.fromkeys(movers[tick, (source, target)] + movers[tick, (target, source)]))
        if len(robots) > 1:
            yield robots, source, tick, tick + 1, f"they exchange {source} and {target} at tick {tick}"


JOINT_RULES: tuple[Rule[[Instance, Sequence[Plan]], Iterator[Violation]], ...] = (
    capacity_is_kept,
    exchanges_are_avoided,
    following_is_avoided,
)


@violation_rule(
    "solution/covers",
    "Each robot of the instance has exactly one plan or is listed once as unplanned, not both, and no robot that the "
    "instance does not have is named.",
    DESIGN,
)
def solution_covers_robots(instance: Instance, solution: Solution) -> Iterator[Breach]:
    planned = Counter(plan.robot for plan in solution.plans)
    unplanned = Counter(solution.unplanned)
    for robot in dict.fromkeys([*instance.robot, *planned, *unplanned]):
        has = f"{planned[robot]} and {unplanned[robot]}"
        if robot not in instance.robot:
            yield of_robots([robot], "the instance has no such robot")
        elif planned[robot] + unplanned[robot] != 1:
            yield of_robots([robot], f"it must have one plan or be unplanned once, and has {has}")


@violation_rule(
    "solution/order", "The planning order names each robot that has a plan exactly once, and no other robot.", DESIGN
)
def solution_orders_plans(instance: Instance, solution: Solution) -> Iterator[Breach]:
    del instance
    return misnamed("order", solution.order, solution)


def misnamed(what: str, names: Iterable[RobotId], solution: Solution) -> Iterator[Breach]:
    """The robots with a plan that are not named once, and those without that are named."""
    planned = dict.fromkeys((plan.robot for plan in solution.plans), 1)
    named = Counter(names)
    for robot in planned | named:
        if named[robot] != planned.get(robot, 0):
            right = "once" if robot in planned else "never"
            yield of_robots([robot], f"the {what} must name it {right}, and names it {named[robot]} times")


SOLUTION_RULES: tuple[Rule[[Instance, Solution], Iterator[Violation]], ...] = (
    solution_covers_robots,
    solution_orders_plans,
)
