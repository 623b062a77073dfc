"""The optimised polish makes the reference's plans, visit for visit, and never worse ones."""

from dataclasses import replace
from itertools import chain, repeat

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.optimized.neighbourhood.arrivals import CROWDED, ROOMS, arrivals
from tests.spec.making import worth

import carp_optimized
import carp_optimized.fleet
import carp_reference
from carp_optimized.orderings import carp
from carp_optimized.polishing import play, to_polish
from carp_optimized.recording import enlarged
from carp_optimized.state import encoding, room
from carp_optimized.state.arrays import NONE, Records
from carp_reference.problem import prepare
from carp_reference.query import find_plan
from carp_spec import (
    Carp,
    Instance,
    Plan,
    Resource,
    ResourceGraph,
    Robot,
    Solution,
    Visit,
    check_update,
    judge,
    plan_cost,
    violations_of,
)
from carproof import polish
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.testing.random_instances import Mix
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

SIZES = Sizes(resources=8, robots=12, groups=2)
SEEDS = st.integers(0, 2**64 - 1)


def both(instance: Instance, solution: Solution, iterations: int, seed: int, now: int = 0) -> Solution:
    """The polished solution, after a look at whether the two engines agree."""
    last: list[tuple[int, int, int]] = []
    readable = carp_reference.polish(
        instance, solution, iterations=iterations, seed=seed, now=now, advance=lambda *reported: last.append(reported)
    )
    reference = last[-1:]
    last.clear()
    fast = carp_optimized.polish(
        instance, solution, iterations=iterations, seed=seed, now=now, advance=lambda *reported: last.append(reported)
    )
    assert fast == readable
    assert not reference or last[-1] == reference[0]
    return fast


@given(planned_instances(SIZES), st.integers(0, 25), SEEDS)
def test_both_engines_polish_alike_and_never_make_it_worse(
    planned: PlannedInstance, iterations: int, seed: int
) -> None:
    polished = both(planned.instance, planned.solution, iterations, seed)
    assert judge(planned.instance, polished).valid
    assert worth(planned.instance, polished) <= worth(planned.instance, planned.solution)


@given(planned_instances(replace(SIZES, robots=6, stops=3, service=5)), st.integers(0, 25), SEEDS, st.integers(1, 20))
def test_both_engines_keep_what_robots_have_done(
    planned: PlannedInstance, iterations: int, seed: int, now: int
) -> None:
    instance, before = planned.instance, planned.solution
    polished = both(instance, before, iterations, seed, now)
    assert judge(instance, polished).valid
    assert not check_update(before.plans, polished.plans, now)
    assert {plan.robot for plan in polished.plans} == {plan.robot for plan in before.plans}
    assert worth(instance, polished) <= worth(instance, before)
    if before.plans:
        annealed = polish(instance, before, seconds=0.01, seed=seed, now=now)
        assert judge(instance, annealed).valid
        assert not check_update(before.plans, annealed.plans, now)


@given(planned_instances(replace(SIZES, robots=6, stops=3, service=5)), st.integers(0, 20))
def test_plans_alone_cost_what_the_reference_finds(planned: PlannedInstance, now: int) -> None:
    costs_alone(planned.instance, planned.solution, now)


@pytest.mark.parametrize(
    ("visits", "now", "cost"),
    [
        ((Visit("b", 0, 5), Visit("a", 5, 6)), 3, 3),  # it waits, and can go on from now
        ((Visit("b", 0, 1), Visit("a", 1, 5), Visit("b", 5, 6), Visit("a", 6, 7)), 3, 4),  # too late to vanish at once
    ],
)
def test_a_plan_alone_goes_on_from_now(visits: tuple[Visit, ...], now: int, cost: int) -> None:
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),))
    instance = Instance(graph, (Robot("r", "b", "a"),))
    assert costs_alone(instance, Solution((Plan("r", visits),), ("r",)), now) == [cost]


def costs_alone(instance: Instance, solution: Solution, now: int) -> list[int | None]:
    """The costs of the plans that robots have alone, after a look at whether the two engines agree."""
    plans = {plan.robot: plan for plan in solution.plans}
    fleet = carp_optimized.fleet.PlannedFleet(instance)
    fleet.commit([plans[each] for each in solution.order])
    polishing = to_polish(fleet, 0, now).fields
    problem = replace(prepare(instance, now), before=plans)
    able = [robot.id if now == 0 or robot.id in plans else None for robot in instance.robots]
    found = [None if robot is None else find_plan(problem, (), robot) for robot in able]
    costs = [None if plan is None else plan_cost(instance, plan) for plan in found]
    pairs = zip(polishing.least.tolist(), (polishing.alone != NONE).tolist(), strict=True)
    assert [least if has_path else None for least, has_path in pairs] == costs
    return costs


MIXED = Fleet(robots=16, seed=3, distinct="none", release=Range(0, 9), pace=Range(1, 2))


@pytest.mark.parametrize(
    ("instance", "rounds"),
    [
        (grid_instance(Grid(7, 7, map=20), Fleet(robots=16, seed=2, after_goal="park")), 120),
        (grid_instance(Grid(6, 6, map=10), MIXED, Traits(capacity=Range(1, 2), duration=Range(1, 3))), 120),
        (grid_instance(Grid(7, 7, map=0), Fleet(robots=12, seed=4)), 400),  # robots come by a place of a tree twice
        (grid_instance(Grid(8, 8, map=12), Fleet(robots=24, seed=4)), 400),  # more robots than can be members
    ],
)
def test_both_engines_polish_crowded_grids_alike(instance: Instance, rounds: int) -> None:
    given = carp_optimized.plan(instance, Carp())
    polished = both(instance, given, rounds, 7)
    assert judge(instance, polished).valid
    assert worth(instance, polished) <= worth(instance, given)


def test_a_polish_that_had_no_time_for_all_robots_is_lawful_and_never_worse() -> None:
    instance = grid_instance(Grid(12, 12), Fleet(robots=80, seed=2))
    fleet = carp_optimized.fleet.PlannedFleet(instance)
    carp(fleet, range(80))
    before = fleet.worth
    looks = chain([True], repeat(False))
    polishing = to_polish(fleet, 1, goes_on=looks.__next__)
    assert np.count_nonzero(polishing.fields.alone == NONE) == 80 - 32
    play(fleet, polishing, 200)
    assert violations_of(instance, fleet.plans) == ()
    assert fleet.worth < before


def test_plans_that_are_not_kept_take_no_room() -> None:
    instance = grid_instance(Grid(6, 6, map=3), Fleet(robots=8, seed=2))
    best = carp_optimized.polish(instance, carp_optimized.plan(instance, Carp()), iterations=3000)
    fleet = carp_optimized.fleet.PlannedFleet(instance)
    fleet.commit(best.plans)
    before = int(fleet.state.records.used[0])
    rounds = play(fleet, to_polish(fleet, 1), 200)
    assert fleet.state.records.used[0] - before < rounds, "a round plans several members"


def test_plans_alone_for_which_there_is_too_little_room_get_more(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = grid_instance(Grid(), Fleet(robots=12, seed=1))
    fleet = carp_optimized.fleet.PlannedFleet(instance)
    carp(fleet, range(12))
    made = play(fleet, to_polish(fleet, 1), 50), fleet.plans

    enlargements: list[Records] = []

    def enlarged_seldom(records: Records) -> Records:
        enlargements.append(records)
        assert len(enlargements) < 20, "the room is not used"
        return enlarged(records)

    monkeypatch.setattr("carp_optimized.fleet.enlarged", enlarged_seldom)
    narrow = carp_optimized.fleet.PlannedFleet(instance)
    narrow._take(encoding.with_room(narrow.state, narrow.state.windows.start.size, room.no_records(2, 30, 30)))
    carp(narrow, range(12))
    assert enlargements
    before = len(enlargements)
    assert (play(narrow, to_polish(narrow, 1), 50), narrow.plans) == made
    assert len(enlargements) > before


def test_plans_alone_are_found_again_once_records_are_forgotten() -> None:
    instance = grid_instance(Grid(8, 8, map=10), Fleet(robots=20, seed=1))
    made = []
    for forgets in (False, True):
        fleet = carp_optimized.fleet.PlannedFleet(instance)
        carp(fleet, range(20))
        polishing = to_polish(fleet, 1)
        for _ in range(20):
            play(fleet, polishing, 10)
            if forgets:
                fleet.forget()
        made.append(fleet.plans)
    assert made[0] == made[1]


@pytest.mark.parametrize(("number", "mix"), [(5428, CROWDED), (7553, ROOMS)])
def test_plans_alone_go_on_from_what_robots_had_done_as_the_polish_began(number: int, mix: Mix) -> None:
    """A plan made by the polish may begin with a move at this very tick, which a later plan may still change."""
    question = arrivals(number, replace(mix, followings=("forbidden",)))
    both(question.instance, question.by_reference(), 25, number, now=3)


def test_robots_without_a_plan_get_one() -> None:
    instance = grid_instance(Grid(map=10), Fleet(seed=6))
    given = carp_optimized.plan(instance, Carp())
    assert given.unplanned
    assert not carp_optimized.polish(instance, given, iterations=2000).unplanned


def test_rounds_add_up_however_many_a_compiled_call_plays(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = grid_instance(Grid(10, 10), Fleet(robots=30, seed=5))
    given = carp_optimized.plan(instance, Carp())
    polished = carp_optimized.polish(instance, given, iterations=333, seed=9)
    monkeypatch.setattr("carp_optimized.polishing.ROUNDS", 7)
    assert carp_optimized.polish(instance, given, iterations=333, seed=9) == polished
