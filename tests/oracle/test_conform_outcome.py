"""The outcome of one case: a finding, an answer that shows something or nothing, or none."""

from dataclasses import replace
from typing import Any

import pytest
from tests.oracle.test_conform_judges import Tampered, as_it_is
from tests.oracle.test_conform_one_answer import BEST, OPTIMUM, PLAN, QUERY, UNDECIDED, goes

from carp_spec import Instance, Solution
from carproof.conform.answers import Reply, Skipped
from carproof.conform.asking.smoke import EAST, FIRST_GOES, committed, row
from carproof.conform.cases import Case
from carproof.conform.findings import Category, Fault, Finding, wrong
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.outcome import Outcome, ask
from carproof.conform.levels import Level
from carproof.conform.programs.function import Function
from carproof.protocol.ops.planning import QueryDocument

CRASH = Finding(Category.CRASH, "program/alive", "it is gone")
GOES, NOBODY = goes(*FIRST_GOES), QueryDocument(None)
COMPLETE, OPTIMAL = Level.COMPLETE_IN_CONTEXT, Level.OPTIMAL


class Answering(Tampered):
    """A subject that gives one reply, and remembers how many seconds it was given."""

    def __init__(self, reply: Reply | Fault) -> None:
        super().__init__(as_it_is)
        self.reply = reply
        self.given: list[float | None] = []

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        del case
        self.given.append(seconds)
        if isinstance(self.reply, Fault):
            raise self.reply
        return self.reply


def without_seconds(found: Outcome) -> tuple[Any, ...]:
    assert 0 <= found.seconds < 60
    return found.finding, found.answer, found.skipped, found.asked, found.effort, found.is_judged


@pytest.mark.parametrize(
    ("asked", "reply", "level", "expected"),
    [
        (QUERY, Fault(CRASH), COMPLETE, (CRASH, None, None, True, None, True)),
        (QUERY, Skipped("no time"), COMPLETE, (None, None, "no time", True, None, False)),
        (QUERY, Skipped(""), COMPLETE, (None, None, "", True, None, False)),
        (QUERY, Skipped("no words", asked=False), COMPLETE, (None, None, "no words", False, None, False)),
        (QUERY, GOES, COMPLETE, (None, GOES, None, True, Effort.TRIED, True)),
        (QUERY, NOBODY, Level.SOUND, (None, NOBODY, None, True, Effort.GAVE_UP, True)),
        (OPTIMUM, BEST, OPTIMAL, (None, BEST, None, True, Effort.TRIED, True)),
        (OPTIMUM, UNDECIDED, OPTIMAL, (None, UNDECIDED, "it leaves the optimum undecided", True, None, False)),
    ],
)
def test_a_reply_is_judged_or_counts_as_none(
    asked: Case, reply: Reply | Fault, level: Level, expected: tuple[Any, ...]
) -> None:
    found = ask(Answering(reply), asked, level)
    assert (found.case, without_seconds(found)) == (asked, expected)


@pytest.mark.parametrize("seconds", [None, 0.5])
def test_a_program_has_the_time_that_it_is_given(seconds: float | None) -> None:
    subject = Answering(GOES)
    ask(subject, QUERY, COMPLETE, seconds)
    assert subject.given == [seconds]


def test_a_failure_subsumes_another_of_its_rule_and_category_does_that_has_all_its_features() -> None:
    jumps, parked = wrong("plan/move", "it jumps"), replace(QUERY, instance=replace(QUERY.instance, after_goal="park"))
    simple, special = Outcome(QUERY, jumps), Outcome(parked, replace(jumps, message="it jumps too"))
    assert simple.subsumes(special)
    assert simple.subsumes(simple)
    assert not special.subsumes(simple)
    for other in (CRASH, *(wrong(rule, "it jumps") for rule in ("plan/goal", "plan/start"))):
        assert not simple.subsumes(Outcome(parked, other))


ALONE = Case("smoke", "one", "plan", row([EAST]))
PLANNED = committed(row([EAST]), new=FIRST_GOES)


def fault_of(planner: Any, documents: bool = False) -> Finding:  # noqa: ANN401 - anything that a person may pass
    with pytest.raises(Fault) as fault:
        Function(planner, "mine", documents).ask(ALONE)
    return fault.value.finding


def test_a_planner_of_documents_is_one_of_models() -> None:
    written = {"format": "carproof-solution/1", "order": ["new"], "unplanned": []}
    plans = [{"robot": "new", "visits": [list(stay) for stay in FIRST_GOES]}]
    seen: list[dict[str, Any]] = []

    def planner(document: dict[str, Any]) -> dict[str, Any]:
        seen.append(document)
        return {**written, "plans": plans}

    assert Function(planner, "mine", documents=True).ask(ALONE) == PLANNED
    assert [each["id"] for each in seen[0]["robots"]] == ["new"]
    for returned, words in ((object(), "cannot be written as JSON"), ({**written, "plans": 1}, "the result of plan")):
        finding = fault_of(lambda _, returned=returned: returned, documents=True)
        assert finding.rule == "program/result"
        assert words in finding.message


def test_a_function_is_asked_for_plans_by_a_planner_of_its_own_alone() -> None:
    asked: list[Instance] = []
    function = Function(lambda instance: (asked.append(instance), PLANNED)[1], "mine")  # type: ignore[func-returns-value]
    assert (function.name, function.ops) == ("mine", ("plan",))
    for other in (QUERY, PLAN, OPTIMUM):
        assert function.ask(other) == Skipped("it plans whole instances, by a planner of its own", asked=False)
    assert asked == []
    assert function.ask(ALONE) == PLANNED
    assert (asked, asked[0] is ALONE.instance) == ([ALONE.instance], False)


def test_a_function_is_judged_by_the_document_of_its_solution() -> None:
    class Other(Solution):
        def __eq__(self, other: object) -> bool:
            return True

        __hash__ = Solution.__hash__

    answer = Function(lambda _: Other(PLANNED.plans, PLANNED.order), "mine").ask(ALONE)
    assert (type(answer), answer) == (Solution, PLANNED)


def test_a_function_that_raises_or_returns_something_else_has_a_fault() -> None:
    def raises(instance: Instance) -> Solution:
        raise SystemExit(f"{len(instance.robots)} robot\nand more")

    crash = fault_of(raises)
    assert (crash.category, crash.rule) == (Category.CRASH, "program/alive")
    assert "1 robot" in crash.message
    assert "Traceback" in crash.stderr
    others: tuple[object, ...] = (None, {}, "solution")
    for returned in others:
        assert fault_of(lambda _, returned=returned: returned).rule == "program/result"
    unreadable = fault_of(lambda _: Solution((object(),), ()))  # type: ignore[arg-type]
    assert (unreadable.rule, unreadable.category) == ("program/result", Category.PROTOCOL_ERROR)

    def interrupted(_: Instance) -> Solution:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        Function(interrupted, "mine").ask(ALONE)
