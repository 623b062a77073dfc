"""The rules of plans together: `joint/...` and `solution/...`."""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import groupby, pairwise
from operator import itemgetter
from typing import TypeAlias

from carp_spec.model import Group, Instance, Move, Plan, ResourceGraph, ResourceId, RobotId, Solution
from carp_spec.rule import DESIGN, MORS, Breach, Rule, Violation, of_robots, violation_rule

Change: TypeAlias = tuple[int, int, RobotId]
"""A tick at which a stay of the robot begins, with 1, or ends, with -1."""
TimedMove: TypeAlias = tuple[int, Move]


@violation_rule(
    "joint/capacity",
    "At no tick do more robots occupy a resource than its capacity. A robot occupies it from the tick at which it "
    "enters up to, not including, the tick at which it leaves.",
    f"paper, section II; {MORS}",
)
def capacity_is_kept(instance: Instance, plans: Iterable[Plan]) -> Iterator[Breach]:
    return _crowded(instance, plans, instance.graph.constraints[: len(instance.graph.resources)])


@violation_rule(
    "joint/group",
    "At no tick are more robots in the resources of a group than its capacity. A robot counts once, also while it "
    "moves within the group.",
    DESIGN,
)
def groups_are_kept(instance: Instance, plans: Iterable[Plan]) -> Iterator[Breach]:
    if instance.graph.groups:
        yield from _crowded(instance, plans, instance.graph.groups)


@violation_rule(
    "joint/following",
    "Where following is forbidden, at no tick are more robots in a resource or a group than its capacity; a robot that "
    "leaves it at tick t still counts at t. Where there is room for one, a robot enters only after a free tick.",
    DESIGN,
)
def following_is_avoided(instance: Instance, plans: Iterable[Plan]) -> Iterator[Breach]:
    if instance.following == "forbidden":
        more = ", with a free tick after each robot"
        yield from _crowded(instance, plans, instance.graph.constraints, instance.gap, more)


def _crowded(
    instance: Instance, plans: Iterable[Plan], constraints: Sequence[Group], gap: int = 0, more: str = ""
) -> Iterator[Breach]:
    """The constraints with too many robots if each stay lasts `gap` ticks longer, and where a robot is the first."""
    changes: dict[ResourceId, list[Change]] = defaultdict(list)
    for plan in plans:
        for visit in plan.visits:
            if visit.leave is None:
                changes[visit.resource].append((visit.enter, 1, plan.robot))
            elif visit.enter < visit.leave:
                changes[visit.resource] += [(visit.enter, 1, plan.robot), (visit.leave + gap, -1, plan.robot)]
    arrival = {robot: position for position, robot in enumerate(instance.robot)}
    for group in constraints:
        inside = [change for resource in group.resources for change in changes.get(resource, ())]
        if len({robot for _, _, robot in inside}) <= group.capacity:
            continue  # no more robots are ever in it than have room together
        for start, end, crowd in _crowds(group.capacity, inside):
            robots = tuple(sorted(crowd, key=arrival.__getitem__))
            at = next(each for each in group.resources if any(one[:2] == (start, 1) for one in changes.get(each, ())))
            of = "" if group.resources == (group.id,) else f" of group {group.id}"
            yield robots, at, start, end, f"capacity {group.capacity}{of}{more}"


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
    "No two robots make moves (r, s) and (s', r') at the same tick, whatever the capacities, where r is close to r' "
    "and s to s'. A robot makes the move (r, s) at the tick at which it leaves r and enters s. Resources are close if "
    "they are the same or lie in one group of capacity 1.",
    DESIGN,
)
def exchanges_are_avoided(instance: Instance, plans: Iterable[Plan]) -> Iterator[Breach]:
    graph, index = instance.graph, instance.graph.index
    movers: dict[TimedMove, list[RobotId]] = defaultdict(list)
    for plan in plans:
        for visit, following in pairwise(plan.visits):
            known = visit.resource in index and following.resource in index
            if known and visit.resource != following.resource:
                movers[following.enter, (visit.resource, following.resource)].append(plan.robot)

    def place(move: TimedMove) -> tuple[int, int, int]:
        return move[0], index[move[1][0]], index[move[1][1]]

    opposite = opposite_moves(graph, movers)
    pairs = ((one, other) for one in sorted(movers, key=place) for other in sorted(opposite(one), key=place))
    for one, other in pairs:
        robots = tuple(dict.fromkeys(movers[one] + movers[other])) if place(one) <= place(other) else ()
        if len(robots) > 1:
            tick, (source, target) = one
            to = f"{source} and {target}" if other[1] == (target, source) else f"{one[1]} and {other[1]}"
            yield robots, source, tick, tick + 1, f"they exchange {to} at tick {tick}"


def opposite_moves(graph: ResourceGraph, moves: Collection[TimedMove]) -> Callable[[TimedMove], Collection[TimedMove]]:
    """The moves at the same tick that lead from the areas that a move leads to into those that it leads from.

    They are in the order of the first areas that both share, and else in that of the moves.
    """
    if not graph.groups:
        return lambda move: [back] if (back := (move[0], move[1][::-1])) in moves else []
    areas = {each: dict.fromkeys(graph.areas_of(each)) for each in graph.index}
    leaving: dict[tuple[int, int], list[TimedMove]] = defaultdict(list)
    entering: dict[tuple[int, int], list[TimedMove]] = defaultdict(list)
    for move in moves:
        for of_areas, resource in zip((leaving, entering), move[1], strict=True):
            for area in areas[resource]:
                of_areas[move[0], area].append(move)

    def first(one: ResourceId, other: ResourceId) -> int:
        """The place of the first of the areas of one resource that another one shares."""
        return next(place for place, area in enumerate(areas[one]) if area in areas[other])

    def opposite(move: TimedMove) -> Collection[TimedMove]:
        tick, (source, target) = move
        sides = ((leaving, target), (entering, source))
        of_areas, near_to = min(
            sides, key=lambda side: sum(len(side[0].get((tick, area), ())) for area in areas[side[1]])
        )
        near = dict.fromkeys(each for area in areas[near_to] for each in of_areas.get((tick, area), ()))
        back = [each for each in near if graph.are_close(each[1][0], target) and graph.are_close(each[1][1], source)]
        return sorted(back, key=lambda each: (first(target, each[1][0]), first(source, each[1][1])))

    return opposite


JOINT_RULES: tuple[Rule[[Instance, Iterable[Plan]], Iterator[Violation]], ...] = (
    capacity_is_kept,
    groups_are_kept,
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
