"""The lemma about freed stays, evaluated at every step of the reference on every query on small graphs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from heapq import heappop
from importlib import import_module
from itertools import combinations

import pytest
from tests.enumeration import ASKED, PATTERNS, Pattern, SmallCase, small_cases
from tests.profiles import rest_in

from carp_reference.context import Context, context_of
from carp_reference.problem import Problem, ticks_to_goal
from carp_reference.query import Node, find_plan
from carp_spec import Plan, ResourceId
from carp_spec.windows import Window
from carp_verify.lemmas.freed_stays_come_too_late import is_too_late
from carp_verify.lemmas.smt import integer, value_of

SEARCH = import_module("carp_reference.query")  # the name of the module is also that of a function
FOR_EVER = 99
FEW_RESOURCES = 3
STRIDE = 61
Question = tuple[str, object]
Queue = list[tuple[tuple[int, int, int, int], Node]]


def cases(pattern: Pattern) -> Iterator[SmallCase]:
    """All with few resources, and some of those with more."""
    for number, case in enumerate(small_cases(pattern)):
        if len(case.instance.graph.resources) <= FEW_RESOURCES or number % STRIDE == 0:
            yield case


@dataclass(slots=True)
class Trace:
    """The steps of a query: the nodes taken from its queue, and the questions to its context with the answers."""

    taken: list[Node] = field(default_factory=list)
    answers: list[tuple[Question, object]] = field(default_factory=list)


class Watched(Context):
    """A context that notes what it is asked."""

    trace: Trace

    def windows(self, resource: ResourceId) -> tuple[Window, ...]:
        answer = Context.windows(self, resource)
        self.trace.answers.append((("windows", resource), answer))
        return answer

    def is_exchange(self, tick: int, source: ResourceId, target: ResourceId) -> bool:
        answer = Context.is_exchange(self, tick, source, target)
        self.trace.answers.append((("exchange", (tick, source, target)), answer))
        return answer


@pytest.fixture
def trace(monkeypatch: pytest.MonkeyPatch) -> Trace:
    """Filled by whatever the reference is asked."""
    seen = Trace()

    def watched(*arguments: object) -> Context:
        context = context_of(*arguments)  # type: ignore[arg-type]
        watching = Watched(context.instance, context.capacities, context.occupations, context.moves)
        object.__setattr__(watching, "trace", seen)
        return watching

    def pop(queue: Queue) -> object:
        item = heappop(queue)
        seen.taken.append(item[1])
        return item

    monkeypatch.setattr(SEARCH, "context_of", watched)
    monkeypatch.setattr(SEARCH, "heappop", pop)
    return seen


def ask(case: SmallCase, committed: Sequence[Plan], trace: Trace) -> Plan | None:
    trace.taken, trace.answers = [], []
    return find_plan(problem_of(case), committed, ASKED)


def problem_of(case: SmallCase) -> Problem:
    return Problem(case.instance, {ASKED: ticks_to_goal(case.instance, case.instance.robot[ASKED])}, 0)


@pytest.mark.parametrize("pattern", rest_in("ci", PATTERNS[1::2], 0), ids=str)
def test_a_query_goes_the_same_way_until_an_answer_differs(trace: Trace, pattern: Pattern) -> None:
    """So a state is a function of the answers before it, and a query all whose answers stay the same is the same."""
    same = different = 0
    for case in cases(pattern):
        runs = []
        for count in range(len(case.committed) + 1):
            for committed in combinations(case.committed, count):
                plan = ask(case, committed, trace)
                runs.append((plan, trace.answers))
        for (plan, answers), (other_plan, other_answers) in combinations(runs, 2):
            pairs = zip(answers, other_answers, strict=False)
            at = next((k for k, (one, other) in enumerate(pairs) if one != other), None)
            if at is not None:
                different += 1
                assert answers[at][0] == other_answers[at][0], "the question before which all answers were the same"
            else:
                same += 1
                assert (plan, answers) == (other_plan, other_answers)
    assert min(same, different) > 100


@cache
def too_late(*values: int) -> bool:
    names = ("ready", "earliest", "latest", "duration", "h", "arrival")
    first, *others = map(integer, names)
    return bool(value_of(is_too_late(first, *others), dict(zip(names, values, strict=True))))


def plans_with_and_without(trace: Trace, pattern: Pattern) -> Iterator[tuple[Plan, Plan | None]]:
    """The plans of queries with a plan committed, and without it, where all its stays come too late."""
    for case in cases(pattern):
        problem = problem_of(case)
        to_goal, successors = problem.ticks_to_goal[ASKED][0], case.instance.graph.successors
        for freed in case.committed:
            plan = ask(case, case.committed, trace)
            if plan is None:
                continue
            hulls: dict[ResourceId, tuple[int, int]] = {}
            for visit in freed.visits:
                earliest, latest = hulls.get(visit.resource, (visit.enter, 0))
                leave = FOR_EVER if visit.leave is None else visit.leave
                hulls[visit.resource] = (earliest, max(latest, leave))
            arrival = plan.visits[-1].enter
            start = trace.taken[0]
            looked_at = [(start.enter, start.resource, FOR_EVER)] if start.resource in hulls else []
            looked_at += [
                (node.ready, target, hulls[target][1])
                for node in trace.taken
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
                yield plan, ask(case, others, trace)


@pytest.mark.parametrize("pattern", rest_in("ci", PATTERNS[1::2], 0), ids=str)
def test_stays_that_are_freed_too_late_change_no_plan(trace: Trace, pattern: Pattern) -> None:
    pairs = list(plans_with_and_without(trace, pattern))
    assert len(pairs) > 100
    assert all(plan == without for plan, without in pairs)
