"""Counts of a run, what they decide, and which cases are asked."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import pytest
from tests.oracle.test_conform_judges import Tampered, as_it_is, no_plan

from carp_spec import Robot
from carproof.conform import run
from carproof.conform.answers import Reply, Skipped
from carproof.conform.asking.smoke import EAST, row, smoke_cases
from carproof.conform.asking.vector_cases import vector_cases
from carproof.conform.cases import Case, Stage
from carproof.conform.findings import (
    Category,
    Fault,
    Finding,
    all_arrive,
    answers_enough,
    are_ready,
    is_accepted,
    is_alive,
    is_complete,
    is_lower,
    is_optimal,
    is_response,
    tries_enough,
    wrong,
)
from carproof.conform.judging.deciding import Tally
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.outcome import Outcome
from carproof.conform.levels import EXECUTOR_LEVELS, JUDGED_OPS, Level
from carproof.conform.run import MOST_FAULTS, Options, Report, conform
from carproof.formats.movingai_writer import is_classical
from carproof.protocol.ops.planning import QueryDocument

ALONE = row([EAST])
NOBODY = QueryDocument(None)
WRONG = wrong("plan/move", "it jumps")
CRASH = Finding(Category.CRASH, "program/alive", "it is gone")


def case(stage: Stage = "random", op: str = "query", robots: int = 0, name: str = "one") -> Case:
    return Case(stage, name, op, row([Robot(number, "a", "b") for number in range(robots)]))


def tried(stage: Stage = "random", op: str = "query", effort: Effort = Effort.TRIED) -> Outcome:
    return Outcome(case(stage, op), None, NOBODY, effort=effort)


def skipped(stage: Stage = "random", op: str = "query") -> Outcome:
    return Outcome(case(stage, op), skipped="no time")


def not_asked(stage: Stage = "random", op: str = "query") -> Outcome:
    return Outcome(case(stage, op), skipped="no words", asked=False)


def failed(stage: Stage = "random", op: str = "query", finding: Finding = WRONG, robots: int = 0) -> Outcome:
    return Outcome(case(stage, op, robots), finding, NOBODY)


def tally(*outcomes: Outcome) -> Tally:
    counted = Tally()
    for outcome in outcomes:
        counted.add(outcome)
    return counted


def report(level: Level, *outcomes: Outcome) -> Report:
    made = Report(Options(level))
    for outcome in outcomes:
        made.add(outcome)
    return made


def test_a_tally_counts_right_answers_of_cases_that_could_be_asked() -> None:
    outcomes = (tried(), tried(effort=Effort.GAVE_UP), tried(effort=Effort.NOTHING_TO_DO), skipped(), not_asked())
    counted = tally(*outcomes, failed())
    assert (counted.asked, counted.answered, counted.tried, counted.gave_up) == (5, 3, 1, 1)
    assert str(counted) == "3 of 5, 1 given up"
    assert str(tally(tried(), tried())) == "2 of 2"


@pytest.mark.parametrize(
    ("outcomes", "conforms"),
    [
        ((tried(),), True),
        ((tried("smoke"), tried()), True),
        ((tried("smoke"),), None),
        ((tried("smoke"), tried(effort=Effort.NOTHING_TO_DO)), None),
        ((skipped("smoke"), tried()), False),
        ((*[tried()] * 9, skipped()), True),
        ((*[tried()] * 8, skipped()), False),
        ((tried(), tried(effort=Effort.GAVE_UP)), True),
        ((tried(), *[tried(effort=Effort.GAVE_UP)] * 2), False),
        ((tried(), not_asked(), not_asked("smoke"), skipped("vectors")), True),
        ((failed("smoke"), tried()), False),
        ((tried(op="bound"),), False),
        ((), False),
    ],
)
def test_counts_decide_whether_a_program_conforms(outcomes: Sequence[Outcome], conforms: bool | None) -> None:
    made = report(Level.CONTEXT_OPTIMAL, *outcomes)
    assert made.conforms is conforms
    assert made.reaches_level == (conforms is True or bool(made.findings))


def test_answers_to_the_ops_of_the_level_are_counted() -> None:
    outcomes = (tried(), tried("smoke", "plan"), failed("vectors"), tried(op="bound"), skipped(), not_asked())
    assert report(Level.CONTEXT_OPTIMAL, *outcomes).tested == 3


def test_an_interruption_leaves_undecided_what_is_not_wrong() -> None:
    for outcomes, conforms in (((tried(),), None), ((skipped("smoke"),), None), ((failed("smoke"),), False)):
        made = report(Level.SOUND, *outcomes)
        made.interrupted = True
        assert (made.conforms, made.shortfalls) == (conforms, [])


def test_a_level_is_shown_by_its_own_ops_and_by_plan_where_whole_instances_are_asked() -> None:
    for level in Level:
        for op in ("check", "query", "plan", "add", "polish", "optimum", "bound"):
            made = report(level, tried("smoke", op), tried(op=op))
            assert made.conforms is (op in JUDGED_OPS[level])
    assert Options(Level.OPTIMAL, whole=True).ops == ("plan",)
    assert Options(executor=True).ops == ("execute",)
    assert Options(executor=True).statement == EXECUTOR_LEVELS[Level.SOUND] != Options().statement
    assert report(Level.OPTIMAL, tried("smoke", "optimum"), tried(op="check")).conforms is None


def test_of_failures_of_one_rule_the_smallest_is_shown_and_counted_once() -> None:
    made = report(Level.SOUND, failed("smoke", robots=3), failed("vectors", robots=2), tried("smoke"))
    made.add(failed("vectors", finding=CRASH, robots=5))
    assert [len(outcome.case.instance.robots) for outcome in made.failures] == [2, 5]
    made.smallest = failed(robots=1)
    assert [len(outcome.case.instance.robots) for outcome in made.failures] == [1, 5]
    made.faults.append(CRASH)
    assert made.findings == [CRASH, WRONG, CRASH]
    assert made.processes_lost == 1


def test_each_rule_of_programs_is_kept_and_broken_where_it_says() -> None:
    assert [is_alive(code) for code in (None, 0, 1, -9)] == [True, True, False, False]
    assert [is_response({"id", name}) for name in ("result", "skipped", "error", "more")] == [True, True, True, False]
    assert not is_response({"id", "result", "error"})
    assert [is_accepted(given) for given in (None, "", "why")] == [True, False, False]
    assert [is_optimal(*costs) for costs in ((3, 3), (None, None), (4, 3), (2, 3), (None, 3), (3, None))] == (
        [True, True, False, False, False, False]
    )
    assert [is_complete(*given) for given in ((0, 3), (0, None), (1, None), (1, 3), (1, 0))] == (
        [True, True, True, False, False]
    )
    assert [is_lower(*bounds) for bounds in ((3, 3), (2, 3), (4, 3), (4, None), (1, 0))] == (
        [True, True, False, True, False]
    )
    assert [
        are_ready(*given) for given in ((["a"], ["a", "b"]), (["a"], ["a"]), (["c"], ["a"]), (["a", "a"], ["a"]))
    ] == ([True, True, False, False])
    assert [all_arrive(standing) for standing in ([], ["a"])] == [True, False]
    assert [answers_enough(answered, 1000) for answered in (899, 900, 901)] == [False, True, True]
    assert [tries_enough(*counts) for counts in ((0, 0), (500, 500), (499, 501), (501, 499))] == (
        [True, True, False, True]
    )


class Scripted(Tampered):
    """A subject that fails where it is asked to, and remembers each call."""

    def __init__(self, **fails: BaseException) -> None:
        super().__init__(as_it_is)
        self.ops = ("query",)
        self.fails = fails
        self.calls: list[str] = []

    def _call(self, name: str) -> None:
        self.calls.append(name)
        if name in self.fails:
            raise self.fails[name]

    def start(self) -> None:
        self._call("start")

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        self._call("ask")
        return super().ask(case, seconds)

    def finish(self) -> None:
        self._call("finish")
        self.name = "renamed"

    def kill(self) -> None:
        self._call("kill")


@pytest.fixture(name="few")
def few_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four smoke cases, and one vector."""
    monkeypatch.setattr(run, "smoke_cases", lambda *each: list(smoke_cases(*each))[:4])
    monkeypatch.setattr(run, "vector_cases", lambda *each: list(vector_cases(*each))[:1])


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize(
    ("fails", "calls", "rules", "interrupted"),
    [
        ({}, ["start", *["ask"] * 5, "finish", "kill"], [], False),
        ({"start": Fault(CRASH)}, ["start", "kill"], ["program/alive"], False),
        ({"finish": Fault(CRASH)}, ["start", *["ask"] * 5, "finish", "kill"], ["program/alive"], False),
        ({"ask": Fault(CRASH)}, ["start", *["ask"] * MOST_FAULTS, "finish", "kill"], ["program/alive"], False),
        ({"ask": KeyboardInterrupt()}, ["start", "ask", "kill"], [], True),
    ],
)
def test_whatever_happens_there_is_a_report_and_the_subject_is_ended(
    fails: dict[str, BaseException], calls: list[str], rules: list[str], interrupted: bool
) -> None:
    subject, asked = Scripted(**fails), []
    made = conform(subject, Options(examples=0), lambda: asked.append(1))
    assert subject.calls == calls
    assert [finding.rule for finding in made.findings] == rules
    assert made.interrupted is interrupted
    assert len(asked) == (0 if interrupted else calls.count("ask"))
    assert made.program == subject.name


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize(
    ("ops", "examples", "asked"),
    [
        (("query",), 5, {"query": 5}),
        (("query", "plan"), 5, {"query": 2, "plan": 3}),
        (("query", "plan", "check"), 2, {"query": 1, "plan": 1}),
    ],
)
def test_random_cases_are_shared_out_among_the_ops(
    ops: tuple[str, ...], examples: int, asked: dict[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "smoke_cases", lambda *_: [])
    monkeypatch.setattr(run, "vector_cases", lambda *_: [])
    subject = Tampered(as_it_is, ops)
    advanced: list[int] = []
    made = conform(subject, Options(examples=examples, seed=3), lambda: advanced.append(1))
    assert sum(count.asked for count in made.tallies.values()) == len(advanced) == examples
    assert sorted(count.asked for count in made.tallies.values()) == sorted(asked.values())


@pytest.mark.usefixtures("few")
def test_a_kernel_that_decides_is_asked_about_fixed_and_random_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Stage] = []
    monkeypatch.setattr("carproof.conform.judging.outcome.require_agreement", lambda case, *_: asked.append(case.stage))
    for kernel, by, counts in (
        (None, "carp_spec", {}),
        ("carproof-kernel 7", "carproof-kernel 7", {"smoke": 4, "vectors": 1, "random": 3}),
    ):
        subject = Tampered(as_it_is, ("query",))
        options = Options(examples=3, kernel=kernel)
        conform(subject, options)
        assert (Counter(asked), options.by) == (counts, by)


@pytest.mark.usefixtures("few")
def test_after_the_first_random_failure_the_smallest_is_looked_for_alone() -> None:
    def fails(asked: Case, reply: Reply) -> Reply:
        return no_plan(asked, reply) if asked.stage == "random" else reply

    subject = Tampered(fails, ("query", "plan"))
    made = conform(subject, Options(Level.COMPLETE, examples=40, seed=1, shrink_seconds=30))
    assert made.smallest is not None
    assert made.random["wrong answer"] == 1
    assert [finding.rule for finding in made.findings] == ["query/complete"]
    assert len(made.smallest.case.instance.robots) == 1


@pytest.mark.usefixtures("few")
def test_planners_of_whole_instances_are_asked_classical_ones_if_they_are_classical() -> None:
    asked: list[Case] = []

    class Silent(Tampered):
        def ask(self, case: Case, seconds: float | None = None) -> Reply:
            del seconds
            asked.append(case)
            return Skipped("no time")

    for classical in (False, True):
        subject = Silent(as_it_is)
        subject.ops = ("plan",)
        conform(subject, Options(examples=3, whole=True, classical=classical))
    assert {(each.op, each.planner) for each in asked} == {("plan", None)}
    half = len(asked) // 2
    assert [each.classical for each in asked] == [False] * half + [True] * half
    drawn = [each.instance for each in asked[half:] if each.stage == "random"]
    assert all(is_classical(each) for each in drawn)


@pytest.mark.usefixtures("few")
def test_saved_cases_of_ops_that_are_offered_are_asked_before_all_others() -> None:
    subject = Tampered(as_it_is, ("query",))
    saved = [replace(each, stage="saved", robot="new", instance=ALONE) for each in (case(), case(op="plan"), case())]
    made = conform(subject, Options(examples=0), saved=saved)
    assert [each.case.stage for each in made.outcomes] == ["saved", "saved", *["smoke"] * 4, "vectors"]
