"""The limits of a page or picture: `view/...`. Larger solutions are refused before any work is done."""

from typing import Any

from carp_spec import Instance, Refusal, Rule, Solution
from carp_spec.execution.traces import Trace
from carp_spec.rule import DESIGN, rule

_MOST = {"resources": 50_000, "edges": 200_000, "robots": 10_000, "visits": 4_000_000, "bytes": 128 * 2**20}
LARGEST_TICK = 10_000_000
MOST_LISTED = 2_000


@rule(
    "view/size",
    "A picture shows at most {resources} resources, {edges} edges, {robots} robots and {visits} visits, and is a file "
    "of at most {bytes} bytes, so that a browser can hold it.".format_map(_MOST),
    DESIGN,
)
def size_is_bounded(what: str, size: int) -> bool:
    """Whether there are no more of what is counted than a picture shows."""
    return size <= _MOST[what]


@rule("view/ticks", f"A picture shows ticks from -{LARGEST_TICK} to {LARGEST_TICK}.", DESIGN)
def tick_is_shown(tick: int) -> bool:
    """Whether the tick is one that a picture can show."""
    return abs(tick) <= LARGEST_TICK


VIEW_RULES: tuple[Rule[..., Any], ...] = (size_is_bounded, tick_is_shown)


def refuse_large_pictures(instance: Instance, solution: Solution, trace: Trace | None = None) -> None:
    """Raise `Refusal` where a picture of the solution, and of what has happened, would be too large."""
    plans = solution.plans if trace is None else solution.plans + trace.plans
    refuse_more("resources", len(instance.graph.resources))
    refuse_more("edges", len(instance.graph.edges))
    refuse_more("robots", max(len(instance.robots), len(plans), len(solution.order), len(solution.unplanned)))
    refuse_more("visits", sum(len(plan.visits) for plan in plans))
    if trace is not None:
        refuse_tick(trace.now, "now")
    for robot in instance.robots:
        refuse_tick(robot.release, f"the release of robot {robot.id}")
    for plan in plans:
        for visit in plan.visits:
            for tick in (visit.enter, visit.leave):
                refuse_tick(tick or 0, f"a visit of robot {plan.robot} to {visit.resource}")


def refuse_more(what: str, size: int) -> None:
    """Raise `Refusal` where there are more of them than a picture shows."""
    if not size_is_bounded(what, size):
        message = f"a picture shows at most {_MOST[what]} {what}, and this one would have {size}"
        raise Refusal("limit", "picture", size_is_bounded.id, message)


def refuse_tick(tick: int, where: str) -> None:
    """Raise `Refusal` for a tick that no picture shows."""
    if not tick_is_shown(tick):
        message = f"its ticks must be between -{LARGEST_TICK} and {LARGEST_TICK}, and there is {tick}"
        raise Refusal("limit", where, tick_is_shown.id, message)
