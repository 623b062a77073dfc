"""The effort that a right answer shows: a program that never returns a plan is never wrong at `sound`."""

from enum import Enum

from carp_spec import Carp, Solution
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.solutions import SolutionDocument
from carproof.conform.answers import Answer
from carproof.conform.cases import OPTIMUM_SECONDS, POLISH_ROUNDS, Case, engine_for
from carproof.conform.judging.judges import worth
from carproof.conform.judging.optimum import cost_alone, found_cost
from carproof.conform.levels import Level
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument


class Effort(Enum):
    """Whether an answer shows effort."""

    TRIED = "tried"
    GAVE_UP = "gave up"
    NOTHING_TO_DO = "nothing to do"


def why_undecided(case: Case, answer: Answer, level: Level) -> str | None:
    """The reason why a right answer does not count: it is undecided, or carproof cannot decide it."""
    if case.op not in ("plan", "optimum") or case.planner is not None or level < Level.COMPLETE:
        return None
    if level < Level.OPTIMAL and _plans_all(answer):
        return None
    if isinstance(answer, OptimumDocument) and not answer.decided:
        return "it leaves the optimum undecided"
    if not found_cost(case.instance)[0]:
        return f"carproof does not find the optimum in {OPTIMUM_SECONDS} s, with which to compare"
    return None


def _plans_all(answer: Answer) -> bool:
    solution = answer.solution if isinstance(answer, OptimumDocument) else answer
    return isinstance(solution, Solution | SolutionDocument) and not solution.unplanned


def effort(case: Case, answer: Answer) -> Effort:
    """Whether a right answer shows effort; a verdict always does."""
    match answer:
        case QueryDocument():
            return _planned(case, answer.plan is not None)
        case Solution() if case.op == "add":
            return _planned(case, case.robot not in answer.unplanned)
        case Solution() if case.op == "polish":
            return _polished(case, answer)
        case Solution():
            return _planned_whole(case, answer)
        case BoundDocument():
            return _bounded(case, answer)
        case _:
            return Effort.TRIED


def _planned(case: Case, has_plan: bool) -> Effort:
    """Whether the robot that is asked for has a plan."""
    if has_plan:
        return Effort.TRIED
    best = engine_for(case.instance).query(case.instance, case.solution.plans, case.asked_robot, case.now)
    return Effort.NOTHING_TO_DO if best is None else Effort.GAVE_UP


def _planned_whole(case: Case, answer: Solution) -> Effort:
    """More than half as many robots as CARP plans; classical planners often plan all robots or nobody."""
    could = engine_for(case.instance).plan(case.instance, Carp())
    if not could.plans or (case.classical and could.unplanned and not answer.plans):
        return Effort.NOTHING_TO_DO
    return Effort.TRIED if 2 * len(answer.plans) > len(could.plans) else Effort.GAVE_UP


def _polished(case: Case, answer: Solution) -> Effort:
    """Better than the given plans, where carproof betters them."""
    given = worth(case, case.solution.plans)
    if worth(case, answer.plans) < given:
        return Effort.TRIED
    polished = engine_for(case.instance).polish(case.instance, case.solution, iterations=POLISH_ROUNDS)
    return Effort.GAVE_UP if worth(case, polished.plans) < given else Effort.NOTHING_TO_DO


def _bounded(case: Case, answer: BoundDocument) -> Effort:
    """At least the sum of the robots' costs alone, a bound that needs no search."""
    least = cost_alone(case.instance)
    if not least:
        return Effort.NOTHING_TO_DO
    return Effort.TRIED if answer.bound >= least else Effort.GAVE_UP
