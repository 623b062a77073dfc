"""Instances, solutions and plans.

An instance remembers in `seen` what was looked at beside it: solutions, each with whether it is known to break no rule
of it. It is empty until the instance itself is known to be right. The solutions are not kept alive by it, but for those
that are made here of plans. A resource graph remembers whether it is right: instances of other robots share it.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from operator import itemgetter
from typing import Any, cast
from weakref import ref

from carp_spec.instance_rules import instance_faults
from carp_spec.model import SEEN, Instance, Plan, ResourceGraph, Solution
from carp_spec.refusal import Refusal
from carp_spec.shapes import require_each, require_shape

NOTHING = Solution((), ())
NOWHERE = ResourceGraph((), ())
RECENT = SEEN // 2
"""What was looked at so lately is not forgotten next."""


def require_instance(instance: Instance) -> None:
    """Raise `Refusal` with the first fault, unless the instance is known to be right."""
    found = cast("object", instance)
    if not (isinstance(found, Instance) and found.seen):
        graph = cast("object", found.graph) if isinstance(found, Instance) else None
        is_known = isinstance(graph, ResourceGraph) and bool(graph.seen)
        require_shape(replace(instance, graph=NOWHERE) if is_known else instance, Instance)
        for fault in instance_faults(instance):
            raise Refusal("document", fault.path, fault.rule, fault.message)
        instance.graph.seen[:] = ["right"]
        remember(instance, ref(NOTHING))


def require_solution(instance: Instance, solution: Solution) -> None:
    """Raise `Refusal` with the first fault of the instance, or if the solution is malformed."""
    require_instance(instance)
    found = cast("object", solution)  # what is no solution is as little known as one that is gone
    if found is None or not any(each() is found for each, _ in (*instance.seen,)):
        is_known = isinstance(found, Solution) and has_sound_plans(instance, solution.plans)
        require_shape(replace(solution, plans=()) if is_known else solution, Solution)
        remember(instance, ref(solution))


def has_sound_plans(instance: Instance, plans: Sequence[Plan]) -> bool:
    """Whether they are all of one solution that is known to break no rule, so that they break none together."""
    if type(plans) is tuple:
        asked = {*map(id, plans)}
        for age, (seen, is_sound) in enumerate(reversed((*instance.seen,))):
            solution = seen() if is_sound else None
            if solution is not None and asked <= {*map(id, solution.plans)}:
                if age >= RECENT:
                    remember(instance, seen, is_sound=True)
                return True
    return False


def require_plans(instance: Instance, plans: Sequence[Plan]) -> Solution:
    """The solution that has these plans; raises `Refusal` with the first fault of the instance, or of a plan."""
    require_instance(instance)
    seen = [(is_sound, each()) for each, is_sound in (*instance.seen,)]
    same = [(is_sound, each) for is_sound, each in seen if each is not None and each.plans is plans]
    if same:
        return max(same, key=itemgetter(0))[1]
    found: Any = plans
    if isinstance(found, Sequence):
        found = tuple(found)
    is_known = has_sound_plans(instance, found)
    if not is_known:
        require_shape(found, tuple[Plan, ...], "$.plans")
    solution = Solution(found, tuple(plan.robot for plan in found))
    remember(instance, lambda: solution, is_sound=is_known and len({*solution.order}) == len(found))
    return solution


def known(instance: Instance, solution: Solution) -> Solution:
    """The solution, which the instance remembers: its planner made the plans, beside plans that broke no rule."""
    remember(instance, ref(solution), is_sound=True)
    return solution


def remember(instance: Instance, seen: Callable[[], Solution | None], *, is_sound: bool = False) -> None:
    """Remember a solution, once and as the last one, and forget those that are gone."""
    solution = seen()
    others = [each for each in (*instance.seen,) if each[0]() is not None and each[0]() is not solution]
    instance.seen.clear()
    instance.seen.extend([*others, (seen, is_sound)])


def require_update(before: Sequence[Plan], after: Sequence[Plan], now: int) -> None:
    """Raise `Refusal` if plans made again at a tick, or those before, are malformed."""
    require_each(before, Plan, "$.before")
    require_each(after, Plan, "$.after")
    require_shape(now, int, "$.now")


def require_known(instance: Instance, plans: Sequence[Plan]) -> None:
    """Raise `Refusal` for a plan of a robot that the instance does not have."""
    for place, plan in enumerate(plans):
        if plan.robot not in instance.robot:
            raise Refusal("request", f"$.plans[{place}]", "solution/covers", "the instance has no such robot")
