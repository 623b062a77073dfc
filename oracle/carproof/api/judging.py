"""Solutions and traces checked, and audits."""

from dataclasses import replace
from time import perf_counter
from typing import cast

from carp_spec import Instance, Refusal, Solution, Verdict, judge, total_cost
from carp_spec.check import MOST_LISTED
from carp_spec.execution.execution_rules import trace_violations
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_trace, sound_solution
from carp_spec.shapes import require_shape
from carp_verify.footprint.apart import footprint_violations
from carp_verify.footprint.rules import Footprint, cells_have_a_step, vehicle_has_a_size
from carproof.engines import engine_named
from carproof.judging.audit import Audit, audit_in_order, audit_in_some_order
from carproof.requests import deadline


def check(
    instance: Instance,
    solution: Solution,
    most: int | None = MOST_LISTED,
    footprint: Footprint | None = None,
    cells: int | None = None,
) -> Verdict:
    """Judge a solution by the law, with at most the first `most` violations of each rule (`None`: all).

    With a footprint, vehicles of that size must keep apart, by the positions of resources in mm, whatever the groups.
    With `cells` no resource is a lane, and a step of the positions is so many mm long. Robots without a plan break no
    rule. Raises `Refusal` for a malformed instance or solution, and with a footprint for resources without positions
    and, without `cells`, for those that are neither points nor lanes.
    """
    given = cast("object", footprint)
    if not (given is None or isinstance(given, Footprint)):
        message = f"it must be a value of Footprint, not {given!r}"
        raise Refusal("option", "$.footprint", vehicle_has_a_size.id, message)
    verdict = judge(instance, solution, most)
    for fault in cells_have_a_step(cells, footprint):
        raise Refusal("option", fault.path, fault.rule, fault.message)
    if footprint is None:
        return verdict
    too_near = footprint_violations(instance, solution.plans, footprint, most, cells)
    return replace(verdict, violations=(*verdict.violations, *too_near))


def check_trace(instance: Instance, solution: Solution, trace: Trace) -> Verdict:
    """Judge whether a trace follows a solution: paths, durations and the planned order.

    Cost and unplanned robots are those of the solution. Raises `Refusal` for a solution that breaks a rule.
    """
    require_trace(instance, solution, trace)
    sound = sound_solution(instance, solution)
    violations = trace_violations(instance, sound, trace)
    return Verdict(total_cost(instance, sound.plans), len(sound.unplanned), violations)


def audit(instance: Instance, solution: Solution, *, find_order: bool = False, seconds: float | None = None) -> Audit:
    """Certify that no robot can arrive earlier beside the plans before its own, or find the earlier plans.

    The order is that of the solution; with `find_order`, any in which each plan is optimal, if there is one. Plans
    are undecided that are not looked at in so many seconds. Raises `Refusal` for a solution that breaks a rule.
    """
    require_shape(find_order, bool, "$.find_order")
    until = deadline(seconds)
    sound = sound_solution(instance, solution)
    audited = audit_in_some_order if find_order else audit_in_order
    return audited(instance, sound, engine_named(None), goes_on=lambda: perf_counter() < until)
