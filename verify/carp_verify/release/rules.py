"""The rules of grants: `release/...`."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from carp_spec import Instance, Plan, ResourceId, RobotId, Rule
from carp_spec.execution.traces import Trace
from carp_spec.rule import DESIGN, Found, fault_rule, rule
from carp_verify.release.holding import State, places_of
from carp_verify.release.verify import Witness, is_witness


@dataclass(frozen=True, slots=True)
class Grant:
    """The next resources of a robot's plan, which it may enter without asking again."""

    robot: RobotId
    resources: tuple[ResourceId, ...]


@fault_rule(
    "release/grants",
    "Each grant is of another robot that has a plan and has been released by the tick of the trace, and names the next "
    "resources of its plan, in their order.",
    DESIGN,
)
def grants_are_next(instance: Instance, plans: Sequence[Plan], trace: Trace, grants: Sequence[Grant]) -> Found:
    """Look at the grants, beside a trace that keeps `trace/...`."""
    ways = {plan.robot: [visit.resource for visit in plan.visits] for plan in plans}
    now, seen = places_of(trace, plans), set[RobotId]()
    for number, grant in enumerate(grants):
        path, robot = f"$.grants[{number}]", grant.robot
        if robot not in ways or robot in seen:
            yield f"{path}.robot", f"it must be a robot that has a plan, named once, not {robot!r}"
            continue
        seen.add(robot)
        following = ways[robot][now[robot] + 1 :]
        if grant.resources and instance.robot[robot].release > trace.now:
            yield f"{path}.robot", f"robot {robot!r} must have been released by the tick {trace.now}"
        elif [*grant.resources] != following[: len(grant.resources)]:
            yield f"{path}.resources", f"they must be the next of the plan, {following[: len(grant.resources) or 1]}"


@rule(
    "release/safe",
    "Grants are safe if there is room for all that robots hold then, and robots can move on one by one, each into a "
    "resource with room for it, until all have finished their plans. The witness of an answer shows that.",
    DESIGN,
)
def answer_is_shown(instance: Instance, plans: Sequence[Plan], now: State, granted: State, witness: Witness) -> bool:
    """Whether the witness shows it."""
    return is_witness(instance, plans, now, granted, witness)


@fault_rule(
    "release/room",
    "Of robots that have left the planned order, no more are in a resource or a group than its capacity.",
    DESIGN,
)
def there_is_room(overfull: Iterator[tuple[int, tuple[RobotId, ...]]]) -> Found:
    """Look at the constraints that are too full at the tick of a trace."""
    for _, robots in overfull:
        yield "$.plans", f"the robots {', '.join(map(str, robots))} must not be in one place or group"


RELEASE_RULES: tuple[Rule[..., Any], ...] = (grants_are_next, there_is_room, answer_is_shown)
