"""Lets the proved kernel decide what it can about an answer: whether its plans break a rule, and whether they are late.

The kernel checks all plans together. From the level complete-in-context on, it gets a certificate for each robot beside
the plans before it: no plan arrives before the best one that carproof finds. It also checks that this plan breaks no
rule. The kernel does not cover `fleet/history` and the rules about a planner's choices.
"""

from carp_spec import Carp, Instance, Plan, Solution
from carp_spec.documents.solutions import solution_document
from carp_spec.documents.verdicts import VerdictDocument
from carp_verify.bound.rules import ContradictionError
from carp_verify.kernel import ask, request
from carproof.conform.answers import Answer
from carproof.conform.cases import Case, engine_for
from carproof.conform.findings import Finding
from carproof.conform.levels import Level
from carproof.protocol.ops.planning import QueryDocument

LAWFUL = ("solution/", "plan/", "joint/")
EARLY = ("query/complete", "query/optimal")


def require_agreement(case: Case, answer: Answer, level: Level, finding: Finding | None) -> None:
    """Raise `ContradictionError` if the kernel refuses what was accepted, or accepts what breaks a rule of its own."""
    match answer:
        case VerdictDocument():
            agree = finding is not None or accepts(case.instance, case.solution) == answer.valid
        case QueryDocument() | Solution():
            agree = _agrees_on_plans(case, answer, level, finding)
        case _:
            return
    if not agree:
        found = "nothing wrong" if finding is None else f"{finding.message} [{finding.rule}]"
        raise ContradictionError(f"carp_spec and the kernel differ on {case.name}: carp_spec finds {found}")


def accepts(instance: Instance, solution: Solution) -> bool:
    """Whether the kernel accepts a solution."""
    (answer,) = ask([request("check", instance, solution=solution_document(solution))])
    return answer.accepted


def _agrees_on_plans(case: Case, answer: QueryDocument | Solution, level: Level, finding: Finding | None) -> bool:
    given = _solution_with(case, answer) if isinstance(answer, QueryDocument) else answer
    is_lawful = accepts(case.instance, given)
    if finding is not None and finding.rule.startswith(LAWFUL):
        return not is_lawful
    if not is_lawful or case.op not in ("query", "plan") or level < Level.COMPLETE_IN_CONTEXT:
        return is_lawful
    if finding is not None and finding.rule not in EARLY:
        return True
    return _is_early(case, answer, level) == (finding is None)


def _solution_with(case: Case, answer: QueryDocument) -> Solution:
    """The plans of the others, and the one that was found."""
    found = answer.plan_of(case.asked_robot)
    return Solution.of(case.instance, case.others if found is None else [*case.others, found])


def _is_early(case: Case, answer: QueryDocument | Solution, level: Level) -> bool:
    """Whether no robot has a better plan; the kernel must accept the certificate, or the better plan."""
    instance = case.instance
    if isinstance(answer, QueryDocument):
        asked = [case.asked_robot]
        plans = {case.asked_robot: answer.plan_of(case.asked_robot)}
        committed, own = case.others, case.solution.plan_of(case.asked_robot)
    else:
        asked = [*instance.robot] if isinstance(case.planner, Carp) else [*answer.order, *answer.unplanned]
        plans = dict.fromkeys(asked) | {plan.robot: plan for plan in answer.plans}
        committed, own = [], None
    certifier = engine_for(instance).certifier(instance)
    certifier.commit(committed)
    requests, is_early = [], True
    for robot in asked:
        best, certificate = certifier.certify(robot, own, case.now)
        before = solution_document(Solution.of(instance, committed if own is None else [*committed, own]))
        requests.append(request("verify-query", instance, solution=before, certificate=certificate))
        if best is not None:
            beside = solution_document(Solution.of(instance, [*committed, best]))
            requests.append(request("check", instance, solution=beside))
        plan = plans[robot]
        is_early = is_early and not _is_worse(plan, best, level)
        if plan is not None:
            certifier.commit([plan])
            committed.append(plan)
    for verdict in ask(requests):
        if not verdict.accepted:
            raise ContradictionError(f"{verdict.by} refuses carproof's own on {case.name}: {verdict.message}")
    return is_early


def _is_worse(plan: Plan | None, best: Plan | None, level: Level) -> bool:
    """Whether a plan is missing where there is a best one, or late where that counts."""
    if plan is None or best is None:
        return plan is None and best is not None
    return level >= Level.CONTEXT_OPTIMAL and plan.visits[-1].enter > best.visits[-1].enter
