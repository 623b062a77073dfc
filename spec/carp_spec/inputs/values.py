"""Instances, solutions and plans.

An instance remembers in `seen` what was looked at beside it: solutions, each with what is known to break no rule of it,
all its robots named. It is empty until the instance itself is known to be right.
"""

from collections.abc import Sequence
from operator import itemgetter
from typing import Any, cast

from carp_spec.instance_rules import instance_faults
from carp_spec.model import Instance, Plan, Solution
from carp_spec.refusal import Refusal
from carp_spec.shapes import require_shape

NOTHING = Solution((), ())


def require_instance(instance: Instance) -> None:
    """Raise `Refusal` with the first fault, unless the instance is known to be right."""
    if not (isinstance(cast("object", instance), Instance) and instance.seen):
        require_shape(instance, Instance)
        for fault in instance_faults(instance):
            raise Refusal("document", fault.path, fault.rule, fault.message)
        instance.seen.append((NOTHING, None))


def require_solution(instance: Instance, solution: Solution) -> None:
    """Raise `Refusal` with the first fault of the instance, or if the solution is malformed."""
    require_instance(instance)
    if not any(each is solution for each, _ in (*instance.seen,)):
        require_shape(solution, Solution)
        instance.seen.append((solution, None))


def require_plans(instance: Instance, plans: Sequence[Plan]) -> Solution:
    """The solution that has these plans; raises `Refusal` with the first fault of the instance, or of a plan."""
    require_instance(instance)
    same = [(sound is None, each) for each, sound in (*instance.seen,) if each.plans is plans]
    if same:
        return min(same, key=itemgetter(0))[1]
    found: Any = plans
    if isinstance(found, Sequence):
        found = tuple(found)
    require_shape(found, tuple[Plan, ...], "$.plans")
    solution = Solution(found, tuple(plan.robot for plan in found))
    if found is plans:
        instance.seen.append((solution, None))
    return solution


def require_update(before: Sequence[Plan], after: Sequence[Plan], now: int) -> None:
    """Raise `Refusal` if plans made again at a tick, or those before, are malformed."""
    require_shape(tuple(before), tuple[Plan, ...], "$.before")
    require_shape(tuple(after), tuple[Plan, ...], "$.after")
    require_shape(now, int, "$.now")


def require_known(instance: Instance, plans: Sequence[Plan]) -> None:
    """Raise `Refusal` for a plan of a robot that the instance does not have."""
    for place, plan in enumerate(plans):
        if plan.robot not in instance.robot:
            raise Refusal("request", f"$.plans[{place}]", "solution/covers", "the instance has no such robot")
