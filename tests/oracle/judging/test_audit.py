"""`audit` and the op `audit`: plans certified optimal in their order, or an earlier one shown."""

import json
from dataclasses import replace
from itertools import chain, permutations, repeat
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.running import EAST, EAST_PLAN, Document, Run, corridor, line, save, solution, town

import carp_reference
from carp_spec import Plan, RobotId, Solution, plan_cost, violations_of
from carp_verify.bound.rules import ContradictionError
from carproof import QueryCertificateDocument, read_instance, read_solution
from carproof.engines import engine_named
from carproof.judging.audit import audit_in_order, audit_in_some_order, in_order
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

LATE = solution({"r1": [["a", 0, 1], ["b", 1, 3], ["c", 3, 4]]})
ALONE = corridor([EAST])
REFERENCE = engine_named("reference")


@pytest.fixture(autouse=True)
def _alone(folder: Path) -> None:
    """One robot, and a plan of it that is late."""
    del folder
    save(alone=ALONE, late=LATE)


def last_row(stdout: str) -> list[str]:
    return stdout.splitlines()[2].split()[:6]


def test_a_late_plan_is_shown_with_an_earlier_one(carproof: Run) -> None:
    for engine in ("optimized", "reference"):
        outcome = carproof(f"audit alone.json late.json --engine {engine}")
        assert outcome.code == 1
        assert last_row(outcome.stdout)[:5] == ["1", "0", "1", "0", "0"]
        assert outcome.stdout.splitlines()[-1] == "robot r1 arrives at 3, and can at 2: a[0,1) b[1,2) c[2,3)"
    late = json.loads(carproof("audit alone.json late.json --json").stdout)["late"]
    assert late == [{"robot": "r1", "arrival": 3, "earliest": 2, "plan": EAST_PLAN}]


def test_an_order_is_found_for_plans_in_another_planners_format(carproof: Run, folder: Path) -> None:
    (folder / "row.map").write_text("type octile\nheight 2\nwidth 3\nmap\n...\n@.@\n")
    (folder / "row.scen").write_text("version 1\n0\trow.map\t3\t2\t0\t0\t2\t0\t2\n0\trow.map\t3\t2\t1\t0\t1\t1\t1\n")
    audit, result = "audit --map row.map --scen row.scen result.txt", folder / "result.txt"
    result.write_text("solution=\n0:(0,0),(1,0),\n1:(1,0),(1,1),\n2:(2,0),(1,1),\n")
    outcome = carproof(audit)
    assert (outcome.code, outcome.stderr) == (0, "")
    assert last_row(outcome.stdout)[:5] == ["2", "2", "0", "0", "0"]
    result.write_text("solution=\n0:(0,0),(1,0),\n1:(0,0),(1,1),\n2:(1,0),(1,1),\n3:(2,0),(1,1),\n")
    late = carproof(audit)
    assert late.code == 1
    assert late.stdout.splitlines()[-1].startswith("in no order are all plans optimal")
    assert "robot r1 arrives at 3, and can at 2" in late.stdout


def test_another_order_is_looked_for_where_it_is_asked_for(carproof: Run) -> None:
    """The second robot of the document crosses first."""
    robots = [{"id": "r1", "start": "n", "goal": "s"}, {"id": "r2", "start": "w", "goal": "e"}]
    waits, crosses = [["n", 0, 2], ["m", 2, 3], ["s", 3, 4]], [["w", 0, 1], ["m", 1, 2], ["e", 2, 3]]
    save(cross=town("nm sm wm em", robots), plans=solution({"r1": waits, "r2": crosses}))
    assert carproof("audit cross.json plans.json").code == 1
    outcome = carproof("audit cross.json plans.json --find-order --json")
    assert (outcome.code, json.loads(outcome.stdout)["certified"]) == (0, ["r2", "r1"])


@given(planned_instances(Sizes(groups=1, stops=3, service=3)))
def test_a_plan_is_late_just_where_the_reference_finds_an_earlier_one(planned: PlannedInstance) -> None:
    audit = audit_in_order(planned.instance, planned.solution, REFERENCE)
    plans = [*in_order(planned.solution)]
    late = []
    for position, plan in enumerate(plans):
        best = carp_reference.query(planned.instance, plans[:position], plan.robot)
        assert best is not None
        if plan_cost(planned.instance, best) < plan_cost(planned.instance, plan):
            late.append(plan)
    assert [each.plan for each in audit.late] == late
    assert [each.before for each in audit.late] == [tuple(plans[: plans.index(each)]) for each in late]
    assert [each for each in plans if each not in late] == audit.certified
    for each in audit.late:
        assert violations_of(planned.instance, (*each.before, each.earlier)) == ()
        assert each.earlier.visits[-1].enter < each.plan.visits[-1].enter


@given(planned_instances())
def test_an_order_is_found_if_there_is_one(planned: PlannedInstance) -> None:
    audit = audit_in_some_order(planned.instance, planned.solution, REFERENCE)
    orders = permutations(planned.solution.order)
    possible = any(audit_in_order(planned.instance, _ordered(planned, order), REFERENCE).holds for order in orders)
    assert audit.holds == possible
    if possible:
        order = tuple(plan.robot for plan in audit.certified)
        assert audit_in_order(planned.instance, _ordered(planned, order), REFERENCE).holds


@given(planned_instances(), st.integers(0, 9))
def test_what_there_is_no_time_for_is_undecided(planned: PlannedInstance, most: int) -> None:
    for look in (audit_in_order, audit_in_some_order):
        questions = chain(repeat(True, most), repeat(False))
        audit = look(planned.instance, planned.solution, REFERENCE, goes_on=questions.__next__)
        whole = look(planned.instance, planned.solution, REFERENCE)
        found = [*audit.certified, *(each.plan for each in audit.late), *audit.undecided]
        assert sorted(found, key=str) == sorted(planned.solution.plans, key=str)
        assert audit.certified == whole.certified[: len(audit.certified)]
        assert len(audit.certified) + len(audit.late) <= most
        assert audit.holds <= whole.holds
        assert audit == whole or audit.undecided


def _ordered(planned: PlannedInstance, order: tuple[RobotId, ...]) -> Solution:
    return replace(planned.solution, order=order)


class Wrong:
    """A planner that finds no plan, or one that breaks a rule, or shows nothing."""

    def __init__(self, plan: Plan | None, certificate: QueryCertificateDocument) -> None:
        self.found = plan, certificate

    def commit(self, plans: object) -> None:
        pass

    def certify(self, *_: object) -> tuple[Plan | None, QueryCertificateDocument]:
        return self.found


EARLY = solution({"r1": EAST_PLAN})


def plan_in(document: Document) -> Plan:
    return read_solution(line(**document)).plans[0]


@pytest.mark.parametrize(
    ("audited", "plan", "message"),
    [
        (LATE, None, "was not found"),
        (EARLY, plan_in(LATE), "was not found"),
        (LATE, plan_in(solution({"r1": [["a", 0, 1], ["c", 1, 2]]})), "breaks a rule"),
        (LATE, plan_in(LATE), "was refused"),
    ],
)
def test_a_planner_that_is_wrong_is_a_contradiction(
    monkeypatch: pytest.MonkeyPatch, audited: Document, plan: Plan | None, message: str
) -> None:
    certificate = QueryCertificateDocument("carproof-query/1", "r1", 0, 3, (), (("c", 0),))
    monkeypatch.setattr(carp_reference, "certifier", lambda _: Wrong(plan, certificate))
    with pytest.raises(ContradictionError, match=message):
        audit_in_order(read_instance(line(**ALONE)), read_solution(line(**audited)), REFERENCE)


def test_a_planner_that_finds_a_plan_through_another_robot_is_a_contradiction(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = read_instance(line(**corridor([{"id": "r0", "start": "b", "goal": "b"}, EAST])))
    audited = read_solution(line(**solution({"r0": [["b", 0, 2]], "r1": [["a", 0, 2], ["b", 2, 3], ["c", 3, 4]]})))
    certificate = QueryCertificateDocument("carproof-query/1", "r1", 0, 2, (), (("c", 0),))
    monkeypatch.setattr(carp_reference, "certifier", lambda _: Wrong(plan_in(EARLY), certificate))
    with pytest.raises(ContradictionError, match="the plan found for robot r1 breaks a rule"):
        audit_in_order(instance, audited, REFERENCE, followed={"r1": None})
