"""The checker: the violations of plans, in a fixed order."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from carp_spec.inputs.values import require_known, require_plans, require_solution, require_update
from carp_spec.joint_rules import JOINT_RULES, SOLUTION_RULES
from carp_spec.model import Instance, Plan, Solution
from carp_spec.plan_rules import PLAN_RULES, plan_keeps_history, total_cost
from carp_spec.quick_check import breaks_no_rule, is_large
from carp_spec.rule import Violation

MOST_LISTED = 100


@dataclass(frozen=True, slots=True)
class Verdict:
    """The answer for a solution; `cost` is the total cost of its plans."""

    cost: int
    unplanned: int
    violations: tuple[Violation, ...]

    @property
    def valid(self) -> bool:
        """Whether no rule is broken; robots may be unplanned."""
        return not self.violations


def violations_of(instance: Instance, plans: Sequence[Plan], most: int | None = MOST_LISTED) -> tuple[Violation, ...]:
    """The violations of plans, at most `most` of each rule (`None`: all).

    Raises `Refusal` for malformed input and unknown robots.
    """
    require_known(instance, require_plans(instance, plans).plans)
    return _violations(instance, plans, most)


def _violations(instance: Instance, plans: Sequence[Plan], most: int | None) -> tuple[Violation, ...]:
    if is_large(plans) and breaks_no_rule(instance, plans):
        return ()
    violations: list[Violation] = []
    for each in PLAN_RULES:
        violations += islice((violation for plan in plans for violation in each(instance, plan)), most)
    for together in JOINT_RULES:
        violations += islice(together(instance, plans), most)
    return tuple(violations)


def judge(instance: Instance, solution: Solution, most: int | None = MOST_LISTED) -> Verdict:
    """Check a whole solution; plans of unknown robots break `solution/covers` alone."""
    require_solution(instance, solution)
    plans = [plan for plan in solution.plans if plan.robot in instance.robot]
    of_solution = [violation for each in SOLUTION_RULES for violation in islice(each(instance, solution), most)]
    planned = {plan.robot for plan in plans}
    return Verdict(
        cost=total_cost(instance, [plan for plan in plans if plan.visits]),
        unplanned=sum(robot.id not in planned for robot in instance.robots),
        violations=(*of_solution, *_violations(instance, plans, most)),
    )


def check_update(before: Sequence[Plan], after: Sequence[Plan], now: int) -> tuple[Violation, ...]:
    """All violations of `fleet/history` by plans made again at the tick now; a robot without one breaks nothing."""
    require_update(before, after, now)
    again = {plan.robot: plan for plan in after}
    return tuple(
        violation
        for plan in before
        if plan.robot in again
        for violation in plan_keeps_history(plan, again[plan.robot], now)
    )
