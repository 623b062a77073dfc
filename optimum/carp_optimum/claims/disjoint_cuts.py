"""A lower bound by cuts alone: groups of robots, no robot in two, that cost more together than each does alone.

It begins with each robot by itself, on its cheapest plan. Groups whose plans conflict become one group, and its optimum
is searched for (`carp_optimum.sat.core_guided`), until no plans conflict or groups would be too large. The sum of the
groups' lower bounds is the bound. Searches for prices know goals alone, so this is the bound over stops. Source: the
independence detection of Standley 2010.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice

from carp_optimum.deadline import LOOKS, TimeOver, clock_of
from carp_optimum.sat.core_guided import core_guided
from carp_optimum.sat.proving import short_refutation
from carp_spec import Instance, Plan, RobotId, total_cost, violations_of
from carp_spec.documents.bounds import BOUND_FORMAT, BoundDocument, CutDocument
from carp_spec.documents.instances import digest
from carp_spec.joint_rules import JOINT_RULES
from carp_verify.bound.cuts import group_of
from carp_verify.optimum.encoding import beat_formula

LARGEST_GROUP = 8
MOST_MEETINGS = 10_000
"""Violations from which pairs of groups are taken, those of a capacity first.

The search ends if none of them is of such a pair.
"""
LONGEST_REFUTATION = 1_000_000  # characters


@dataclass(frozen=True, slots=True)
class Group:
    """Robots, the best plans of them that were found, if any, and the proof that they cost more than alone, if any."""

    robots: tuple[RobotId, ...]
    plans: Sequence[Plan]
    cut: CutDocument | None = None


def bound_by_cuts(
    instance: Instance, within: Callable[[], None], check: Callable[[int], None], on_step: Callable[[int, int], None]
) -> BoundDocument:
    """Search until nothing is gained any more, or until `check`, which gets the steps, raises `TimeOver`.

    So may `within`, which is called as the plans of single robots are found.
    A step is a group that is searched; `on_step` gets the steps and the bound so far, first the shortest paths alone.
    Robots that there is no time for claim a cost of 0.
    """
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415 - slow to load

    fleet = PlannedFleet(instance)
    shortest: dict[RobotId, int | None] = dict.fromkeys(instance.robot, 0)
    groups: list[Group] = []
    steps = 0

    def look() -> None:
        check(steps)

    try:
        for position, robot in enumerate(instance.robots):
            if position > 0:
                within()
            shortest[robot.id] = fleet.ticks_to_goal(position)
        on_step(0, _total(shortest, groups))
        for position, robot in enumerate(instance.robots):
            if position > 0:
                within()
            plan = fleet.find(position, None, 0)
            shortest[robot.id] = None if plan is None else total_cost(instance, [plan])
            if plan is not None:
                groups.append(Group((robot.id,), (plan,)))
        while pairs := _meetings(instance, groups, look):
            for pair in pairs:
                merged = _searched(instance, (*pair[0].robots, *pair[1].robots), look)
                groups = [*(each for each in groups if each not in pair), merged]
                steps += 1
                on_step(steps, _total(shortest, groups))
    except TimeOver:
        on_step(steps, _total(shortest, groups))
    cuts = tuple(group.cut for group in groups if group.cut is not None)
    cut = {robot for each in cuts for robot in each.robots}
    return BoundDocument(
        format=BOUND_FORMAT,
        instance=digest(instance),
        bound=_total(shortest, groups),
        scale=1,
        horizon=0,
        resources=(),
        exchanges=(),
        cuts=cuts,
        robots=tuple((robot, 0 if robot in cut else cost) for robot, cost in shortest.items()),
    )


def _total(shortest: dict[RobotId, int | None], groups: Sequence[Group]) -> int:
    rises = [each.cut.least - sum(shortest[robot] or 0 for robot in each.robots) for each in groups if each.cut]
    return sum(cost or 0 for cost in shortest.values()) + sum(rises)


def _meetings(instance: Instance, groups: Sequence[Group], look: Callable[[], None]) -> list[tuple[Group, Group]]:
    """Pairs of groups whose plans conflict and that are not too large together, small ones first; no group is in two.

    One judgement of all plans, each of which is lawful, finds the pairs that may conflict: 1,000 robots have half a
    million pairs.
    """

    def watched() -> Iterator[Plan]:
        for plan in plans:
            look()
            yield plan

    number = {robot: position for position, group in enumerate(groups) for robot in group.robots}
    near: set[tuple[int, int]] = set()
    plans = [plan for each in groups if len(each.robots) < LARGEST_GROUP for plan in each.plans]
    found = (violation for rule in JOINT_RULES for violation in rule(instance, watched()))
    for violation in islice(found, MOST_MEETINGS):
        near.update(combinations(sorted({number[robot] for robot in violation.robots}), 2))
        look()
    sizes = [len(each.robots) for each in groups]
    pairs: list[tuple[Group, Group]] = []
    taken: set[int] = set()
    for first, second in sorted(near, key=lambda pair: (sizes[pair[0]] + sizes[pair[1]], *pair)):
        one, other = groups[first], groups[second]
        is_free = sizes[first] + sizes[second] <= LARGEST_GROUP and taken.isdisjoint((first, second))
        look()
        if is_free and violations_of(instance, (*one.plans, *other.plans)):
            taken.update((first, second))
            pairs.append((one, other))
    return pairs


def _searched(instance: Instance, robots: tuple[RobotId, ...], check: Callable[[], None]) -> Group:
    """The group with its best plans and its cut; its plans are none where it has none."""
    group = group_of(instance, robots)
    best = core_guided(group, LOOKS, clock_of(check), watch=check)
    check()
    plans = () if best.solution is None else best.solution.plans
    if best.shortest is None or best.lower <= best.shortest:
        return Group(robots, plans)
    evidence = best.evidence
    lines = short_refutation(lambda: beat_formula(group, best.lower, evidence).formula, check, LONGEST_REFUTATION)
    cut = CutDocument(robots, best.lower, 1, evidence.horizons, evidence.order, lines) if lines else None
    return Group(robots, plans, cut)
