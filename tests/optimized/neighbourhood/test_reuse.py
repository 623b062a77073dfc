"""Each kind of reuse changes the number of queries and nothing else."""

from dataclasses import replace
from itertools import combinations
from math import factorial, perm

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.optimized.paper_sized import FOUR, MAPS, Question, read_digests
from tests.profiles import draws

import carp_optimized
from carp_optimized import Reuse
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_optimized.state.arrays import ANSWERS, PLANS
from carp_spec import Instance, Neighbourhood, Solution
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance

KINDS = ("kept", "unchanged", "prefixes", "shared", "bounds")
ALL_OFF = Reuse(**dict.fromkeys(KINDS, False))
WHOLE_FLEETS = [
    *(Neighbourhood(m=m, baseline=baseline) for m in (4, 5, 6) for baseline in (True, False)),
    *(Neighbourhood(m=10, sample=150, baseline=baseline) for baseline in (True, False)),
]
ONE_OFF = [Reuse(**{kind: False}) for kind in KINDS]
ONE_ON = [replace(ALL_OFF, **{kind: True}) for kind in KINDS]
COMMITTED = 9


@pytest.mark.parametrize("reuse", [ALL_OFF, *ONE_OFF, *ONE_ON], ids=str)
def test_paper_sized_plans_are_the_same_whatever_is_reused(reuse: Reuse) -> None:
    digests = read_digests()

    def plan(instance: Instance, options: Neighbourhood) -> Solution:
        return carp_optimized.plan(instance, options, reuse=reuse)

    def add(instance: Instance, before: Solution, robot: str, now: int, options: Neighbourhood) -> Solution:
        return carp_optimized.add(instance, before, robot, now, options, reuse)

    for map in MAPS:
        for options in FOUR:
            question = Question("add", map, 0, options)
            assert question.answer(plan, add) == digests[str(question)]
    whole = Question("plan", MAPS[-1], 0, FOUR[0])
    assert whole.answer(plan, add) == whole.answer(carp_optimized.plan, carp_optimized.add)


def counted(m: int, reuse: Reuse, sample: int | None = None, *, baseline: bool = True) -> carp_optimized.Queries:
    """The queries of adding a robot to nine on a grid with so much room that every query finds a plan."""
    fleet = PlannedFleet(grid_instance(Grid(8, 8), Fleet(COMMITTED + 1, seed=4 if baseline else 7)), reuse)
    carp(fleet, range(COMMITTED))
    before = fleet.queries.asked
    assert before == COMMITTED
    assert add(fleet, COMMITTED, 0, Neighbourhood(m=m, sample=sample, baseline=baseline))
    queries = fleet.queries
    return replace(queries, asked=queries.asked - before)


def replanned(rounds: int) -> int:
    """All robots outside the neighbourhood, in each round."""
    return sum(COMMITTED - taken for taken in range(1, rounds + 1))


@pytest.mark.parametrize(("m", "shared", "alone"), [(4, 64, 96), (5, 325, 600), (6, 1956, 4320)])
def test_orders_that_begin_alike_share_the_queries_of_their_beginning(m: int, shared: int, alone: int) -> None:
    """Of the last neighbourhood: the others' queries are those of a run with one robot less."""
    assert (shared, alone) == (sum(perm(m, k) for k in range(1, m + 1)), m * factorial(m))
    for reuse, expected in ((ALL_OFF, alone), (replace(ALL_OFF, prefixes=True), shared)):
        whole, less = (counted(size, reuse) for size in (m, m - 1))
        outside = COMMITTED - (m - 1)
        assert whole.asked - less.asked == outside + expected
        assert whole.prefixes - less.prefixes == alone - expected


def test_without_reuse_every_query_is_asked() -> None:
    rounds = 3
    orders = sum(size * factorial(size) for size in range(2, rounds + 2))
    queries = counted(rounds + 1, ALL_OFF)
    first_path_and_baseline = 2
    assert queries.asked == first_path_and_baseline + replanned(rounds) + orders
    assert [getattr(queries, kind) for kind in KINDS] == [0] * len(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_avoids_queries_and_counts_them(kind: str) -> None:
    without, with_it = counted(4, ALL_OFF), counted(4, replace(ALL_OFF, **{kind: True}))
    assert with_it.asked < without.asked
    assert getattr(with_it, kind) > 0
    assert all(getattr(with_it, other) == 0 for other in KINDS if other != kind)


def test_more_reuse_never_asks_more() -> None:
    for one, other in combinations(range(len(KINDS)), 2):
        both = replace(ALL_OFF, **{KINDS[one]: True, KINDS[other]: True})
        alone = (counted(4, replace(ALL_OFF, **{KINDS[kind]: True})).asked for kind in (one, other))
        assert counted(4, both).asked <= min(alone)


def test_sampled_orders_share_their_beginnings_too() -> None:
    without, with_it = counted(5, ALL_OFF, 60), counted(5, replace(ALL_OFF, prefixes=True), 60)
    assert without.asked - with_it.asked == with_it.prefixes > 0


@pytest.mark.parametrize("sample", [None, 60])
@pytest.mark.parametrize("prefixes", [False, True])
def test_bounds_count_the_queries_that_would_have_been_asked(sample: int | None, prefixes: bool) -> None:
    """On a grid where the last neighbourhood is not left out whole."""
    without = counted(5, replace(ALL_OFF, prefixes=prefixes), sample, baseline=False)
    with_it = counted(5, replace(ALL_OFF, prefixes=prefixes, bounds=True), sample, baseline=False)
    alone = sum(range(2, 5 + 1))
    assert with_it.bounds > 0
    assert with_it.asked - alone + with_it.bounds == without.asked


def test_more_plans_and_answers_than_there_is_room_for_change_no_plan() -> None:
    instance = grid_instance(Grid(5, 5, map=0, map_seed=9), Fleet(14, seed=9))
    planner = Neighbourhood(m=8)
    fleet = PlannedFleet(instance)
    most = [0, 0]
    for robot in range(14):
        add(fleet, robot, 0, planner)
        assert fleet._adding is not None
        most = [max(pair) for pair in zip(most, fleet._adding.fields.answers.used[:2].tolist(), strict=True)]
    assert most == [PLANS, ANSWERS]
    assert fleet.plans == carp_optimized.plan(instance, planner, reuse=replace(Reuse(), shared=False)).plans


def test_a_fleet_that_stays_up_minds_which_reuse_is_on() -> None:
    """With the same options, asked again."""
    fleet = PlannedFleet(grid_instance(Grid(8, 8), Fleet(COMMITTED + 1, seed=4)))
    planner = Neighbourhood(m=4)
    asked = []
    for reuse in (Reuse(), ALL_OFF):
        fleet.reuse = reuse
        carp(fleet, range(COMMITTED))
        before = fleet.queries.asked
        assert add(fleet, COMMITTED, 0, planner)
        asked.append(fleet.queries.asked - before)
    assert asked[0] < asked[1]


@settings(max_examples=draws(10))
@given(st.integers(0, 20), st.integers(20, 60), st.integers(0, 2**32 - 1), st.sampled_from(WHOLE_FLEETS))
def test_fleets_added_one_by_one_have_the_same_plans_without_reuse(
    map: int, robots: int, seed: int, options: Neighbourhood
) -> None:
    instance = grid_instance(Grid(map=map), Fleet(robots, seed=seed))
    drawn = replace(options, seed=seed)
    assert carp_optimized.plan(instance, drawn) == carp_optimized.plan(instance, drawn, reuse=ALL_OFF)


@pytest.mark.parametrize(("robots", "baseline"), [(33, False), (49, True)])
def test_a_plan_found_against_other_plans_is_judged_by_what_its_own_query_read(robots: int, baseline: bool) -> None:
    """Found by experiment 1: the answer to a query came with what another had read, which had found the same plan."""
    instance = grid_instance(Grid(map=6), Fleet(robots, seed=16))
    options = Neighbourhood(m=10, sample=150, seed=16, baseline=baseline)
    assert carp_optimized.plan(instance, options) == carp_optimized.plan(instance, options, reuse=ALL_OFF)


PARKED = [
    (Grid(10, 10, map=20), Fleet(robots=30, seed=11), Traits(duration=Range(1, 3)), Neighbourhood(m=7, sample=20)),
    (Grid(10, 10, map=5), Fleet(robots=50, seed=12), Traits(capacity=Range(1, 2)), Neighbourhood(m=4, baseline=False)),
    (Grid(8, 8, map=5), Fleet(robots=12, seed=13), Traits(), Neighbourhood(m=7, sample=20)),
    (Grid(10, 10, map=10), Fleet(robots=12, seed=250), Traits(capacity=Range(1, 2)), Neighbourhood(m=2)),
    (Grid(8, 8, map=3), Fleet(robots=32, seed=539), Traits(), Neighbourhood(m=7, sample=20)),
    (
        Grid(10, 10, map=10),
        Fleet(robots=30, seed=666, release=Range(0, 5), pace=Range(1, 2)),
        Traits(),
        Neighbourhood(m=4, baseline=False),
    ),
]


@pytest.mark.parametrize(
    ("grid", "fleet", "traits", "planner"), PARKED, ids=lambda each: str(getattr(each, "seed", ""))
)
def test_plans_of_robots_that_park_are_the_same_whatever_is_reused(
    grid: Grid, fleet: Fleet, traits: Traits, planner: Neighbourhood
) -> None:
    """When a goal is free for ever decides which windows come first, so plans that end there later change queries."""
    instance = grid_instance(grid, replace(fleet, after_goal="park"), traits)
    assert carp_optimized.plan(instance, planner) == carp_optimized.plan(instance, planner, reuse=ALL_OFF)
