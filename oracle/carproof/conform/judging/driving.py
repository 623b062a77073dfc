"""Executions that a foreign controller drives, tick by tick, and their judge."""

from collections.abc import Callable, Iterator, Sequence

from carp_spec import Instance, Plan, RobotId, Violation, Visit, violations_of
from carp_spec.execution.execution_rules import trace_violations
from carp_spec.execution.traces import Trace
from carp_spec.plan_rules import least_stays
from carproof.conform.answers import Skipped
from carproof.conform.cases import Case
from carproof.conform.findings import Fault, Finding, all_arrive, are_ready, broken, wrong
from carproof.conform.levels import Level
from carproof.protocol.ops.executing import DriveDocument

Decide = Callable[[Trace, tuple[RobotId, ...]], DriveDocument | Skipped]
"""Which of the robots that are ready enter their next visits, after what has happened."""


def patience(case: Case) -> int:
    """The ticks in which all robots arrive if they keep the planned order: none is late by more than all delays.

    The kernel proves this for dependency graphs without cycles.
    """
    planned = max((plan.visits[-1].enter for plan in case.solution.plans), default=0)
    return planned + sum(ticks for _, _, ticks in case.delays)


def execution(case: Case, decide: Decide) -> Trace | Skipped:
    """Ask at each tick which of the robots that are ready enter, until all have arrived, some collide or all stand.

    Raises `Fault` where a robot is to enter that is not ready.
    """
    entered: dict[RobotId, list[int]] = {plan.robot: [] for plan in case.solution.plans}
    now = last = 0
    while True:
        trace = _trace(case, entered, now)
        if not _standing(case, trace) or any(_collisions(case.instance, trace)) or now - last > patience(case):
            return trace
        ready = tuple(
            plan.robot
            for plan in case.solution.plans
            if len(entered[plan.robot]) < len(plan.visits) and _free_at(case, plan, entered[plan.robot]) <= now
        )
        if ready:
            decided = decide(trace, ready)
            if isinstance(decided, Skipped):
                return decided
            if not are_ready(decided.enter, ready):
                message = f"at tick {now} robots {[*ready]} are ready, and {[*decided.enter]} are to enter"
                raise Fault(wrong(are_ready.id, message))
            for robot in decided.enter:
                entered[robot].append(now)
                last = now
        now += 1


def _free_at(case: Case, plan: Plan, entered: Sequence[int]) -> int:
    """The tick from which on a robot can leave its last visit, or appear."""
    if not entered:
        return case.instance.robot[plan.robot].release
    place = len(entered) - 1
    delay = sum(ticks for robot, visit, ticks in case.delays if (robot, visit) == (plan.robot, place))
    return entered[-1] + least_stays(case.instance, plan)[place] + delay


def _trace(case: Case, entered: dict[RobotId, list[int]], now: int) -> Trace:
    """The visits entered so far; a robot that does not park leaves its goal as soon as it can."""
    plans = []
    for plan in case.solution.plans:
        ticks = entered[plan.robot]
        free_at = _free_at(case, plan, ticks)
        leaves = len(ticks) == len(plan.visits) and plan.visits[-1].leave is not None and free_at <= now
        ends = [*ticks[1:], free_at if leaves else None]
        resources = [visit.resource for visit in plan.visits]
        visits = (Visit(*visit) for visit in zip(resources, ticks, ends, strict=False))
        plans.append(Plan(plan.robot, tuple(visits)))
    return Trace(now, tuple(plans))


def _standing(case: Case, trace: Trace) -> list[RobotId]:
    """The robots that have not entered the last visits of their plans."""
    pairs = zip(case.solution.plans, trace.plans, strict=True)
    return [plan.robot for plan, done in pairs if len(done.visits) < len(plan.visits)]


def _collisions(instance: Instance, trace: Trace) -> Iterator[Violation]:
    """The rules about robots together that are broken by what has happened."""
    present = [plan for plan in trace.plans if plan.visits]
    return (violation for violation in violations_of(instance, present) if violation.rule.startswith("joint/"))


def execution_findings(case: Case, trace: Trace, level: Level) -> Iterator[Finding]:
    """The faults of an execution; at `exact` it must keep the planned order too."""
    yield from broken(_collisions(case.instance, trace))
    if level >= Level.EXACT:
        yield from broken(trace_violations(case.instance, case.solution, trace, most=1))
    standing = _standing(case, trace)
    if not all_arrive(standing):
        many = f"robots {standing} stand" if standing[1:] else f"robot {standing[0]} stands"
        ticks = f"for {patience(case)} ticks until {trace.now}"
        message = f"{many} for ever: nobody has entered {ticks}, and in the planned order all arrive in as many"
        yield wrong(all_arrive.id, message)
