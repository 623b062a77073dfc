"""The search for a case that fails, and for a smaller one that fails in the same way."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest

from carp_spec import Carp, Group, Neighbourhood, Planner, Robot, Solution
from carproof.conform import shrinking
from carproof.conform.asking.smoke import row
from carproof.conform.cases import Case
from carproof.conform.findings import Category, Finding, wrong
from carproof.conform.judging.outcome import Outcome
from carproof.conform.shrinking import FailureSearch
from carproof.conform.smaller import smallest

MOST = 12
JUMPS, LATE = wrong("plan/move", "it jumps"), wrong("query/optimal", "it is late")
NO_ANSWER = Finding(Category.TIMEOUT, "program/in-time", "no answer")
Judge = Callable[[int], Finding | None]


def case(robots: int) -> Case:
    return Case("random", "query", "query", row([Robot(number, "a", "b") for number in range(robots)]))


class Asked:
    """Asks by a judge of the number of robots, and remembers the numbers and the limits of time."""

    def __init__(self, judge: Judge, taken: float = 0.0) -> None:
        self.judge = judge
        self.taken = taken
        self.cases: list[Case] = []
        self.robots: list[int] = []
        self.limits: list[float | None] = []
        self.outcomes: list[Outcome] = []

    def __call__(self, asked: Case, seconds: float | None) -> Outcome:
        self.cases.append(asked)
        self.robots.append(len(asked.instance.robots))
        self.limits.append(seconds)
        self.outcomes.append(Outcome(asked, self.judge(self.robots[-1]), seconds=self.taken))
        return self.outcomes[-1]


UP_AND_DOWN = (0, 2, 1, 7, 4, MOST, *range(MOST))


def search(
    asked: Asked, robots: Sequence[int] = UP_AND_DOWN, shrink_seconds: float = 60.0, limit: float = 5.0
) -> FailureSearch:
    made = FailureSearch(asked, limit, shrink_seconds)
    made.run(map(case, robots))
    return made


def best(made: FailureSearch) -> tuple[int, Finding | None]:
    assert made.best is not None
    return len(made.best.case.instance.robots), made.best.finding


@pytest.mark.parametrize("least", [0, 1, 3])
def test_the_smallest_case_that_fails_is_found(least: int) -> None:
    asked = Asked(lambda robots: JUMPS if robots >= least else None)
    made = search(asked)
    assert (best(made), made.minimal, made.repeats) == ((least, JUMPS), True, True)


@pytest.mark.parametrize(
    "other", [LATE, wrong("plan/goal", "it jumps"), Finding(Category.CRASH, "plan/move", "it jumps")]
)
def test_a_case_that_fails_otherwise_is_no_smaller_one(other: Finding) -> None:
    asked = Asked(lambda robots: JUMPS if robots >= 6 else other if max(asked.robots) >= 6 else None)
    assert best(search(asked)) == (6, JUMPS)
    assert min(asked.robots[asked.robots.index(max(asked.robots)) :]) < 6, "smaller ones were asked"


def test_what_may_not_be_asked_or_was_asked_is_not_asked() -> None:
    asked = Asked(lambda robots: JUMPS if robots else None)
    made = FailureSearch(asked, 5.0, 60.0, may_ask=lambda each: len(each.instance.robots) % 2 == 0)
    made.run([case(8)])
    assert (best(made), [each for each in asked.robots if each % 2]) == ((2, JUMPS), [])
    assert len({*asked.cases}) == len(asked.cases) - 1, "each is asked once, and the smallest once more"


def test_without_time_to_shrink_the_first_failure_stays() -> None:
    asked = Asked(lambda robots: JUMPS if robots >= 3 else None)
    made = search(asked, shrink_seconds=0.0)
    assert (best(made), made.minimal) == ((asked.robots[-1], JUMPS), False)
    *before, first, again = asked.robots
    assert max(before) < 3 < first == again, "and it is asked once more"


def test_smaller_failures_are_looked_for_until_the_time_is_over(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked(lambda robots: JUMPS if robots >= 9 else None)
    monkeypatch.setattr(shrinking, "monotonic", lambda: 100.0 + 10 * len(asked.robots))
    search(asked, shrink_seconds=25.0)
    assert asked.limits.count(None) == len(asked.limits) - 3


@pytest.mark.parametrize("finding", [JUMPS, NO_ANSWER])
def test_a_failure_that_does_not_come_again_stays_and_nothing_is_said_of_its_size(finding: Finding) -> None:
    asked = Asked(lambda robots: finding if asked.robots.count(robots) == 1 and len(asked.robots) == 4 else None)
    made = search(asked)
    assert best(made) == (asked.robots[3], finding)
    assert (made.minimal, made.repeats) == (False, False)


def test_a_small_wrong_answer_that_does_not_come_again_stays() -> None:
    asked = Asked(
        lambda robots: JUMPS if robots >= 3 and (asked.limits[-1] is not None or robots == max(asked.robots)) else None
    )
    made = search(asked)
    assert (best(made), made.repeats, made.minimal) == ((3, JUMPS), False, False)


def test_a_robot_that_a_solution_names_and_the_instance_does_not_have_stays_while_all_else_goes() -> None:
    named = replace(case(2), op="check", solution=Solution((), (), ("r0", "r1", "nobody")))
    found, is_minimal = smallest(named, lambda each: "nobody" in each.solution.unplanned, lambda: False)
    assert (len(found.instance.graph.resources), found.solution.unplanned, is_minimal) == (0, ("nobody",), True)


@pytest.mark.parametrize(("op", "simple"), [("plan", Carp()), ("add", Neighbourhood())])
def test_the_simplest_planner_that_fails_is_asked(op: str, simple: Planner) -> None:
    asked = replace(case(1), op=op, planner=Neighbourhood(m=3, sample=2, seed=5))
    assert smallest(asked, lambda _: True, lambda: False)[0].planner == simple
    assert smallest(asked, lambda each: each.planner == asked.planner, lambda: False)[0].planner == asked.planner


def test_of_groups_resources_and_room_stay_that_the_failure_needs() -> None:
    grouped = case(2)
    ids = tuple(grouped.instance.graph.index)
    groups = Group("needed", ids, 5), Group("not", ids[:1], 3)
    graph = replace(grouped.instance.graph, groups=groups)
    grouped = replace(grouped, instance=replace(grouped.instance, graph=graph))
    found, is_minimal = smallest(
        grouped,
        lambda each: any(
            group.capacity > 1 and ids[0] in group.resources and group.id == "needed"
            for group in each.instance.graph.groups
        ),
        lambda: False,
    )
    assert (found.instance.graph.groups, is_minimal) == ((Group("needed", ids[:1], 2),), True)


@pytest.mark.parametrize(
    ("taken", "limit", "given"), [(0.0, 5.0, 0.25), (0.1, 5.0, 2.0), (0.1, 1.0, 1.0), (3.0, 5.0, 5.0)]
)
def test_smaller_cases_get_as_much_time_as_right_answers_took_and_some_more(
    taken: float, limit: float, given: float
) -> None:
    asked = Asked(lambda robots: JUMPS if robots >= 5 else None, taken)
    search(asked, limit=limit)
    assert any(robots < 5 for robots in asked.robots[: asked.limits.index(given)]), "a right answer came first"
    assert {seconds for seconds in asked.limits if seconds is not None} == {given}


def test_the_smallest_that_takes_too_long_is_asked_once_more_with_all_the_time() -> None:
    asked = Asked(lambda robots: NO_ANSWER if robots >= 2 else None)
    made = search(asked)
    assert best(made) == (2, NO_ANSWER)
    assert (asked.robots[-1], asked.limits[-1]) == (2, None)
    assert made.best is asked.outcomes[-1], "what is shown is the answer with all the time"


@pytest.mark.parametrize("other", [None, LATE, replace(LATE, category=Category.CRASH)])
def test_one_that_does_not_fail_alike_with_all_the_time_is_given_up_for_the_first(other: Finding | None) -> None:
    asked = Asked(
        lambda robots: (
            NO_ANSWER
            if robots >= 9 or asked.limits[-1] is not None
            else other
            if robots < 9 < max(asked.robots)
            else None
        )
    )
    made = search(asked)
    assert best(made)[1] == NO_ANSWER
    assert best(made)[0] >= 9
    assert (made.repeats, made.minimal) == (True, False), "the first is asked once more too"
