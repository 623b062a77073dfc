"""The demands of the level `optimal`: the optimum of small instances, as carproof's search finds it."""

from collections.abc import Iterator
from functools import lru_cache

from carp_spec import Instance, Refusal, Solution, judge, total_cost
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.solutions import solution_of
from carproof.conform.cases import OPTIMUM_SECONDS, engine_for, is_large
from carproof.conform.findings import Finding, broken, is_complete, is_lower, is_optimal, wrong
from carproof.conform.levels import Level
from carproof.optima import OptimumDocument


@lru_cache(maxsize=1)
def found_cost(instance: Instance) -> tuple[bool, int | None]:
    """Whether the search for the optimum ended in time, and what it found: `None` if robots cannot all be planned.

    It is not asked about large instances.
    """
    if is_large(instance):
        return False, None
    from carp_optimum.optimum import optimum  # noqa: PLC0415 - loads a solver

    found = optimum(instance, OPTIMUM_SECONDS)
    return found.decided, found.cost


def cost_alone(instance: Instance) -> int | None:
    """The sum of the robots' costs if each were alone, `None` if one has no plan even then."""
    plans = [engine_for(instance).query(instance, (), robot) for robot in instance.robot]
    known = [plan for plan in plans if plan is not None]
    return total_cost(instance, known) if len(known) == len(plans) else None


def optimum_findings(instance: Instance, answer: OptimumDocument, level: Level) -> Iterator[Finding]:
    """The fault of an answer to `optimum`, if any."""
    if answer.solution is not None:
        solution = solution_of(answer.solution)
        yield from broken(judge(instance, solution).violations)
        if solution.unplanned:
            yield wrong("solution/covers", f"an optimum has plans for all robots, also {solution.unplanned[0]}")
        total = total_cost(instance, solution.plans)
        if answer.cost != total:
            yield wrong("cost/total", f"the cost must be {total}, the total of the plans, not {answer.cost}")
    elif answer.cost is not None:
        yield wrong("cost/total", f"a cost of {answer.cost} needs a solution that has it")
    if level >= Level.COMPLETE and answer.decided and answer.solution is None:
        yield from complete_findings(instance, Solution((), (), tuple(instance.robot)))
    if level >= Level.OPTIMAL:
        yield from _against_proof(instance, answer)


def bound_findings(instance: Instance, certificate: BoundDocument) -> Iterator[Finding]:
    """The fault of an answer to `bound`, if any: its certificate, or a bound above the optimum."""
    from carp_verify.bound.verify import verify_bound  # noqa: PLC0415 - only programs that have bounds need it

    try:
        bound = verify_bound(instance, certificate)
    except Refusal as refusal:
        yield wrong(refusal.rule, f"{refusal.path}: {refusal.message}")
        return
    if bound <= (cost_alone(instance) or 0):
        return
    is_found, least = found_cost(instance)
    if is_found and not is_lower(bound, least):
        message = f"its certificate passes for a bound of {bound}, and there are plans with a total of {least}"
        yield wrong(is_lower.id, f"{message}: the certificate is false, and carproof's check of it has a fault")


def _against_proof(instance: Instance, answer: OptimumDocument) -> Iterator[Finding]:
    is_found, least = found_cost(instance)
    if is_found and answer.decided and not is_optimal(answer.cost, least):
        yield wrong(is_optimal.id, f"the least total cost is {_shown(least)}, not {_shown(answer.cost)}")
    if is_found and answer.lower is not None and not is_lower(answer.lower, least):
        yield wrong(is_lower.id, f"no lower bound is above the least total cost {least}, as {answer.lower} is")


def plan_cost_findings(instance: Instance, solution: Solution) -> Iterator[Finding]:
    """The fault of the cost of a solution that is to be optimal, if any."""
    is_found, least = found_cost(instance)
    cost = total_cost(instance, solution.plans)
    if is_found and least is not None and not is_optimal(cost, least):
        yield wrong(is_optimal.id, f"the least total cost is {least}, not {cost}")


def complete_findings(instance: Instance, solution: Solution) -> Iterator[Finding]:
    """The fault of a solution that leaves robots unplanned although all can have plans, if any."""
    if not solution.unplanned:
        return
    is_found, least = found_cost(instance)
    if is_found and not is_complete(len(solution.unplanned), least):
        message = f"all robots can have plans, and {len(solution.unplanned)} have none"
        yield wrong(is_complete.id, message)


def _shown(cost: int | None) -> str:
    return "none, as not all robots can have plans" if cost is None else str(cost)
