"""The rules of a certificate of a query: `query-certificate/...`."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from carp_spec import Instance, Plan, ResourceId, RobotId, Rule
from carp_spec.plan_rules import PLAN_RULES
from carp_spec.rule import DESIGN, rule

LARGEST_CHECK = 50_000_000


@rule(
    "query-certificate/plans",
    "The plans beside which a robot is planned, and the one that it has followed, are of different robots of the "
    "instance, and each by itself breaks no rule plan/...",
    DESIGN,
)
def plans_are_lawful(instance: Instance, plans: Sequence[Plan]) -> bool:
    """Whether each plan is lawful, and no robot has two."""
    robots = {plan.robot for plan in plans}
    known = len(robots) == len(plans) and robots <= instance.robot.keys()
    return known and not any(violation for each in PLAN_RULES for plan in plans for violation in each(instance, plan))


@rule("query-certificate/robot", "The robot of a query certificate is one of the instance.", DESIGN)
def robot_is_known(instance: Instance, robot: RobotId) -> bool:
    """Whether the instance has the robot."""
    return robot in instance.robot


@rule(
    "query-certificate/bound",
    "Where the robot's plan has ended by now, and the plans of the others leave room for it, the bound is no later "
    "than its arrival.",
    DESIGN,
)
def is_no_later(bound: int | None, arrival: int) -> bool:
    """Whether the bound is no later than the arrival; `None` is never."""
    return bound is not None and bound <= arrival


@rule(
    "query-certificate/stops",
    "There are labels and a potential for each number of stops that the robot can have served, of those left at now, "
    "before it serves the last one.",
    DESIGN,
)
def fits_stops(layers: int, stops: int) -> bool:
    """Whether so many pairs of labels and a potential fit so many stops that are left."""
    return layers == stops


@rule(
    "query-certificate/potential",
    "The potential of the goal is 0, once only the last stop is left. Where a move leads from r to s, and s has a "
    "potential, r has one too: no more than that of s and the ticks that the robot needs in r. Where a stop served has "
    "a potential, it has one before: no more than that and the ticks by which its service is longer than the duration.",
    DESIGN,
)
def is_potential(
    potential: Mapping[ResourceId, int],
    moves: Iterable[tuple[ResourceId, Sequence[ResourceId], int]],
    stop: ResourceId,
    extra: int,
    behind: Mapping[ResourceId, int] | None,
) -> Iterator[str]:
    """The faults of a potential; each resource comes with those that it leads to, and the ticks needed in it.

    The next stop takes `extra` ticks longer than its duration, and `behind` is the potential once it is served; `None`:
    it is the goal.
    """
    there = potential.get(stop)
    if behind is None and there != 0:
        yield f"{stop}, the goal, must have the potential 0"
    elif behind is not None and stop in behind and (there is None or there > extra + behind[stop]):
        yield f"{stop}, the next stop, must have a potential of at most {extra + behind[stop]}"
    for source, targets, ticks in moves:
        there = potential.get(source)
        for target in targets:
            if target in potential and (there is None or there > ticks + potential[target]):
                yield f"{source}, which leads to {target}, must have a potential of at most {ticks + potential[target]}"


@rule(
    "query-certificate/closed",
    "At the start, and at each label at a tick t with t + potential before the bound, the robot cannot end its plan, "
    "and every window that it can enter from there at such a tick t has a label no later than t.",
    DESIGN,
)
def is_closed(can_end: bool, entries: Iterable[tuple[int, int | None]]) -> bool:
    """Whether a start or label leads to labels alone; an entry is a tick and the first label in the window, if any."""
    return not can_end and all(first is not None and first <= tick for tick, first in entries)


@rule(
    "query-certificate/size",
    "The labels, each counted with the windows and the committed moves that are looked at in and from it, and the "
    f"resources and moves, counted for each stop left, are at most {LARGEST_CHECK} together.",
    DESIGN,
)
def size_fits(size: int) -> bool:
    """Whether that many can be looked at."""
    return size <= LARGEST_CHECK


QUERY_CERTIFICATE_RULES: tuple[Rule[..., Any], ...] = (
    plans_are_lawful,
    robot_is_known,
    is_no_later,
    fits_stops,
    is_potential,
    is_closed,
    size_fits,
)
