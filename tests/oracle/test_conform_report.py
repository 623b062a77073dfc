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
from carproof.conform.judging.claims import Claims
from carproof.conform.judging.deciding import Tally, random_shortfalls, smoke_shortfalls
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.outcome import Outcome
from carproof.conform.levels import EXECUTOR_LEVELS, JUDGED_OPS, Level
from carproof.conform.run import MOST_FAULTS, Options, Report, conform, label
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


def crashed() -> Outcome:
    return Outcome(case(), CRASH)


def undecided() -> Outcome:
    return Outcome(case(), None, NOBODY, "it leaves the optimum undecided")


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
    ("efforts", "decides"),
    [((), False), ((Effort.NOTHING_TO_DO,), False), ((Effort.GAVE_UP,), True), ((Effort.TRIED,), True)],
)
def test_a_tally_decides_where_there_was_something_to_do(efforts: Sequence[Effort], decides: bool) -> None:
    assert tally(*(tried(effort=effort) for effort in efforts)).decides is decides


def test_smoke_cases_that_could_be_asked_must_be_answered() -> None:
    assert list(smoke_shortfalls([tried("smoke"), not_asked("smoke"), skipped(), skipped("vectors")])) == []
    silent = Outcome(case("smoke", name="two"), skipped="too hard")
    (shortfall,) = smoke_shortfalls([tried("smoke"), skipped("smoke"), silent, not_asked("smoke")])
    assert shortfall == "it did not answer 2 of 3 smoke cases, the first of them one (no time) [program/answers]"


def test_nine_in_ten_random_cases_of_each_op_must_be_answered_and_half_of_them_tried() -> None:
    gave_up = tried(effort=Effort.GAVE_UP)
    assert list(random_shortfalls({"query": tally(*[tried()] * 9, skipped()), "add": tally(tried(), gave_up)})) == []
    few: dict[str, Tally] = {
        "query": tally(tried()),
        "plan": tally(*[tried()] * 8, skipped()),
        "add": tally(tried(), gave_up, gave_up),
    }
    assert list(random_shortfalls(few)) == [
        "it answered 8 of 9 random cases of plan, and 90 in 100 are needed [program/answers]",
        "it gave up 2 of 3 random cases of add, and may give up 50 in 100 [program/tries]",
    ]


@pytest.mark.parametrize(
    ("outcome", "words"),
    [
        (tried(), "passed"),
        (tried(effort=Effort.NOTHING_TO_DO), "passed"),
        (tried(effort=Effort.GAVE_UP), "gave up"),
        (skipped(), "skipped"),
        (not_asked(), "not asked"),
        (failed(), "wrong answer"),
        (crashed(), "crash"),
        (undecided(), "skipped"),
    ],
)
def test_random_cases_are_counted_by_what_came_of_them(outcome: Outcome, words: str) -> None:
    assert label(outcome) == words
    made = report(Level.SOUND, outcome, outcome, tried("smoke"))
    assert made.random == {words: 2}
    assert made.judged["query"] == 1 + 2 * (words in ("passed", "gave up", "wrong answer"))
    assert list(made.tallies) == ["query"]
    assert len(made.outcomes) == 1


@pytest.mark.parametrize(
    ("outcomes", "conforms"),
    [
        ((tried(),), True),
        ((tried("smoke"), tried()), True),
        ((tried("smoke"),), None),
        ((tried("smoke"), tried(effort=Effort.NOTHING_TO_DO)), None),
        ((skipped("smoke"), tried()), False),
        ((tried(), skipped()), False),
        ((tried(effort=Effort.GAVE_UP),), False),
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


@pytest.mark.parametrize(
    ("level", "ops"),
    [
        (Level.COMPLETE_IN_CONTEXT, "query or plan or add"),
        (Level.COMPLETE, "optimum (level complete-in-context: query or plan or add)"),
        (Level.OPTIMAL, "optimum"),
    ],
)
def test_where_no_op_of_the_level_is_offered_they_are_named(level: Level, ops: str) -> None:
    (shortfall,) = report(level, tried(op="check")).shortfalls
    expected = f"it offers nothing that shows the level {level.label}: its answer to start must name {ops}"
    assert shortfall == expected


def test_an_interruption_leaves_undecided_what_is_not_wrong() -> None:
    for outcomes, conforms in (((tried(),), None), ((skipped("smoke"),), None), ((failed("smoke"),), False)):
        made = report(Level.SOUND, *outcomes)
        made.interrupted = True
        assert (made.conforms, made.shortfalls) == (conforms, [])


def test_where_something_is_wrong_nothing_is_called_missing() -> None:
    assert report(Level.SOUND, failed("smoke"), skipped("smoke")).shortfalls == []


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


def test_findings_of_one_category_and_rule_are_of_one_fault() -> None:
    assert [str(category) for category in Category] == ["wrong answer", "crash", "timeout", "protocol error"]
    jumps = wrong("plan/move", "it jumps")
    assert jumps.key == wrong("plan/move", "it flies").key
    assert jumps.key != wrong("plan/goal", "it jumps").key
    assert jumps.key != replace(jumps, category=Category.CRASH).key


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


def test_smoke_cases_are_tallied_alone() -> None:
    made = report(Level.SOUND, tried("smoke"), skipped("smoke"), tried("saved"), tried("vectors"), tried())
    assert str(made.smoke) == "1 of 2"


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
def test_what_is_not_claimed_is_not_asked_and_counts_for_nothing() -> None:
    subject = Tampered(as_it_is, ("query",))
    asked = subject.cases
    made = conform(subject, Options(examples=5, claims=Claims(frozenset(["vanish"]))))
    assert [each.instance.after_goal for each in asked] == ["park"] * len(asked)
    left_out = [each for each in made.outcomes if each.case.instance.after_goal == "vanish"]
    assert {(each.skipped, each.asked) for each in left_out} == {("it does not claim vanish", False)}
    assert len(asked) == len(made.outcomes) - len(left_out) + 5


@pytest.mark.usefixtures("few")
def test_saved_cases_of_ops_that_are_offered_are_asked_before_all_others() -> None:
    subject = Tampered(as_it_is, ("query",))
    saved = [replace(each, stage="saved", robot="new", instance=ALONE) for each in (case(), case(op="plan"), case())]
    made = conform(subject, Options(examples=0), saved=saved)
    assert [each.case.stage for each in made.outcomes] == ["saved", "saved", *["smoke"] * 4, "vectors"]
