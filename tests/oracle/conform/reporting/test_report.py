"""Counts of a run, what they decide, and which cases are asked."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import pytest
from tests.oracle.conform.judging.test_judges import Tampered, as_it_is, no_plan

from carp_spec import Resource, Robot
from carp_spec.documents.solutions import solution_document
from carproof.conform import run
from carproof.conform.answers import Answer, Reply
from carproof.conform.asking.smoke import committed, row, smoke_cases
from carproof.conform.asking.vector_cases import vector_cases
from carproof.conform.cases import Case, Stage
from carproof.conform.findings import Category, Finding, wrong
from carproof.conform.judging.deciding import Extent
from carproof.conform.judging.gave_up import Effort
from carproof.conform.judging.outcome import Outcome
from carproof.conform.levels import EXECUTOR_LEVELS, JUDGED_OPS, Level
from carproof.conform.run import Options, Report, conform
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument, query_document

NOBODY = QueryDocument(None)
WRONG = wrong("plan/move", "it jumps")
ARRIVES_AT = {tick: committed(row([]), new=[("a", 0, tick), ("b", tick, tick + 4)]) for tick in (5, 8)}
SLOW = replace(row([]).graph, resources=(Resource("a", duration=6), *row([]).graph.resources[1:]))
WRITTEN = solution_document(ARRIVES_AT[8])
CRASH = Finding(Category.CRASH, "program/alive", "it is gone")


def case(stage: Stage = "random", op: str = "query", robots: int = 0) -> Case:
    return Case(stage, "one", op, row([Robot(number, "a", "b") for number in range(robots)]))


def tried(stage: Stage = "random", op: str = "query", effort: Effort = Effort.TRIED) -> Outcome:
    return Outcome(case(stage, op), None, NOBODY, effort=effort)


def skipped(stage: Stage = "random", op: str = "query") -> Outcome:
    return Outcome(case(stage, op), skipped="no time")


def not_asked(stage: Stage = "random", op: str = "query") -> Outcome:
    return Outcome(case(stage, op), skipped="no words", asked=False)


def failed(stage: Stage = "random", op: str = "query", finding: Finding = WRONG, robots: int = 0) -> Outcome:
    return Outcome(case(stage, op, robots), finding, NOBODY)


def report(level: Level, *outcomes: Outcome) -> Report:
    made = Report(Options(level))
    for outcome in outcomes:
        made.add(outcome)
    return made


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


def test_the_extent_is_of_right_answers_in_which_there_was_something_to_do() -> None:
    """Nothing is shown beyond it."""
    small = replace(case(robots=2), now=3)
    wide = replace(case(robots=1), instance=row([Robot(0, "a", "b", pace=7)], capacity="9111"), solution=ARRIVES_AT[5])
    slow = replace(case(), instance=replace(row([]), graph=SLOW))
    right = [Outcome(each, None, NOBODY, effort=Effort.TRIED) for each in (small, wide, slow)]
    largest = replace(small, instance=row([Robot(id, "a", "b", pace=99) for id in range(9)]), now=999)
    others = [Outcome(largest, None, NOBODY, effort=each) for each in (Effort.GAVE_UP, Effort.NOTHING_TO_DO, None)]
    assert report(Level.SOUND, *others, Outcome(largest, WRONG, NOBODY)).extent == Extent()
    assert report(Level.SOUND, *right, *others).extent == Extent(2, 4, 9, 6, 7, 5)


@pytest.mark.parametrize(
    "answer", [ARRIVES_AT[8], query_document(ARRIVES_AT[8].plans[0]), OptimumDocument(8, 8, True, WRITTEN)]
)
def test_the_extent_has_the_last_tick_of_an_answer(answer: Answer) -> None:
    assert report(Level.SOUND, Outcome(case(), None, answer, effort=Effort.TRIED)).extent.tick == 8


def test_a_wrong_answer_is_not_counted_as_a_right_one() -> None:
    tally = report(Level.SOUND, failed(), tried(), skipped(), not_asked()).tallies["query"]
    assert (tally.asked, tally.answered, tally.tried) == (3, 1, 1)


def test_a_right_answer_without_resources_counts() -> None:
    """A failure may shrink to nothing, and is asked again once the program is mended."""
    nothing = Case("saved", "one", "check", row([], cells=""))
    assert report(Level.SOUND, Outcome(nothing, None, NOBODY, effort=Effort.TRIED)).outcomes


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
            assert made.conforms or made.shortfalls[0].startswith("it offers nothing that shows the level")
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


@pytest.fixture(name="few")
def few_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four smoke cases, and one vector."""
    monkeypatch.setattr(run, "smoke_cases", lambda *each: list(smoke_cases(*each))[:4])
    monkeypatch.setattr(run, "vector_cases", lambda *each: list(vector_cases(*each))[:1])


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize(
    ("ops", "examples", "asked"), [("query", 5, [5]), ("query plan", 5, [2, 3]), ("query plan check", 2, [1, 1])]
)
def test_random_cases_are_shared_out_among_the_ops(ops: str, examples: int, asked: list[int]) -> None:
    made = conform(Tampered(as_it_is, tuple(ops.split())), Options(examples=examples, seed=3))
    assert sorted(count.asked for count in made.tallies.values()) == asked


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
