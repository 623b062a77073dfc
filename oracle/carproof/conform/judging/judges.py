"""The demands of each level on an answer. A program is judged by its answer alone, not by its method."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

from carp_spec import (
    Carp,
    Instance,
    Plan,
    Refusal,
    RobotId,
    Solution,
    Visit,
    check_update,
    judge,
    plan_cost,
    total_cost,
    violations_of,
)
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.verdicts import VerdictDocument, verdict_document
from carp_spec.execution.traces import Trace
from carp_spec.polish_rules import is_kept
from carp_verify.bound.rules import ContradictionError
from carproof.command_line.output import shown_plan
from carproof.conform.answers import Answer
from carproof.conform.cases import POLISH_ROUNDS, Case, engine_for, planned_by
from carproof.conform.findings import Finding, broken, wrong
from carproof.conform.judging.driving import execution_findings
from carproof.conform.judging.optimum import bound_findings, complete_findings, optimum_findings, plan_cost_findings
from carproof.conform.levels import Level
from carproof.judging.audit import Beside
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument


def first_finding(case: Case, answer: Answer, level: Level) -> Finding | None:
    """The first fault of an answer, by the lowest level that demands otherwise."""
    return next(_findings(case, answer, level), None)


def _findings(case: Case, answer: Answer, level: Level) -> Iterator[Finding]:
    match answer:
        case QueryDocument():
            yield from _query_findings(case, answer, level)
        case VerdictDocument():
            yield from _check_findings(case, answer, level)
        case OptimumDocument():
            yield from optimum_findings(case.instance, answer, level)
        case BoundDocument():
            yield from bound_findings(case.instance, answer)
        case Trace():
            yield from execution_findings(case, answer, level)
        case Solution() if case.op == "add":
            yield from _add_findings(case, answer, level)
        case Solution() if case.op == "polish":
            yield from _polish_findings(case, answer, level)
        case Solution():
            yield from _plan_findings(case, answer, level)


def _followed(case: Case) -> tuple[Plan, ...]:
    """The plan that the robot has followed until now; one without a plan has stood at its start since its release."""
    own, robot = case.solution.plan_of(case.asked_robot), case.instance.robot[case.asked_robot]
    if own is not None:
        return (own,)
    return (Plan(robot.id, (Visit(robot.start, robot.release, None),)),) if robot.release <= case.now else ()


def _query_findings(case: Case, answer: QueryDocument, level: Level) -> Iterator[Finding]:
    robot = case.asked_robot
    plan = answer.plan_of(robot)
    if plan is not None:
        yield from broken(violations_of(case.instance, (*case.others, plan)))
        yield from broken(check_update(_followed(case), [plan], case.now))
    if level >= Level.COMPLETE_IN_CONTEXT:
        beside = Beside(case.instance, engine_for(case.instance))
        for each in case.others:
            beside.commit(each)
        best = _best(beside, robot, case.solution.plan_of(robot), case.now)
        yield from _against_best(case.instance, best, robot, plan, level)


def _best(beside: Beside, robot: RobotId, followed: Plan | None = None, now: int = 0) -> Plan | None:
    """The best plan of a robot, which counts if it breaks no rule, and if its certificate is accepted."""
    plan, certificate = beside.best(robot, followed, now)
    with suppress(Refusal):  # it is too large to be checked
        beside.require(certificate, followed)
    arrival = None if plan is None else plan.visits[-1].enter
    if certificate.bound != arrival:
        raise ContradictionError(f"the plan of robot {robot} arrives at {arrival}, not at {certificate.bound}")
    return plan


def _against_best(
    instance: Instance, best: Plan | None, robot: RobotId, plan: Plan | None, level: Level
) -> Iterator[Finding]:
    if best is None:
        if plan is not None:
            raise RuntimeError(f"carproof says that robot {robot} has no plan, and {shown_plan(plan)} is one")
        return
    arrival = best.visits[-1].enter
    if plan is None:
        yield wrong("query/complete", f"robot {robot} has a plan, which arrives at {arrival}: {shown_plan(best)}")
    elif plan_cost(instance, plan) < plan_cost(instance, best):
        raise RuntimeError(f"carproof says that robot {robot} arrives at {arrival} at best: not so {shown_plan(plan)}")
    elif level >= Level.CONTEXT_OPTIMAL and plan_cost(instance, plan) > plan_cost(instance, best):
        late = plan.visits[-1].enter
        yield wrong("query/optimal", f"robot {robot} arrives at {late}, and can at {arrival}: {shown_plan(best)}")
    elif level >= Level.EXACT and plan != best:
        yield wrong("query/ties", f"robot {robot} must go {shown_plan(best)}, not {shown_plan(plan)}")


def _plan_findings(case: Case, solution: Solution, level: Level) -> Iterator[Finding]:
    yield from broken(judge(case.instance, solution).violations)
    if isinstance(case.planner, Carp):
        yield from _in_order_findings(case, solution, list(case.instance.robot), level)
    elif case.planner is None and level >= Level.COMPLETE:
        yield from complete_findings(case.instance, solution)
    elif case.planner is None and not case.classical:
        yield from _in_order_findings(case, solution, [*solution.order, *solution.unplanned], level)
    if case.planner is None and level >= Level.OPTIMAL:
        yield from plan_cost_findings(case.instance, solution)
    if case.planner is not None and level >= Level.EXACT:
        expected = engine_for(case.instance).plan(case.instance, case.planner)
        yield from _same_solution(solution, expected, case.planner.name)


def _in_order_findings(case: Case, solution: Solution, order: Sequence[RobotId], level: Level) -> Iterator[Finding]:
    """Compare each plan with the best against those before it."""
    if level < Level.COMPLETE_IN_CONTEXT:
        return
    plans = {plan.robot: plan for plan in solution.plans}
    beside = Beside(case.instance, engine_for(case.instance))
    for robot in order:
        plan = plans.get(robot)
        yield from _against_best(case.instance, _best(beside, robot), robot, plan, level)
        if plan is not None:
            beside.commit(plan)


def _same_solution(solution: Solution, expected: Solution, planner: str) -> Iterator[Finding]:
    """The first plan that is not the expected one, wherever it is listed."""
    if solution.order != expected.order or {*solution.unplanned} != {*expected.unplanned}:
        right = f"the order {list(expected.order)} and leave {list(expected.unplanned)} unplanned"
        yield wrong("query/ties", f"{planner} must give {right}, not {list(solution.order)}")
    plans = {plan.robot: plan for plan in solution.plans}
    for right_plan in expected.plans:
        plan = plans.get(right_plan.robot)
        if plan is not None and plan != right_plan:
            right = f"robot {right_plan.robot} {shown_plan(right_plan)}"
            yield wrong("query/ties", f"{planner} must give {right}, not {shown_plan(plan)}")


def _add_findings(case: Case, after: Solution, level: Level) -> Iterator[Finding]:
    yield from broken(judge(case.instance, after).violations)
    before = case.solution.plans
    lost = {plan.robot for plan in before} - {plan.robot for plan in after.plans}
    for plan in before:
        if plan.robot in lost:
            yield wrong("fleet/history", f"robot {plan.robot} had a plan and has none now")
    followed = (*before, *_followed(case))
    yield from broken(check_update(followed, after.plans, case.now))
    if level >= Level.COMPLETE_IN_CONTEXT:
        yield from _against_keeping(case, after, level)
    if level >= Level.EXACT:
        expected = planned_by(engine_for(case.instance), case)
        yield from _same_solution(after, expected, "add")


def _against_keeping(case: Case, after: Solution, level: Level) -> Iterator[Finding]:
    """With the baseline, adding a robot is no worse than keeping all plans and asking for one more.

    The cost counts where plans must be early.
    """
    kept = case.solution.plans
    one_more = engine_for(case.instance).query(case.instance, kept, case.asked_robot, case.now)
    if one_more is None or not case.options.baseline:
        return
    if case.robot in after.unplanned:
        yield wrong("query/complete", f"robot {case.robot} has a plan: {shown_plan(one_more)}")
        return
    least, cost = total_cost(case.instance, (*kept, one_more)), total_cost(case.instance, after.plans)
    if level >= Level.CONTEXT_OPTIMAL and cost > least:
        yield wrong("neighbourhood/baseline", f"the total cost is {cost}, and {least} if all plans are kept")


def _polish_findings(case: Case, after: Solution, level: Level) -> Iterator[Finding]:
    """A polished solution breaks no rule, leaves no more robots unplanned, and if as many, has no larger total."""
    yield from broken(judge(case.instance, after).violations)
    (missing, total), (missing_before, total_before) = (worth(case, each.plans) for each in (after, case.solution))
    if not is_kept((missing_before, total_before), (missing, total)):
        given = f"the solution to polish leaves {missing_before} robots unplanned, with a total of {total_before}"
        yield wrong(is_kept.id, f"{given}, and the answer leaves {missing}, with {total}")
    if level >= Level.EXACT:
        expected = engine_for(case.instance).polish(case.instance, case.solution, iterations=POLISH_ROUNDS)
        yield from _same_solution(after, expected, "polish")


def worth(case: Case, plans: Sequence[Plan]) -> tuple[int, int]:
    """How many robots have no plan, and the total of the others."""
    return len(case.instance.robots) - len(plans), total_cost(case.instance, plans)


def _check_findings(case: Case, verdict: VerdictDocument, level: Level) -> Iterator[Finding]:
    right = verdict_document(judge(case.instance, case.solution))
    named = list(dict.fromkeys(violation.rule for violation in verdict.violations))
    required = list(dict.fromkeys(violation.rule for violation in right.violations))
    for rule in required:
        if rule not in named:
            message = next(violation.message for violation in right.violations if violation.rule == rule)
            yield wrong(rule, f"the verdict must report that it is broken: {message}")
    for rule in named:
        if rule not in required:
            yield wrong(rule, "the verdict must not report that it is broken")
    if verdict.valid != right.valid:
        yield wrong("program/result", f"valid must be {right.valid}, as the violations say")
    if (verdict.cost, verdict.unplanned) != (right.cost, right.unplanned):
        message = f"cost and unplanned must be {right.cost} and {right.unplanned}"
        yield wrong("cost/total", f"{message}, not {verdict.cost} and {verdict.unplanned}")
    if level >= Level.EXACT and not _same_violations(case, verdict, right):
        yield wrong("program/result", f"the violations must be {list(right.violations)}")


def _same_violations(case: Case, verdict: VerdictDocument, right: VerdictDocument) -> bool:
    """Whether as many violations are listed, at places where a rule is broken; words and order are free."""
    every = verdict_document(judge(case.instance, case.solution, most=None))
    return len(_places(verdict)) == len(_places(right)) and _places(verdict) <= _places(every)


def _places(verdict: VerdictDocument) -> set[tuple[object, ...]]:
    return {(each.rule, frozenset(each.robots), each.resource, each.start, each.end) for each in verdict.violations}
