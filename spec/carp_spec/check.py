"""The checker: the violations of plans, in a fixed order."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from carp_spec.inputs.options import require_limits
from carp_spec.inputs.values import known, require_known, require_plans, require_solution, require_update
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
    require_limits(most=most)
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


def solution_violations(
    instance: Instance, solution: Solution, most: int | None = MOST_LISTED
) -> tuple[Violation, ...]:
    """The violations of the rules that do not look at visits, at most `most` of each rule (`None`: all)."""
    return tuple(violation for each in SOLUTION_RULES for violation in islice(each(instance, solution), most))


def judge(instance: Instance, solution: Solution, most: int | None = MOST_LISTED) -> Verdict:
    """Check a whole solution; plans of unknown robots break `solution/covers` alone."""
    require_solution(instance, solution)
    require_limits(most=most)
    plans = [plan for plan in solution.plans if plan.robot in instance.robot]
    planned = {plan.robot for plan in plans}
    verdict = Verdict(
        cost=total_cost(instance, [plan for plan in plans if plan.visits]),
        unplanned=sum(robot.id not in planned for robot in instance.robots),
        violations=(*solution_violations(instance, solution, most), *_violations(instance, plans, most)),
    )
    if verdict.valid:
        known(instance, solution)
    return verdict


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
