"""Single answers: by which rule each is refused from which level on, and whether it shows anything."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import msgspec
import pytest
from tests.oracle.conform.judging.test_judges import right_reply
from tests.oracle.judging.test_audit import Wrong

import carp_reference
import carp_verify.bound.verify
from carp_spec import Carp, Greedy, Instance, Neighbourhood, Plan, Planner, Resource, ResourceGraph, Robot, Solution
from carp_spec.documents.solutions import solution_document
from carp_spec.documents.verdicts import VerdictDocument
from carp_verify.bound.rules import ContradictionError
from carproof import BoundDocument
from carproof.conform.answers import Answer
from carproof.conform.asking.smoke import EAST, FIRST, FIRST_GOES, WEST, Stay, committed, passing_place, row
from carproof.conform.cases import Case
from carproof.conform.judging import gave_up as efforts
from carproof.conform.judging import optimum as optima
from carproof.conform.judging.gave_up import Effort, effort, why_undecided
from carproof.conform.judging.judges import first_finding
from carproof.conform.levels import Level
from carproof.optima import OptimumDocument
from carproof.protocol.ops.planning import QueryDocument, query_document
from carproof.testing.mutations import later as moved

Row: TypeAlias = tuple[Case, Answer, Mapping[Level, str | None]]
HURRIES: Sequence[Stay] = (("a", 0, 1), ("b", 1, 1), ("c", 1, 2), ("d", 2, 3))
WESTWARDS: Sequence[Stay] = (("d", 0, 1), ("c", 1, 2), ("b", 2, 3), ("a", 3, 4))
WAITS: Sequence[Stay] = (("a", 0, 4), ("b", 4, 5), ("c", 5, 6), ("d", 6, 7))
BEHIND_GOES: Sequence[Stay] = (("b", 0, 1), ("c", 1, 2), ("d", 2, 3))
ASIDE: Sequence[Stay] = (("a", 0, 1), ("b", 1, 2), ("p", 2, 3), ("b", 3, 4), ("c", 4, 5), ("d", 5, 6))
ALONE = row([EAST])
DIAMOND = Instance(
    ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("b", "d"), ("a", "c"), ("c", "d"))), (EAST,)
)
BEHIND = row([FIRST, Robot("new", "b", "d")])
MEETING = passing_place([FIRST, WEST])
BLOCKED = row([FIRST, WEST])
AMONG_OTHERS = row([Robot("zed", "a", "d"), Robot("new", "b", "d", release=1)])
HEAD_ON = row([FIRST, WEST], capacity="2222")
STANDING = row([EAST, Robot("other", "b", "b")])
ISLANDS = Instance(ResourceGraph((Resource("a"), Resource("b")), ()), (Robot("new", "a", "b"),))
FOUR = row([Robot(id, cell, cell) for id, cell in (("first", "a"), ("new", "b"), ("third", "c"), ("fourth", "d"))])
LAST_FIRST = passing_place(
    [Robot("first", "c", "b"), Robot("second", "p", "c", release=2), Robot("third", "d", "a", release=1)]
)


def case(op: str, instance: Instance, now: int = 0, planner: Planner | None = None, **plans: Sequence[Stay]) -> Case:
    return Case("smoke", "one", op, instance, committed(instance, **plans), "new", now, planner)


def plan(robot: str, *stays: Stay) -> Plan:
    return committed(ALONE, **{robot: stays}).plans[0]


def later(plan: Plan) -> Plan:
    """The plan with one more tick in its first resource."""
    first, *_ = plan.visits
    assert first.leave is not None
    return Plan(plan.robot, (changed(first, leave=first.leave + 1), *moved(plan.visits[1:], 1)))


def goes(*stays: Stay) -> QueryDocument:
    return query_document(plan("new", *stays))


def claimed(cost: int | None, lower: int | None, *, decided: bool, solution: Solution | None) -> OptimumDocument:
    return OptimumDocument(cost, lower, decided, None if solution is None else solution_document(solution))


def in_order(solution: Solution, *order: str) -> Solution:
    return replace(solution, order=order)


right = right_reply
changed = msgspec.structs.replace
QUERY = case("query", ALONE)
QUERY_EXCHANGE = case("query", HEAD_ON, first=FIRST_GOES)
QUERY_UNDER_WAY = case("query", ALONE, 2, new=FIRST_GOES)
QUERY_STANDING = case("query", STANDING, 2, other=[("b", 0, 1)])
QUERY_AMONG_OTHERS = case("query", AMONG_OTHERS, zed=FIRST_GOES)
OTHER_PLAN = plan("new", ("a", 0, 1), ("c", 1, 2), ("d", 2, 3))
OTHER_WAY = query_document(OTHER_PLAN)
QUERIES: Sequence[Row] = (
    (QUERY, goes(*FIRST_GOES), {}),
    (QUERY, QueryDocument(None), {Level.COMPLETE_IN_CONTEXT: "query/complete"}),
    (QUERY, query_document(later(plan("new", *FIRST_GOES))), {Level.CONTEXT_OPTIMAL: "query/optimal"}),
    (QUERY, goes(*HURRIES), {Level.SOUND: "plan/duration"}),
    (case("query", DIAMOND), right(case("query", DIAMOND)), {}),
    (case("query", DIAMOND), OTHER_WAY, {Level.EXACT: "query/ties"}),
    (QUERY_EXCHANGE, right(QUERY_EXCHANGE), {}),
    (QUERY_EXCHANGE, goes(*WESTWARDS), {Level.SOUND: "joint/exchange"}),
    (case("query", BEHIND, first=FIRST_GOES), goes(("b", 0, 2), *BEHIND_GOES[1:]), {Level.SOUND: "plan/contiguous"}),
    (case("query", BLOCKED, first=FIRST_GOES), QueryDocument(None), {}),
    (QUERY_AMONG_OTHERS, QueryDocument(None), {}),
    (QUERY_AMONG_OTHERS, goes(("b", 1, 2), ("c", 2, 3), ("d", 3, 4)), {Level.SOUND: "joint/capacity"}),
    (QUERY_UNDER_WAY, goes(*FIRST_GOES), {}),
    (QUERY_UNDER_WAY, query_document(later(plan("new", *FIRST_GOES))), {Level.SOUND: "fleet/history"}),
    (QUERY_STANDING, right(QUERY_STANDING), {}),
    (QUERY_STANDING, goes(*FIRST_GOES), {Level.SOUND: "fleet/history"}),
    (
        case("query", row([replace(EAST, release=3)]), 2),
        goes(("a", 3, 4), ("b", 4, 5), ("c", 5, 6), ("d", 6, 7)),
        {},
    ),
)
PLAN = case("plan", BEHIND, planner=Carp())
TWO_BLOCKED = case("plan", row([FIRST, WEST, Robot("third", "c", "a")]), planner=Carp())
GREEDY = case("plan", BEHIND, planner=Greedy())
FREE = case("plan", MEETING)
CLASSICAL = replace(FREE, classical=True)
ASIDE_SECOND = in_order(committed(MEETING, new=WESTWARDS, first=ASIDE), "new", "first")
PLANS: Sequence[Row] = (
    (PLAN, committed(BEHIND, first=FIRST_GOES, new=BEHIND_GOES), {}),
    (PLAN, in_order(committed(BEHIND, new=BEHIND_GOES, first=FIRST_GOES), "first", "new"), {}),
    (TWO_BLOCKED, replace(committed(TWO_BLOCKED.instance, first=FIRST_GOES), unplanned=("third", "new")), {}),
    (PLAN, committed(BEHIND, first=FIRST_GOES), {Level.COMPLETE_IN_CONTEXT: "query/complete"}),
    (PLAN, committed(BEHIND, new=BEHIND_GOES), {Level.COMPLETE_IN_CONTEXT: "query/complete"}),
    (PLAN, committed(BEHIND, first=WAITS, new=BEHIND_GOES), {Level.CONTEXT_OPTIMAL: "query/optimal"}),
    (PLAN, committed(BEHIND, first=HURRIES, new=BEHIND_GOES), {Level.SOUND: "plan/duration"}),
    (case("plan", MEETING, planner=Carp()), committed(MEETING, first=FIRST_GOES), {}),
    (
        case("plan", DIAMOND, planner=Carp()),
        Solution((OTHER_PLAN,), ("new",)),
        {Level.EXACT: "query/ties"},
    ),
    (GREEDY, right(GREEDY), {}),
    (GREEDY, committed(BEHIND, first=FIRST_GOES), {Level.EXACT: "query/ties"}),
    (GREEDY, in_order(right(GREEDY), "first", "new"), {Level.EXACT: "query/ties"}),
    (
        case("plan", DIAMOND, planner=Greedy()),
        Solution((OTHER_PLAN,), ("new",)),
        {Level.EXACT: "query/ties"},
    ),
    (FREE, ASIDE_SECOND, {}),
    (FREE, committed(MEETING, first=FIRST_GOES), {Level.COMPLETE: "program/complete"}),
    (
        FREE,
        committed(MEETING, new=WESTWARDS),
        {Level.COMPLETE_IN_CONTEXT: "query/complete", Level.COMPLETE: "program/complete"},
    ),
    (FREE, committed(MEETING, first=HURRIES), {Level.SOUND: "plan/duration"}),
    (case("plan", DIAMOND), Solution((OTHER_PLAN,), ("new",)), {}),
    (case("plan", LAST_FIRST), right(case("plan", LAST_FIRST, planner=Carp())), {Level.OPTIMAL: "program/optimal"}),
    (case("plan", BLOCKED), committed(BLOCKED, first=FIRST_GOES), {}),
    (CLASSICAL, ASIDE_SECOND, {}),
    (CLASSICAL, committed(MEETING, first=FIRST_GOES), {Level.COMPLETE: "program/complete"}),
    (
        replace(case("plan", ALONE), classical=True),
        committed(ALONE, new=WAITS),
        {Level.OPTIMAL: "program/optimal"},
    ),
    (replace(case("plan", BLOCKED), classical=True), committed(BLOCKED, first=FIRST_GOES), {}),
    (
        replace(case("plan", FOUR), classical=True),
        committed(FOUR, first=[("a", 0, 1)]),
        {Level.COMPLETE: "program/complete"},
    ),
)
ADD = case("add", BEHIND, planner=Neighbourhood(), first=FIRST_GOES)
ADD_ANYHOW = replace(ADD, planner=Neighbourhood(baseline=False))
ADD_LATE = replace(ADD, now=2)
ADD_SLOW = case("add", BEHIND, planner=Neighbourhood(), first=WAITS)
ADDED = committed(BEHIND, first=FIRST_GOES, new=BEHIND_GOES)
ADDITIONS: Sequence[Row] = (
    (ADD, right(ADD), {}),
    (ADD_SLOW, right(ADD_SLOW), {}),
    (ADD, ADDED, {}),
    (ADD, committed(BEHIND, first=FIRST_GOES), {Level.COMPLETE_IN_CONTEXT: "query/complete"}),
    (ADD, committed(BEHIND, first=WAITS, new=BEHIND_GOES), {Level.CONTEXT_OPTIMAL: "neighbourhood/baseline"}),
    (ADD_ANYHOW, committed(BEHIND, first=WAITS, new=BEHIND_GOES), {Level.EXACT: "query/ties"}),
    (ADD_ANYHOW, committed(BEHIND, first=FIRST_GOES), {Level.EXACT: "query/ties"}),
    (ADD, committed(BEHIND, new=BEHIND_GOES), {Level.SOUND: "fleet/history"}),
    (ADD, committed(BEHIND, first=HURRIES, new=BEHIND_GOES), {Level.SOUND: "plan/duration"}),
    (ADD, in_order(ADDED, "new", "first"), {Level.EXACT: "query/ties"}),
    (ADD_LATE, right(ADD_LATE), {}),
    (ADD_LATE, ADDED, {Level.SOUND: "fleet/history"}),
    (ADD_LATE, committed(BEHIND, first=WAITS), {Level.SOUND: "fleet/history"}),
    (case("add", ISLANDS), committed(ISLANDS), {}),
)
POLISH = case("polish", row([FIRST]), first=WAITS)
POLISH_TWO = case("polish", BEHIND, first=FIRST_GOES, new=[("b", 0, 1), ("c", 1, 2), ("d", 2, 3)])
POLISHES: Sequence[Row] = (
    (POLISH, committed(row([FIRST]), first=FIRST_GOES), {}),
    (POLISH, POLISH.solution, {Level.EXACT: "query/ties"}),
    (POLISH, committed(row([FIRST])), {Level.SOUND: "polish/kept"}),
    (POLISH, committed(row([FIRST]), first=HURRIES), {Level.SOUND: "plan/duration"}),
    (POLISH_TWO, POLISH_TWO.solution, {}),
    (POLISH_TWO, committed(BEHIND, new=BEHIND_GOES), {Level.SOUND: "polish/kept"}),
    (POLISH_TWO, committed(BEHIND, first=WAITS, new=BEHIND_GOES), {Level.SOUND: "polish/kept"}),
)
CHECK = case("check", HEAD_ON, first=FIRST_GOES, new=WESTWARDS)
CHECK_RIGHT = case("check", BEHIND, first=FIRST_GOES)
VERDICT: VerdictDocument = right(CHECK)
VALID: VerdictDocument = right(CHECK_RIGHT)
(EXCHANGE,) = VERDICT.violations
CHECK_TWO = case("check", BEHIND, first=HURRIES, new=[("b", 0, 0), ("c", 0, 1), ("d", 1, 2)])
VERDICT_OF_TWO: VerdictDocument = right(CHECK_TWO)
CHECKS: Sequence[Row] = (
    (CHECK, VERDICT, {}),
    (CHECK, changed(VERDICT, violations=(changed(EXCHANGE, robots=EXCHANGE.robots[::-1], message="they meet"),)), {}),
    (CHECK_TWO, changed(VERDICT_OF_TWO, violations=VERDICT_OF_TWO.violations[::-1]), {}),
    (CHECK_TWO, changed(VERDICT_OF_TWO, violations=VERDICT_OF_TWO.violations[:1]), {Level.EXACT: "program/result"}),
    (CHECK, changed(VERDICT, valid=True), {Level.SOUND: "program/result"}),
    (CHECK, changed(VERDICT, violations=()), {Level.SOUND: "joint/exchange"}),
    (CHECK, changed(VERDICT, cost=VERDICT.cost + 1), {Level.SOUND: "cost/total"}),
    (CHECK, changed(VERDICT, unplanned=1), {Level.SOUND: "cost/total"}),
    (CHECK, changed(VERDICT, violations=(EXCHANGE, changed(EXCHANGE, rule="plan/start"))), {Level.SOUND: "plan/start"}),
    (CHECK, changed(VERDICT, violations=(changed(EXCHANGE, resource="a"),)), {Level.EXACT: "program/result"}),
    (CHECK_RIGHT, VALID, {}),
    (CHECK_RIGHT, changed(VALID, valid=False), {Level.SOUND: "program/result"}),
    (CHECK_RIGHT, changed(VALID, unplanned=0), {Level.SOUND: "cost/total"}),
    (CHECK_RIGHT, changed(VALID, violations=VERDICT.violations), {Level.SOUND: "joint/exchange"}),
)
OPTIMUM = case("optimum", LAST_FIRST)
BEST: OptimumDocument = right(OPTIMUM)
CARP = right(case("plan", LAST_FIRST, planner=Carp()))
UNDECIDED = claimed(None, None, decided=False, solution=None)
NONE = claimed(None, None, decided=True, solution=None)
ONE_OF_TWO = committed(BEHIND, first=FIRST_GOES)
OPTIMA: Sequence[Row] = (
    (OPTIMUM, BEST, {}),
    (OPTIMUM, UNDECIDED, {}),
    (OPTIMUM, changed(UNDECIDED, lower=6), {}),
    (OPTIMUM, changed(UNDECIDED, lower=7), {}),
    (OPTIMUM, changed(UNDECIDED, lower=8), {Level.OPTIMAL: "program/lower"}),
    (OPTIMUM, changed(UNDECIDED, cost=9), {Level.SOUND: "cost/total"}),
    (OPTIMUM, claimed(9, 7, decided=False, solution=CARP), {}),
    (OPTIMUM, claimed(9, 7, decided=True, solution=CARP), {Level.OPTIMAL: "program/optimal"}),
    (OPTIMUM, claimed(7, 7, decided=True, solution=CARP), {Level.SOUND: "cost/total"}),
    (OPTIMUM, claimed(None, 7, decided=True, solution=CARP), {Level.SOUND: "cost/total"}),
    (OPTIMUM, NONE, {Level.COMPLETE: "program/complete"}),
    (case("optimum", BEHIND), claimed(3, 3, decided=False, solution=ONE_OF_TWO), {Level.SOUND: "solution/covers"}),
    (
        case("optimum", row([FIRST])),
        claimed(2, 2, decided=False, solution=committed(row([FIRST]), first=HURRIES)),
        {Level.SOUND: "plan/duration"},
    ),
    (case("optimum", BLOCKED), NONE, {}),
    (case("optimum", BLOCKED), changed(NONE, lower=10**9), {}),
)
BOUND: BoundDocument = right(case("bound", LAST_FIRST))
BOUNDS: Sequence[Row] = (
    (case("bound", LAST_FIRST), BOUND, {}),
    (case("bound", LAST_FIRST), changed(BOUND, bound=BOUND.bound + 1), {Level.SOUND: "bound/total"}),
    (case("bound", ALONE), BOUND, {Level.SOUND: "bound/instance"}),
    (case("bound", ISLANDS), right(case("bound", ISLANDS)), {}),
)
ROWS = (*QUERIES, *PLANS, *ADDITIONS, *POLISHES, *CHECKS, *OPTIMA, *BOUNDS)


def test_carproof_and_a_plan_that_contradict_each_other_are_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    for best, message in (
        (None, "has no plan, and"),
        (later(plan("new", *FIRST_GOES)), "arrives at 4 at best: not so"),
    ):
        monkeypatch.setattr("carproof.conform.judging.judges._best", lambda *_, best=best: best)
        with pytest.raises(RuntimeError, match=message):
            first_finding(QUERY, goes(*FIRST_GOES), Level.COMPLETE)


@pytest.mark.parametrize("bound", [3, 4])
def test_a_best_plan_that_arrives_late_is_a_contradiction_whatever_its_certificate_says(
    bound: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, right = carp_reference.certifier(ALONE).certify("new")
    late = later(plan("new", *FIRST_GOES))
    monkeypatch.setattr(carp_reference, "certifier", lambda _: Wrong(late, changed(right, bound=bound)))
    with pytest.raises(ContradictionError, match="arrives at 4, not at 3" if bound == 3 else "was refused"):
        first_finding(QUERY, goes(*FIRST_GOES), Level.COMPLETE_IN_CONTEXT)


@pytest.mark.parametrize(("asked", "answer", "rules"), ROWS)
def test_an_answer_is_refused_by_its_rule_from_a_level_on(
    asked: Case, answer: Answer, rules: Mapping[Level, str | None]
) -> None:
    expected: str | None = None
    for level in Level:
        expected = rules.get(level, expected)
        finding = first_finding(asked, answer, level)
        assert (level, None if finding is None else finding.rule) == (level, expected)


@pytest.mark.parametrize(
    ("instance", "bound", "rule"),
    [
        (LAST_FIRST, 7, None),
        (LAST_FIRST, 8, "program/lower"),
        (row([]), 1, "program/lower"),
        (FOUR, 1, "program/lower"),
        (ISLANDS, 10**9, None),
    ],
)
def test_a_false_certificate_that_passes_is_refused_where_plans_cost_less(
    instance: Instance, bound: int, rule: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(carp_verify.bound.verify, "verify_bound", lambda *_: bound)
    finding = first_finding(case("bound", instance), BOUND, Level.SOUND)
    assert (None if finding is None else finding.rule) == rule


def test_where_carproof_is_undecided_nothing_is_called_wrong_nor_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (optima, efforts):
        monkeypatch.setattr(module, "found_cost", lambda _: (False, 1))
    monkeypatch.setattr(carp_verify.bound.verify, "verify_bound", lambda *_: 8)
    asked: Sequence[tuple[Case, Answer]] = (
        (OPTIMUM, claimed(9, 9, decided=True, solution=CARP)),
        (FREE, ASIDE_SECOND),
        (CLASSICAL, committed(MEETING, first=FIRST_GOES)),
        (case("bound", LAST_FIRST), BOUND),
    )
    assert [first_finding(*each, Level.OPTIMAL) for each in asked] == [None] * 4
    undecided = "carproof does not find the optimum in 60 s, with which to compare"
    assert [why_undecided(*each, Level.OPTIMAL) for each in asked] == [undecided] * 3 + [None]
    assert why_undecided(FREE, ASIDE_SECOND, Level.CONTEXT_OPTIMAL) is None
    assert why_undecided(FREE, ASIDE_SECOND, Level.EXACT) == undecided
    assert why_undecided(FREE, ASIDE_SECOND, Level.COMPLETE) is None
    assert why_undecided(FREE, committed(MEETING, first=FIRST_GOES), Level.COMPLETE) == undecided
    assert why_undecided(OPTIMUM, BEST, Level.COMPLETE) is None
    assert why_undecided(OPTIMUM, NONE, Level.COMPLETE) == undecided
    assert why_undecided(PLAN, ADDED, Level.OPTIMAL) is None
    assert why_undecided(POLISH, POLISH.solution, Level.OPTIMAL) is None


def test_about_a_large_instance_an_optimum_is_neither_called_wrong_nor_counted() -> None:
    large = replace(ALONE, graph=replace(ALONE.graph, resources=(*ALONE.graph.resources, *map(Resource, range(30)))))
    late = committed(large, new=WAITS)
    answers: Sequence[tuple[Case, Answer]] = (
        (case("optimum", large), claimed(6, 6, decided=True, solution=late)),
        (case("optimum", large), NONE),
        (case("plan", large), late),
    )
    assert [first_finding(*each, Level.OPTIMAL) for each in answers] == [None] * 3
    assert all("does not find the optimum" in (why_undecided(*each, Level.OPTIMAL) or "") for each in answers)


def test_an_optimum_that_is_not_decided_counts_as_no_answer() -> None:
    for level in (Level.OPTIMAL, Level.EXACT):
        for answer in (UNDECIDED, claimed(9, 7, decided=False, solution=CARP)):
            assert why_undecided(OPTIMUM, answer, level) == "it leaves the optimum undecided"
    assert why_undecided(OPTIMUM, BEST, Level.OPTIMAL) is None
    assert why_undecided(OPTIMUM, UNDECIDED, Level.COMPLETE) == "it leaves the optimum undecided"
    assert why_undecided(OPTIMUM, UNDECIDED, Level.CONTEXT_OPTIMAL) is None
    assert why_undecided(OPTIMUM, claimed(9, 7, decided=False, solution=CARP), Level.COMPLETE) is None
    assert why_undecided(case("optimum", BEHIND), claimed(3, 3, decided=False, solution=ONE_OF_TWO), Level.COMPLETE)
    assert why_undecided(case("optimum", BLOCKED), NONE, Level.OPTIMAL) is None
    assert why_undecided(FREE, ASIDE_SECOND, Level.OPTIMAL) is None


ONE = committed(FOUR, first=[("a", 0, 1)])
TWO = committed(FOUR, first=[("a", 0, 1)], new=[("b", 0, 1)])
THREE = committed(FOUR, first=[("a", 0, 1)], new=[("b", 0, 1)], third=[("c", 0, 1)])
ALL_BUT_NEW = committed(FOUR, first=[("a", 0, 1)], third=[("c", 0, 1)], fourth=[("d", 0, 1)])
CROWDED = replace(case("plan", MEETING), classical=True)


@pytest.mark.parametrize(
    ("asked", "answer", "shown"),
    [
        (QUERY, goes(*FIRST_GOES), Effort.TRIED),
        (QUERY, QueryDocument(None), Effort.GAVE_UP),
        (case("query", BLOCKED, first=FIRST_GOES), QueryDocument(None), Effort.NOTHING_TO_DO),
        (ADD, ADDED, Effort.TRIED),
        (ADD, committed(BEHIND, first=FIRST_GOES), Effort.GAVE_UP),
        (case("add", ISLANDS), committed(ISLANDS), Effort.NOTHING_TO_DO),
        (case("add", FOUR, first=[("a", 0, 1)]), ALL_BUT_NEW, Effort.GAVE_UP),
        (POLISH, committed(row([FIRST]), first=FIRST_GOES), Effort.TRIED),
        (POLISH, POLISH.solution, Effort.GAVE_UP),
        (POLISH_TWO, POLISH_TWO.solution, Effort.NOTHING_TO_DO),
        (case("plan", FOUR), committed(FOUR), Effort.GAVE_UP),
        (case("plan", FOUR), ONE, Effort.GAVE_UP),
        (case("plan", FOUR), TWO, Effort.GAVE_UP),
        (case("plan", FOUR), THREE, Effort.TRIED),
        (case("plan", row([])), committed(row([])), Effort.NOTHING_TO_DO),
        (case("plan", MEETING), committed(MEETING), Effort.GAVE_UP),
        (case("plan", MEETING), committed(MEETING, first=FIRST_GOES), Effort.TRIED),
        (CROWDED, committed(MEETING), Effort.NOTHING_TO_DO),
        (CROWDED, committed(MEETING, first=FIRST_GOES), Effort.TRIED),
        (replace(case("plan", FOUR), classical=True), committed(FOUR), Effort.GAVE_UP),
        (case("bound", LAST_FIRST), BOUND, Effort.TRIED),
        (case("bound", LAST_FIRST), changed(BOUND, bound=6), Effort.TRIED),
        (case("bound", LAST_FIRST), changed(BOUND, bound=5), Effort.GAVE_UP),
        (case("bound", row([])), changed(BOUND, bound=0), Effort.NOTHING_TO_DO),
        (case("bound", ISLANDS), changed(BOUND, bound=0), Effort.NOTHING_TO_DO),
        (CHECK, VERDICT, Effort.TRIED),
        (OPTIMUM, BEST, Effort.TRIED),
    ],
)
def test_an_answer_shows_something_or_gives_up(asked: Case, answer: Answer, shown: Effort) -> None:
    assert effort(asked, answer) == shown
