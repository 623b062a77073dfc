"""Plans in a given time: they keep the law, never get worse, and come in time."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count
from time import process_time
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized.crowds.crowd import FAR, is_stepwise, ways_of
from carp_optimized.crowds.improving import Improving, arrivals
from carp_optimized.crowds.rounds import GREEDY
from carp_optimized.crowds.sipp import UNTIL_FOUND
from carp_optimized.improve import first_paths, planning
from carp_optimized.improve.anytime import plan_within
from carp_optimized.improve.clock import ALL, Clock
from carp_optimized.improve.cycles import FEW, SPARSE, improved
from carp_optimized.improve.planning import improve_crowd
from carp_optimized.lacam.search import Search, plans_by_steps
from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot, RobotId, Solution, judge, total_cost
from carproof.testing.strategies import Sizes, instances


def plan_crowd(instance: Instance, **options: Any) -> Solution:  # noqa: ANN401 - those of the function
    """What is found for a crowd, as a solution."""
    found = planning.plan_crowd(instance, **options)
    assert found is not None
    return found.solution


STEPWISE = Sizes(resources=7, robots=5, capacity=1, duration=1, release=0, pace=1)


@given(instances(STEPWISE).filter(lambda each: is_stepwise(each) and len(each.robots) > 0))
def test_plans_break_no_rule_are_the_same_again_and_no_worse_than_the_first(instance: Instance) -> None:
    found = plan_crowd(instance, iterations=30, seconds=None, seed=3)
    assert found == plan_crowd(instance, iterations=30, seconds=None, seed=3)
    assert judge(instance, found).valid
    first = plans_by_steps(instance)
    if first is not None:
        assert not found.unplanned
        assert total_cost(instance, found.plans) <= total_cost(instance, first)


@pytest.mark.parametrize("side", [12, 23])
@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_rounds_improve_a_crowd_and_its_best_total_never_rises(after_goal: AfterGoal, side: int) -> None:
    both_starts_are_tried = FEW * 60 <= 3000 and side**2 >= SPARSE * 60
    assert both_starts_are_tried == (side == 23)
    instance = on_grid(side, 60, after_goal)
    seen: list[int] = []
    found = plan_crowd(instance, iterations=3000, seconds=None, advance=lambda _, __, total: seen.append(total))
    assert judge(instance, found).valid
    assert seen == sorted(seen, reverse=True)
    assert total_cost(instance, found.plans) == seen[-1] < seen[0]
    first = plans_by_steps(instance)
    assert first is not None
    assert 2 * seen[-1] < total_cost(instance, first) + seen[0]


@pytest.mark.parametrize(
    ("after_goal", "robots"),
    [
        ("vanish", (Robot("A", "a", "c"), Robot("B", "a", "b"))),
        ("park", (Robot("A", "c", "b"), Robot("B", "a", "b"))),
        ("park", (Robot("A", "a", "c"), Robot("B", "a", "b"), Robot("C", "b", "a"), Robot("D", "d", "a"))),
    ],
)
def test_a_robot_without_a_way_keeps_no_place_from_another(after_goal: AfterGoal, robots: tuple[Robot, ...]) -> None:
    graph = ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("a", "d"), ("b", "d")))
    instance = Instance(graph, robots, after_goal)
    found = plan_crowd(instance, iterations=10, seconds=None)
    assert judge(instance, found).valid
    assert {*found.unplanned} == {"A", "D"} & {each.id for each in robots}


def test_a_way_longer_than_distances_are_measured_is_found_all_the_same() -> None:
    length = FAR + 2
    graph = ResourceGraph(tuple(map(Resource, range(length))), tuple((k, k + 1) for k in range(length - 1)))
    instance = Instance(graph, (Robot("r", 0, length - 1),))
    found = plan_within(instance, iterations=1)
    assert total_cost(instance, found.solution.plans) == length - 1
    assert improve_crowd(instance, found.solution, 1.0) is None
    island = replace(graph, resources=(*graph.resources, Resource("island")))
    lost = Instance(island, (*instance.robots, Robot("lost", 0, "island")))
    assert plan_within(lost, iterations=1).solution.unplanned == ("lost",)


@pytest.mark.parametrize(("name", "value"), [("JAMMED", 0), ("JAMMED", 10**6), ("LARGE", 0)])
def test_plans_are_lawful_with_less_greed_and_with_other_orders(
    name: str, value: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(first_paths, name, value)
    instance = on_grid(12, 60)
    found = plan_crowd(instance, iterations=50, seconds=None)
    assert judge(instance, found).valid
    assert not found.unplanned


@pytest.mark.parametrize("iterations", [1, 40, 2000])
def test_rounds_from_two_starts_end_no_worse_than_either_in_whatever_order_they_come(iterations: int) -> None:
    found = measured(on_grid(23, 60))
    always = Clock(None, process_time, 0.0)
    search = Search(found)
    search.go(10**6)
    assert search.paths is not None
    starts = [search.paths, first_paths.planned_in_order(found, always, 0, ALL, GREEDY, 30, ways_of(found))]
    for ordered in (starts, starts[::-1]):
        ended = improved(found, ordered, iterations, always, 0, lambda *_: None)
        assert arrivals(ended).sum() <= min(arrivals(each).sum() for each in starts)


def test_less_and_less_greed_ends_with_better_plans_than_the_greediest_pass() -> None:
    found = measured(on_grid(23, 60))
    always = Clock(None, process_time, 0.0)
    greediest, ways = max(first_paths.LADDER), ways_of(found)
    first = first_paths.planned_in_order(found, always, 0, ALL, greediest, UNTIL_FOUND, ways)
    best = first_paths.best_of_ladder(found, always, [], 0)
    assert best.size.all()
    assert arrivals(best).sum() < arrivals(first).sum()


def test_a_pass_gives_up_where_it_misses_more_than_a_few_robots() -> None:
    crowd = measured(on_grid(20, 250))
    still = Clock(None, lambda: 0.0, 0.0)

    def missed(*, gives_up: bool) -> int:
        greediest = max(first_paths.LADDER)
        paths = first_paths.planned_in_order(
            crowd, still, 0, ALL, greediest, UNTIL_FOUND, ways_of(crowd), gives_up=gives_up
        )
        return int(np.count_nonzero(paths.size == 0))

    assert missed(gives_up=False) == 0
    assert missed(gives_up=True) > 90


@pytest.mark.parametrize(("robots", "eighths", "missing"), [(120, 4, 0), (120, 6, 1), (250, 4, 1)])
def test_way_is_made_longer_where_few_robots_wait(
    robots: int, eighths: int, missing: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The time for prioritized planning is over after its pass, which misses few or many robots."""
    crowd, now = measured(on_grid(20, robots)), [0.0]
    plan_first = Improving.plan_first

    def end_late(improving: Improving, *given: Any) -> None:  # noqa: ANN401 - those of the method
        plan_first(improving, *given)
        now[0] = float(eighths)

    monkeypatch.setattr(Improving, "plan_first", end_late)
    paths = first_paths.planned_in_order(
        crowd, Clock(8.0, lambda: now[0], 0.0), 0, first_paths.SEARCHING, GREEDY, UNTIL_FOUND, ways_of(crowd)
    )
    assert min(int(np.count_nonzero(paths.size == 0)), 1) == missing


def test_a_way_through_others_has_room_for_more_visits_than_the_longest_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(first_paths, "LONGEST", 1)
    found = measured(on_grid(12, 60))
    always = Clock(None, process_time, 0.0)
    planned = first_paths.planned_in_order(found, always, 0, ALL, GREEDY, 30, ways_of(found))
    assert planned.size.all()


@pytest.mark.parametrize(
    ("side", "robots", "seconds"), [(8, 20, 0.3), (40, 300, 0.5), (70, 1500, 1.5), (90, 3000, 0.2)]
)
def test_the_time_is_kept_at_several_sizes(side: int, robots: int, seconds: float) -> None:
    instance = on_grid(side, robots)
    plan_crowd(on_grid(3, 2), iterations=1, seconds=None)
    started = process_time()
    found = plan_crowd(instance, iterations=None, seconds=seconds, clock=process_time)
    assert process_time() - started < 1.5 * seconds + 0.5
    if robots < 3000:
        assert not found.unplanned


def test_nobody_has_a_plan_where_the_time_is_over_at_once() -> None:
    ticks = iter(range(10**9))
    instance = on_grid(5, 4)
    found = plan_crowd(instance, iterations=None, seconds=0.5, clock=lambda: float(next(ticks)))
    assert len(found.unplanned) == 4


def test_robots_that_nobody_could_plan_do_not_keep_the_others_from_plans() -> None:
    instance = on_grid(8, 20)
    first = instance.robots[0]
    hopeless = (replace(first, id="same start"), replace(first, id="same goal", start=first.goal))
    found = plan_crowd(replace(instance, robots=(*instance.robots, *hopeless)), iterations=10, seconds=None)
    assert set(found.unplanned) == {"same start", "same goal"}


@dataclass
class Slow:
    """A clock on which a look takes a tenth of a second."""

    now: float = 0.0

    def __call__(self) -> float:
        """The seconds so far."""
        self.now += 0.1
        return self.now

    def slowing(self, function: Callable[..., object], seconds: float) -> Callable[..., object]:
        """The function, which takes so many seconds."""

        def slow(*arguments: object) -> object:
            self.now += seconds
            return function(*arguments)

        return slow


@pytest.mark.parametrize("design", [5, 20])
def test_the_nearest_robots_are_planned_where_there_is_no_time_for_all(
    design: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Slow()
    for name in ("measure", "estimate"):
        monkeypatch.setattr(planning, name, clock.slowing(getattr(planning, name), 10))
    instance = on_grid(60, 1200, map=design)
    found = plan_crowd(instance, iterations=None, seconds=300, clock=clock)
    assert judge(instance, found).valid
    assert 50 < len(found.plans) < 1200
    graph = instance.graph.resource

    def way(robot: RobotId) -> int:
        start, goal = (graph[each] for each in (instance.robot[robot].start, instance.robot[robot].goal))
        return abs((start.x or 0) - (goal.x or 0)) + abs((start.y or 0) - (goal.y or 0))

    assert max(way(plan.robot) for plan in found.plans) < min(sorted(map(way, found.unplanned))[len(found.plans) :])


def test_some_robots_are_planned_where_there_is_no_time_to_write_the_plans_of_all() -> None:
    clock = Slow()

    def finish(solution: Solution) -> None:
        clock.now += sum(len(plan.visits) for plan in solution.plans) / 200

    found = plan_crowd(on_grid(60, 1200), iterations=None, seconds=300, clock=clock, finish=finish)
    finish(found)
    assert 50 < len(found.plans) < 1200
    assert clock.now < 320


def test_lacam_is_given_up_where_the_steps_of_the_longest_way_take_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, calls = Slow(), []
    go = clock.slowing(Search.go, 10)
    monkeypatch.setattr(Search, "go", lambda *given: calls.append(go(*given)))
    found = plan_crowd(on_grid(140, 200), iterations=None, seconds=200, clock=clock)
    assert len(found.plans) == 200
    assert len(calls) == first_paths.SURE // 8


def test_those_measured_so_far_are_planned_where_measuring_takes_longer_than_expected() -> None:
    looks = count()
    slow = 35
    found = plan_crowd(
        on_grid(60, 1200, map=5),
        iterations=None,
        seconds=1000,
        clock=lambda: look if (look := next(looks)) < slow else look + 700,
    )
    assert 50 < len(found.plans) < 1200


def test_time_is_left_to_plan_some_robots_where_lacam_does_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Search, "go", lambda *_: None)
    ticks = iter(range(10**9))
    found = plan_crowd(on_grid(60, 1200), iterations=None, seconds=3000, clock=lambda: float(next(ticks)))
    assert len(found.plans) > 50


def test_given_plans_get_better_within_the_time() -> None:
    instance = on_grid(70, 1500)
    given = plan_crowd(instance, iterations=0, seconds=None)
    started = process_time()
    found = improve_crowd(instance, given, 1.5, clock=process_time)
    assert process_time() - started < 3
    assert found is not None
    assert judge(instance, found).valid
    assert total_cost(instance, found.plans) < total_cost(instance, given.plans)
    assert improve_crowd(instance, given, 0.001, clock=process_time) == given
