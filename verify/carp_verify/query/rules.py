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
    "query-certificate/potential",
    "The potential of the goal is 0. Where a move leads from r to s, and s has a potential, r has one too: no more "
    "than that of s and the ticks that the robot needs in r.",
    DESIGN,
)
def is_potential(
    potential: Mapping[ResourceId, int],
    goal: ResourceId,
    moves: Iterable[tuple[ResourceId, Sequence[ResourceId], int]],
) -> Iterator[str]:
    """The faults of a potential; each resource comes with those that it leads to, and the ticks needed in it."""
    if potential.get(goal) != 0:
        yield f"{goal}, the goal, must have the potential 0"
    for source, targets, ticks in moves:
        most = potential.get(source)
        for target in targets:
            if target in potential and (most is None or most > ticks + potential[target]):
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
    "The labels, each counted with the windows and the committed moves that are looked at from it, are at most "
    f"{LARGEST_CHECK}.",
    DESIGN,
)
def size_fits(size: int) -> bool:
    """Whether that many can be looked at."""
    return size <= LARGEST_CHECK


QUERY_CERTIFICATE_RULES: tuple[Rule[..., Any], ...] = (
    plans_are_lawful,
    robot_is_known,
    is_no_later,
    is_potential,
    is_closed,
    size_fits,
)
