"""The rules of a query, the search for one robot's plan against committed plans: `query/...`.

Rival plans are given to compare with: all rivals decide the rule, some are evidence.
"""

from collections.abc import Iterable, Sequence

from carp_spec.check import violations_of
from carp_spec.model import Instance, Plan
from carp_spec.plan_rules import plan_cost
from carp_spec.rule import MORS, rule


@rule("query/sound", "The plan returned breaks no rule, alone or together with the committed plans.", MORS)
def plan_is_sound(instance: Instance, committed: Sequence[Plan], plan: Plan) -> bool:
    return not violations_of(instance, (*committed, plan))


@rule(
    "query/optimal",
    "Every plan that arrives earlier than the one returned breaks a rule, alone or together with the committed plans.",
    MORS,
)
def plan_is_optimal(instance: Instance, committed: Sequence[Plan], plan: Plan, rivals: Iterable[Plan]) -> bool:
    cost = plan_cost(instance, plan)
    return not any(plan_cost(instance, rival) < cost and plan_is_sound(instance, committed, rival) for rival in rivals)


@rule(
    "query/complete",
    "The answer that no plan exists is given only where every plan breaks a rule, alone or together with the committed "
    "plans.",
    MORS,
)
def absence_is_true(instance: Instance, committed: Sequence[Plan], rivals: Iterable[Plan]) -> bool:
    return not any(plan_is_sound(instance, committed, rival) for rival in rivals)


@rule(
    "query/ties",
    "A* expands the smallest f = g + h first, then the largest g, then the smallest index of the resource in the "
    "instance, then the earliest window, then the fewest stops served. A window with a number of stops served keeps "
    "the first parent that gave its smallest g; serving a stop there comes before moving on. g is the tick from which"
    " the robot may leave, less the duration: the tick of entering the window, or a later one after a long service. h"
    " is the least ticks from entering its resource, over the stops left, to entering the goal on the empty graph. "
    "Where robots park, no plan ends before the last window of the goal opens: windows of an f up to that tick come "
    "before all others, and of these the smallest h first, then the smallest index, then the smallest g. One that is "
    "entered earlier once it has been expanded is expanded again; what it led to before keeps its way. "
    "The smallest g is enough: who may leave earlier can wait, and only who has just entered ends, or serves a stop.",
    "decision of carproof",
)
def expansion_key(
    f: int, g: int, resource_index: int, window_start: int, served: int = 0, opens: int = 0
) -> tuple[int, ...]:
    if f <= opens:
        return (0, f - g, resource_index, g, window_start, served)
    return (f, -g, resource_index, window_start, served)
