"""Whether the right answers are enough for a level; a program that answers nothing has shown nothing."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from carp_spec import Solution
from carp_spec.documents.solutions import solution_of
from carproof.conform.findings import LEAST_ANSWERED, LEAST_TRIED, answers_enough, tries_enough
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.outcome import Outcome
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument


@dataclass(slots=True)
class Tally:
    """The numbers of cases that a program could be asked, answered rightly, tried, and gave up."""

    asked: int = 0
    answered: int = 0
    tried: int = 0
    gave_up: int = 0

    def add(self, outcome: Outcome) -> None:
        """Count an outcome."""
        self.asked += outcome.asked
        self.answered += outcome.is_judged and outcome.finding is None
        self.tried += outcome.effort == Effort.TRIED
        self.gave_up += outcome.effort == Effort.GAVE_UP

    @property
    def decides(self) -> bool:
        """Whether there was anything to try."""
        return self.tried + self.gave_up > 0

    def __str__(self) -> str:
        """The counts in words."""
        given_up = f", {self.gave_up} given up" if self.gave_up else ""
        return f"{self.answered} of {self.asked}{given_up}"


@dataclass(slots=True)
class Extent:
    """How large the cases were that a program rightly answered without giving up, and the largest numbers in any."""

    robots: int = 0
    resources: int = 0
    capacity: int = 0
    duration: int = 0
    pace: int = 0
    tick: int = 0

    def add(self, outcome: Outcome) -> None:
        """Count an outcome."""
        if outcome.finding is not None or outcome.effort != Effort.TRIED:
            return
        instance, answer = outcome.case.instance, outcome.answer
        resources, robots = instance.graph.resources, instance.robots
        self.robots, self.resources = max((self.robots, self.resources), (len(robots), len(resources)))
        self.capacity = max([self.capacity, *(resource.capacity for resource in resources)])
        self.duration = max([self.duration, *(resource.duration for resource in resources)])
        self.pace = max([self.pace, *(robot.pace for robot in robots)])
        if isinstance(answer, OptimumDocument) and answer.solution is not None:
            answer = solution_of(answer.solution)
        plans = [*outcome.case.solution.plans, *(answer.plans if isinstance(answer, Solution) else ())]
        ends = [visit.enter for plan in plans for visit in plan.visits[-1:]]
        if isinstance(answer, QueryDocument) and answer.plan:
            ends.append(answer.plan[-1][1])
        self.tick = max([self.tick, outcome.case.now, *ends])


def smoke_shortfalls(outcomes: list[Outcome]) -> Iterator[str]:
    """The reasons why the smoke cases are not enough: each that could be asked must be answered."""
    asked = [outcome for outcome in outcomes if outcome.case.stage == "smoke" and outcome.asked]
    silent = [outcome for outcome in asked if not outcome.is_judged]
    if silent:
        first = f"{silent[0].case.name} ({silent[0].skipped})"
        message = f"it did not answer {len(silent)} of {len(asked)} smoke cases, the first of them {first}"
        yield f"{message} [{answers_enough.id}]"


def random_shortfalls(tallies: Mapping[str, Tally]) -> Iterator[str]:
    """The reasons why the random cases are not enough."""
    for op, tally in tallies.items():
        if not answers_enough(tally.answered, tally.asked):
            some = f"it answered {tally.answered} of {tally.asked} random cases of {op}"
            yield f"{some}, and {LEAST_ANSWERED} in 100 are needed [{answers_enough.id}]"
        if not tries_enough(tally.tried, tally.gave_up):
            some = f"it gave up {tally.gave_up} of {tally.tried + tally.gave_up} random cases of {op}"
            yield f"{some}, and may give up {100 - LEAST_TRIED} in 100 [{tries_enough.id}]"
