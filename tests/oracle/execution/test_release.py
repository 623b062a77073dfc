"""Grants: what robots may be given beyond the resources that they are in, so that everybody can still finish."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from time import process_time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.running import TWO, TWO_PLANNED, UNDER_WAY, Document, Run, asked, save, solution, town

from carp_spec import Carp, Instance, Plan, Refusal, Resource, ResourceGraph, Robot, RobotId, Solution, Visit
from carp_spec.execution.execution_rules import is_acyclic
from carp_spec.permutations import splitmix64
from carp_verify.release.verify import Finish
from carproof import (
    Delay,
    Grant,
    Trace,
    check_grants,
    execute,
    judge_log,
    release,
    write_instance,
    write_solution,
    write_trace,
)
from carproof.engines import engine_named
from carproof.execution.delays import until
from carproof.generate import Fleet
from carproof.generate.grid import Grid, grid_instance
from carproof.testing.random_instances import Draw, Mix, draw_instance

Held = tuple[tuple[int, int], ...]
"""For each plan the visit that its robot is in, and the last one that it has been granted."""
QUESTIONS = 10
TIGHT = Mix(
    sizes=(2, 3, 4, 5), robots=(2, 3, 3), capacities=(1, 1, 2), durations=(1, 2), releases=(0, 1), paces=(1,), more=3,
    both_ways=True, groups=(0, 1, 2), followings=("allowed", "forbidden"), goals_apart=True,
)  # fmt: skip


class Naive:
    """Robots that are granted one resource after the other and drive when they like, in all ways."""

    def __init__(self, instance: Instance, plans: Sequence[Plan]) -> None:
        self.instance = instance
        self.ways = [[visit.resource for visit in plan.visits] for plan in plans]
        self.parks = instance.after_goal == "park"

    def has_room(self, held: Held) -> bool:
        graph = self.instance.graph
        limits = [({each.id}, each.capacity) for each in graph.resources]
        limits += [({*each.resources}, each.capacity) for each in graph.groups]
        holding = [{*way[max(at, 0) : last + 1]} for way, (at, last) in zip(self.ways, held, strict=True)]
        return all(sum(bool(each & places) for each in holding) <= capacity for places, capacity in limits)

    def after(self, held: Held) -> Iterator[Held]:
        for number, (at, last) in enumerate(held):
            length = len(self.ways[number])
            ends = [(at, last + 1)] if last + 1 < length else []
            ends += [(at + 1, last)] if at < last else []
            ends += [(length, length)] if at == last == length - 1 and not self.parks else []
            yield from ((*held[:number], end, *held[number + 1 :]) for end in ends)

    def can_finish(self, held: Held) -> bool:
        found = {held}
        waiting = [held] if self.has_room(held) else []
        while waiting:
            here = waiting.pop()
            if all(at == len(way) - self.parks for (at, _), way in zip(here, self.ways, strict=True)):
                return True
            new = [each for each in self.after(here) if each not in found and self.has_room(each)]
            found.update(new)
            waiting += new
        return False

    def some_held(self, draw: Draw) -> Held:
        """What robots hold after some grants and moves, whether they can finish or not."""
        held: Held = tuple((-1, -1) for _ in self.ways)
        for _ in range(draw.between(0, 12)):
            open_ways = [each for each in self.after(held) if self.has_room(each)]
            if not open_ways:
                break
            held = draw.one_of(open_ways)
        others = [each for each in self.after(held) if [at for at, _ in each] == [at for at, _ in held]]
        return draw.one_of([held, held, *others])


def planned(seed: int) -> tuple[Instance, Solution]:
    """The first instance from the seed on of which several robots are planned, without a rotation."""
    for number in count(seed):
        instance = draw_instance(Draw(splitmix64(number)), TIGHT)
        solution = engine_named("reference").plan(instance, Carp())
        if len(solution.plans) > 1 and not any(is_acyclic(instance, solution)):
            return instance, solution
    raise AssertionError


def trace_of(solution: Solution, held: Held) -> Trace:
    """The robots have come to their places one tick after the other, late enough for all durations."""
    now = 100
    plans = []
    for plan, (at, _) in zip(solution.plans, held, strict=True):
        ticks = [20 * place + 10 for place in range(at + 1)]
        gone = at == len(plan.visits)
        ends = [*ticks[1:], None]
        visits = [Visit(each.resource, tick, end) for each, tick, end in zip(plan.visits, ticks, ends, strict=False)]
        if gone:
            visits[-1] = Visit(visits[-1].resource, visits[-1].enter, visits[-1].enter + 10)
        plans.append(Plan(plan.robot, tuple(visits)))
        now = max(now, *ticks, 0) if ticks else now
    return Trace(now + 50, tuple(plans))


def grants_of(solution: Solution, held: Held) -> list[Grant]:
    found = []
    for plan, (at, last) in zip(solution.plans, held, strict=True):
        resources = tuple(visit.resource for visit in plan.visits[at + 1 : last + 1])
        found += [Grant(plan.robot, resources)] if resources else []
    return found


@given(st.integers(0, 2**32))
def test_grants_are_safe_if_some_sequence_of_grants_and_moves_finishes(seed: int) -> None:
    for number in range(seed, seed + QUESTIONS):
        instance, solution = planned(number)
        naive = Naive(instance, solution.plans)
        held = naive.some_held(Draw(splitmix64(number)))
        verdict = check_grants(instance, solution, trace_of(solution, held), grants_of(solution, held), 100_000)
        assert verdict.answer == ("safe" if naive.can_finish(held) else "unsafe")
        if isinstance(verdict.witness, Finish):
            finished = driven(solution, held, verdict.witness.moves)
            rules = {"joint/capacity", "joint/group", "joint/exchange", "joint/following"}
            assert not broken(instance, finished) & rules


def broken(instance: Instance, trace: Trace) -> set[str]:
    return {violation.rule for violation in judge_log(instance, trace).violations}


def driven(solution: Solution, held: Held, moves: Sequence[RobotId]) -> Trace:
    """What happens if robots drive to the end of their grants and then make the moves, each long after the other."""
    plans = {plan.robot: plan for plan in solution.plans}
    place = {plan.robot: at for plan, (at, _) in zip(solution.plans, held, strict=True)}
    visits: dict[RobotId, list[Visit]] = {
        plan.robot: [Visit(each.resource, 0, None) for each in plan.visits[at : at + 1] if at >= 0]
        for plan, (at, _) in zip(solution.plans, held, strict=True)
    }
    first = [plan.robot for plan, (at, last) in zip(solution.plans, held, strict=True) for _ in range(at, last)]
    tick = 0
    for robot in (*first, *moves):
        tick += 100
        if visits[robot]:
            visits[robot][-1] = Visit(visits[robot][-1].resource, visits[robot][-1].enter, tick)
        place[robot] += 1
        if place[robot] < len(plans[robot].visits):
            visits[robot].append(Visit(plans[robot].visits[place[robot]].resource, tick, None))
    return Trace(tick + 100, tuple(Plan(robot, tuple(way)) for robot, way in visits.items()))


def along_the_order(instance: Instance, solution: Solution, late: int, now: int) -> tuple[Trace, Held]:
    """What late robots have done by a tick, and what they hold."""
    delays = [Delay(plan.robot, place, late) for plan in solution.plans[:1] for place in range(len(plan.visits) - 1)]
    trace = until(execute(instance, solution, "order", delays if late else ()).trace, now)
    held = []
    for plan in trace.plans:
        gone = bool(plan.visits) and plan.visits[-1].leave is not None
        held.append((len(plan.visits) - 1 + gone, len(plan.visits) - 1 + gone))
    return trace, tuple(held)


@given(st.integers(0, 2**32), st.integers(0, 3), st.integers(0, 12))
def test_what_is_released_is_safe_and_alone_nothing_more_would_be(seed: int, late: int, now: int) -> None:
    instance, solution = planned(seed)
    trace, held = along_the_order(instance, solution, late, now)
    naive = Naive(instance, solution.plans)
    robots = [plan.robot for plan in solution.plans]
    found = release(instance, solution, trace, robots, 100_000)
    together = tuple((at, at + len(each.resources)) for (at, _), each in zip(held, found.in_order, strict=True))
    assert naive.can_finish(together)
    assert check_grants(instance, solution, trace, found.in_order).by_order
    for number, (plan, (at, _), alone) in enumerate(zip(solution.plans, held, found.beyond, strict=True)):
        if instance.robot[plan.robot].release > trace.now:
            assert not alone.grant.resources
            continue
        ends = [(*held[:number], (at, last), *held[number + 1 :]) for last in range(at, len(plan.visits))]
        safe = [naive.can_finish(end) for end in ends]
        assert len(alone.grant.resources) == max(sum(safe) - 1, 0)
        assert (alone.next is None) == all(safe)


@given(st.integers(0, 2**32), st.integers(0, 3), st.integers(0, 12))
def test_the_order_grants_all_that_nobody_leaves_later(seed: int, late: int, now: int) -> None:
    """Counted pair by pair of visits, without groups."""
    instance, solution = planned(seed)
    trace, held = along_the_order(instance, solution, late, now)
    instance = replace(instance, graph=replace(instance.graph, groups=()))
    found = release(instance, solution, trace)
    left = {
        (plan.robot, place) for plan in trace.plans for place, each in enumerate(plan.visits) if each.leave is not None
    }
    visits = [(plan.robot, place, visit) for plan in solution.plans for place, visit in enumerate(plan.visits)]
    for plan, (at, _), grant in zip(solution.plans, held, found.in_order, strict=True):
        count = 0
        for visit in plan.visits[at + 1 :] if instance.robot[plan.robot].release <= trace.now else ():
            before = [
                (robot, place)
                for robot, place, other in visits
                if other.resource == visit.resource
                and other.leave is not None
                and other.leave + instance.gap <= visit.enter
            ]
            own = [each for each in before if each[0] == plan.robot and each[1] <= at + count]
            if not {*before} - {*own} <= left:
                break
            count += 1
        assert len(grant.resources) == count


ROW = Instance(ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("b", "c"), ("c", "d"))), (
    Robot("r1", "a", "d"), Robot("r2", "d", "a", release=9)))  # fmt: skip
ONE_BY_ONE = Solution(
    (
        Plan("r1", (Visit("a", 0, 1), Visit("b", 1, 2), Visit("c", 2, 3), Visit("d", 3, 4))),
        Plan("r2", (Visit("d", 9, 10), Visit("c", 10, 11), Visit("b", 11, 12), Visit("a", 12, 13))),
    ),
    ("r1", "r2"),
)
LATE = Trace(9, (Plan("r1", (Visit("a", 0, None),)), Plan("r2", ())))


def test_who_is_late_keeps_the_way_and_who_would_block_it_waits() -> None:
    found = release(ROW, ONE_BY_ONE, LATE, ["r2"])
    assert found.in_order == (Grant("r1", ("b", "c", "d")), Grant("r2", ()))
    assert (found.beyond[0].grant.resources, found.beyond[0].next, found.beyond[0].robots) == ((), "d", ("r1",))
    verdict = check_grants(ROW, ONE_BY_ONE, LATE, [Grant("r2", ("d",))])
    assert verdict.answer == "unsafe"
    assert check_grants(ROW, ONE_BY_ONE, LATE, [Grant("r2", ("d",))], states=1).answer == "undecided"


@pytest.mark.parametrize(
    ("grants", "path"),
    [
        ([Grant("r3", ())], "$.grants[0].robot"),
        ([Grant("r1", ()), Grant("r1", ())], "$.grants[1].robot"),
        ([Grant("r1", ("c",))], "$.grants[0].resources"),
        ([Grant("r1", ("a",))], "$.grants[0].resources"),
        ([Grant("r1", ("b",)), Grant("r3", ())], "$.grants[1].robot"),
        ([Grant("r1", ("b", "c", "d", "a"))], "$.grants[0].resources"),
    ],
)
def test_grants_of_other_resources_are_refused(grants: list[Grant], path: str) -> None:
    with pytest.raises(Refusal, match="release/grants") as refused:
        check_grants(ROW, ONE_BY_ONE, LATE, grants)
    assert refused.value.path == path


def test_who_is_not_released_yet_is_granted_nothing() -> None:
    early = replace(LATE, now=8)
    assert release(ROW, ONE_BY_ONE, early, ["r2"]).beyond[0].grant == Grant("r2", ())
    with pytest.raises(Refusal, match="release/grants"):
        check_grants(ROW, ONE_BY_ONE, early, [Grant("r2", ("d",))])


def test_robots_that_have_left_the_order_are_not_in_one_place() -> None:
    first, ahead = Plan("r1", (Visit("a", 0, 10), Visit("b", 10, None))), (Visit("d", 9, 10), Visit("c", 10, None))
    assert not release(ROW, ONE_BY_ONE, Trace(20, (first, Plan("r2", ahead)))).follows
    together = (Visit("d", 9, 10), Visit("c", 10, 12), Visit("b", 12, None))
    with pytest.raises(Refusal, match="release/room") as refused:
        release(ROW, ONE_BY_ONE, Trace(20, (first, Plan("r2", together))))
    assert refused.value.path == "$.plans"


def test_plans_with_a_rotation_ahead_are_refused() -> None:
    ring = ResourceGraph(tuple(map(Resource, "abc")), (("a", "b"), ("b", "c"), ("c", "a")), directed=True)
    robots = tuple(
        Robot(f"r{place}", start, goal) for place, (start, goal) in enumerate([("a", "b"), ("b", "c"), ("c", "a")])
    )
    turning = Instance(ring, robots)
    plans = [Plan(each.id, (Visit(each.start, 0, 1), Visit(each.goal, 1, 2))) for each in robots]
    trace = Trace(0, tuple(Plan(each.id, (Visit(each.start, 0, None),)) for each in robots))
    with pytest.raises(Refusal, match="execution/acyclic"):
        release(turning, Solution.of(turning, plans), trace)


NO_GRANTS: Document = {"format": "carproof-grants/1", "grants": []}
PARTLY = {**UNDER_WAY, "plans": UNDER_WAY["plans"][:1]}
"""A trace that leaves a robot out."""
TURNING = town("ab bc ca", [{"id": f"r{a}", "start": a, "goal": b} for a, b in ("ab", "bc", "ca")])
TURN = solution({f"r{a}": [[a, 0, 1], [b, 1, 2]] for a, b in ("ab", "bc", "ca")})
STILL = {**UNDER_WAY, "now": 0, "plans": [{"robot": f"r{a}", "visits": [[a, 0, None]]} for a in "abc"]}


@pytest.mark.parametrize(
    ("documents", "blamed", "rule"),
    [
        ({"instance": TWO, "solution": TWO_PLANNED, "trace": PARTLY}, "trace: $.plans", "trace/robots"),
        ({"instance": TURNING, "solution": TURN, "trace": STILL}, "solution: $", "execution/acyclic"),
    ],
)
@pytest.mark.usefixtures("elsewhere")
def test_the_document_that_is_wrong_is_named(
    carproof: Run, documents: dict[str, Document], blamed: str, rule: str
) -> None:
    save(**documents, grants=NO_GRANTS)
    name, _, place = blamed.partition(": $")
    for option in ("", "--grants grants.json"):
        outcome = carproof(f"release instance.json solution.json trace.json {option}")
        assert outcome.code == 2
        assert outcome.stderr.startswith(f"Error: {name}.json: ${place}: ")
    for error in (asked("release", **documents)["error"], asked("check-grants", **documents, grants=[])["error"]):
        assert (error["path"], error["rule"]) == (f"$.{name}{place}", rule)


def test_a_robot_that_is_unknown_is_the_fault_of_the_question() -> None:
    documents = {"instance": TWO, "solution": TWO_PLANNED, "trace": UNDER_WAY}
    assert asked("release", **documents, beyond=["r9"])["error"]["path"] == "$.beyond"
    unknown = [{"robot": "r9", "resources": []}]
    assert asked("check-grants", **documents, grants=unknown)["error"]["path"] == "$.grants[0].robot"


def test_exit_codes(carproof: Run, elsewhere: Path) -> None:
    (elsewhere / "row.json").write_bytes(write_instance(ROW))
    (elsewhere / "plans.json").write_bytes(write_solution(ONE_BY_ONE))
    (elsewhere / "trace.json").write_bytes(write_trace(LATE))
    for name, robot, resource in (("safe", "r1", "b"), ("wrong", "r1", "c"), ("blocking", "r2", "d")):
        grants = {"format": "carproof-grants/1", "grants": [{"robot": robot, "resources": [resource]}]}
        (elsewhere / f"{name}.json").write_text(json.dumps(grants))
    command = "release row.json plans.json trace.json"
    asked = {"": 0, " --beyond": 0, " --beyond --states 1": 3, " --grants safe.json": 0, " --grants wrong.json": 2}
    asked |= {" --grants blocking.json": 1, " --grants blocking.json --states 1": 3, " --beyond --grants safe.json": 2}
    assert {options: carproof(command + options).code for options in asked} == asked


def crowded() -> tuple[Instance, Solution, Trace]:
    """Twenty robots in a maze at their starts, and two questions that take long."""
    instance = grid_instance(Grid(8, 8, 6), Fleet(20, 0, "vanish"))
    solution = engine_named("optimized").plan(instance, Carp())
    begun = tuple(Plan(plan.robot, (Visit(plan.visits[0].resource, 0, None),)) for plan in solution.plans)
    return instance, solution, Trace(0, begun)


def test_the_time_is_kept_and_what_is_open_then_is_undecided() -> None:
    seconds = 0.3
    instance, solution, trace = crowded()
    robots = [plan.robot for plan in solution.plans]
    release(instance, solution, trace)
    started = process_time()
    found = release(instance, solution, trace, robots, seconds=seconds)
    assert process_time() - started <= 1.05 * seconds + 0.3
    undecided = [each for each in found.beyond if each.answer == "undecided"]
    assert undecided
    open_ones = [Grant(each.grant.robot, (*each.grant.resources, each.next)) for each in undecided if each.next]
    started = process_time()
    verdict = check_grants(instance, solution, trace, open_ones[:1], seconds=seconds)
    assert process_time() - started <= 1.05 * seconds + 0.3
    assert verdict.answer in ("undecided", "unsafe")
