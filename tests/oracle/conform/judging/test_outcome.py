"""The outcome of one case: a finding, an answer that shows something or nothing, or none."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from tests.oracle.conform.judging.test_one_answer import BEST, HURRIES, OPTIMUM, QUERY, UNDECIDED, goes

from carp_spec import Instance, Refusal, Resource, Solution
from carproof.conform.answers import Reply, Skipped
from carproof.conform.asking.smoke import EAST, FIRST_GOES, committed, row
from carproof.conform.cases import Case
from carproof.conform.findings import Category, Fault, Finding
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.judges import first_finding
from carproof.conform.judging.outcome import Outcome, ask
from carproof.conform.levels import Level
from carproof.conform.programs.function import Function
from carproof.protocol.ops.planning import QueryDocument

CRASH = Finding(Category.CRASH, "program/alive", "it is gone")
GOES, NOBODY, TOO_FAST = goes(*FIRST_GOES), QueryDocument(None), goes(*HURRIES)
OPEN = "it leaves the optimum undecided"


@pytest.mark.parametrize(
    ("reply", "level", "expected"),
    [
        (Fault(CRASH), Level.SOUND, Outcome(QUERY, CRASH)),
        (Skipped(""), Level.SOUND, Outcome(QUERY, skipped="")),
        (Skipped("no words", asked=False), Level.SOUND, Outcome(QUERY, skipped="no words", asked=False)),
        (GOES, Level.COMPLETE_IN_CONTEXT, Outcome(QUERY, None, GOES, effort=Effort.TRIED)),
        (NOBODY, Level.SOUND, Outcome(QUERY, None, NOBODY, effort=Effort.GAVE_UP)),
        (TOO_FAST, Level.SOUND, Outcome(QUERY, first_finding(QUERY, TOO_FAST, Level.SOUND), TOO_FAST)),
        (BEST, Level.OPTIMAL, Outcome(OPTIMUM, None, BEST, effort=Effort.TRIED)),
        (UNDECIDED, Level.OPTIMAL, Outcome(OPTIMUM, None, UNDECIDED, OPEN)),
    ],
)
def test_a_reply_within_its_time_is_judged_or_counts_as_none(
    reply: Reply | Fault, level: Level, expected: Outcome
) -> None:
    def reply_within(case: Case, seconds: float | None) -> Reply:
        assert (case, seconds) == (expected.case, 0.5)
        if isinstance(reply, Fault):
            raise reply
        return reply

    subject: Any = SimpleNamespace(ask=reply_within)
    found = ask(subject, expected.case, level, 0.5)
    assert replace(found, seconds=0.0) == expected
    assert 0 < found.seconds < 60


@pytest.mark.parametrize("resources", [1, 30])
def test_what_the_compiled_planner_refuses_is_not_judged(resources: int) -> None:
    """The reference, which small instances are compared with, has no largest tick."""
    graph = row([EAST]).graph
    slow = tuple(Resource(id, duration=10**10) for id in range(resources))
    instance = row([replace(EAST, pace=10**10)])
    asked = replace(QUERY, instance=replace(instance, graph=replace(graph, resources=(*graph.resources, *slow))))
    subject: Any = SimpleNamespace(ask=lambda *_: NOBODY)
    found = ask(subject, asked, Level.COMPLETE_IN_CONTEXT)
    if resources == 1:
        assert found.fault.rule == "query/complete"
    else:
        assert (found.finding, found.effort) == (None, None)
        assert (found.skipped or "").startswith("carproof cannot judge it")


def test_a_refusal_about_a_small_instance_is_no_outcome() -> None:
    graph = row([EAST]).graph
    full = replace(graph, resources=(*graph.resources, Resource("full", capacity=0)))
    asked = replace(QUERY, instance=replace(QUERY.instance, graph=full))
    subject: Any = SimpleNamespace(ask=lambda *_: NOBODY)
    with pytest.raises(Refusal):
        ask(subject, asked, Level.COMPLETE_IN_CONTEXT)


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
    assert fault_of(planner).rule == "program/result"
    for returned, words in ((object(), "cannot be written as JSON"), ({**written, "plans": 1}, "the result of plan")):
        finding = fault_of(lambda _, returned=returned: returned, documents=True)
        assert finding.rule == "program/result"
        assert words in finding.message


def test_a_function_gets_an_instance_of_its_own() -> None:
    asked: list[Instance] = []
    function = Function(lambda instance: (asked.append(instance), PLANNED)[1], "mine")  # type: ignore[func-returns-value]
    assert (function.name, function.ops) == ("mine", ("plan",))
    assert function.ask(ALONE) == PLANNED
    assert (asked, asked[0] is ALONE.instance) == ([ALONE.instance], False)


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
