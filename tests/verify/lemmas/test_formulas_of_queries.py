"""The lemma about freed stays, evaluated at every step of the reference on every query on small graphs."""

from collections.abc import Iterator, Sequence
from functools import cache
from heapq import heappop
from importlib import import_module

import pytest
from tests.enumeration import ASKED, PATTERNS, Pattern, SmallCase, small_cases
from tests.profiles import rest_in

from carp_reference.problem import Problem, ticks_to_goal
from carp_reference.query import Node, find_plan
from carp_spec import Plan, ResourceId
from carp_verify.lemmas.freed_stays_come_too_late import is_too_late
from carp_verify.lemmas.smt import integer, value_of

SEARCH = import_module("carp_reference.query")  # the name of the module is also that of a function
FOR_EVER = 99
FEW_RESOURCES = 3
STRIDE = 61


def cases(pattern: Pattern) -> Iterator[SmallCase]:
    """All with few resources, and some of those with more."""
    for number, case in enumerate(small_cases(pattern)):
        if len(case.instance.graph.resources) <= FEW_RESOURCES or number % STRIDE == 0:
            yield case


@pytest.fixture(name="taken")
def noted(monkeypatch: pytest.MonkeyPatch) -> list[Node]:
    """The nodes that a query takes from its queue."""
    nodes: list[Node] = []

    def pop(queue: list[tuple[tuple[int, int, int, int], Node]]) -> object:
        item = heappop(queue)
        nodes.append(item[1])
        return item

    monkeypatch.setattr(SEARCH, "heappop", pop)
    return nodes


def ask(case: SmallCase, committed: Sequence[Plan], taken: list[Node]) -> Plan | None:
    taken.clear()
    return find_plan(problem_of(case), committed, ASKED)


def problem_of(case: SmallCase) -> Problem:
    return Problem(case.instance, {ASKED: ticks_to_goal(case.instance, case.instance.robot[ASKED])}, 0)


@cache
def too_late(*values: int) -> bool:
    names = ("ready", "earliest", "latest", "duration", "h", "arrival")
    first, *others = map(integer, names)
    return bool(value_of(is_too_late(first, *others), dict(zip(names, values, strict=True))))


def plans_with_and_without(taken: list[Node], pattern: Pattern) -> Iterator[tuple[Plan, Plan | None]]:
    """The plans of queries with a plan committed, and without it, where all its stays come too late."""
    for case in cases(pattern):
        problem = problem_of(case)
        to_goal, successors = problem.ticks_to_goal[ASKED][0], case.instance.graph.successors
        for freed in case.committed:
            plan = ask(case, case.committed, taken)
            if plan is None:
                continue
            hulls: dict[ResourceId, tuple[int, int]] = {}
            for visit in freed.visits:
                earliest, latest = hulls.get(visit.resource, (visit.enter, 0))
                leave = FOR_EVER if visit.leave is None else visit.leave
                hulls[visit.resource] = (earliest, max(latest, leave))
            arrival = plan.visits[-1].enter
            start = taken[0]
            looked_at = [(start.enter, start.resource, FOR_EVER)] if start.resource in hulls else []
            looked_at += [
                (node.ready, target, hulls[target][1])
                for node in taken
                for target in successors[node.resource]
                if target in hulls and target in to_goal
            ]
            if all(
                too_late(
                    ready,
                    hulls[target][0],
                    latest,
                    case.instance.duration(ASKED, target),
                    to_goal[target],
                    arrival,
                )
                for ready, target, latest in looked_at
            ):
                others = [each for each in case.committed if each is not freed]
                yield plan, ask(case, others, taken)


@pytest.mark.parametrize("pattern", rest_in("ci", PATTERNS[1::2], 0), ids=str)
def test_stays_that_are_freed_too_late_change_no_plan(taken: list[Node], pattern: Pattern) -> None:
    pairs = list(plans_with_and_without(taken, pattern))
    assert len(pairs) > 100
    assert all(plan == without for plan, without in pairs)
