"""Cases that random instances seldom reach: full arrays, far goals, ended plans, too many plans to remember."""

from dataclasses import replace
from itertools import count, cycle, pairwise
from math import isqrt, sqrt

import numba
import pytest

import carp_optimized
import carp_reference
from carp_optimized.certifying import potentials
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood.distances import term
from carp_optimized.queries.guides import MOST_LEVELS
from carp_optimized.state import encoding, room
from carp_optimized.state.arrays import FURTHER, Search
from carp_spec import (
    Carp,
    Greedy,
    Instance,
    LongestFirst,
    Neighbourhood,
    Plan,
    Planner,
    Refusal,
    Resource,
    ResourceGraph,
    Robot,
    Shuffled,
    Solution,
    Visit,
)
from carp_spec.permutations import splitmix64
from carproof.generate import Fleet, Grid, grid_instance

LARGEST = 2**30 - 1
ROUNDED_UP = ((400500, 89496552), (615752, 494798881), (973787, 88743213))  # where a float root is one too large
LINE = ResourceGraph((Resource("a"), Resource("b"), Resource("c")), (("a", "b"), ("b", "c")))
PLANNERS: tuple[Planner, ...] = (Carp(), LongestFirst(), Greedy(), Shuffled(3), Neighbourhood(m=3))


def assert_alike(instance: Instance, planner: Planner) -> None:
    assert carp_optimized.plan(instance, planner) == carp_reference.plan(instance, planner)


@pytest.mark.parametrize("planner", PLANNERS, ids=str)
def test_nothing_to_plan(planner: Planner) -> None:
    assert_alike(Instance(ResourceGraph((), ()), ()), planner)
    assert_alike(Instance(LINE, ()), planner)


@pytest.mark.parametrize("planner", PLANNERS, ids=str)
def test_progress_is_never_more_than_all_steps(planner: Planner) -> None:
    instance = grid_instance(Grid(3, 3), Fleet(4))
    advanced: list[None] = []
    carp_optimized.plan(instance, planner, lambda: advanced.append(None))
    assert len(advanced) <= carp_optimized.steps(instance, planner)
    assert bool(advanced) == (planner not in (Carp(), LongestFirst()))


def test_rows_of_windows_grow() -> None:
    convoy = tuple(Robot(k, "ac"[k % 2], "ca"[k % 2], 9 * k) for k in range(70))
    for planner in (Carp(), Neighbourhood(m=2)):
        assert_alike(Instance(LINE, convoy), planner)


@pytest.mark.parametrize("sizes", [(4, 16, 16), (64, 4, 4)], ids=["records", "visits of plans made elsewhere"])
def test_room_for_plans_grows(monkeypatch: pytest.MonkeyPatch, sizes: tuple[int, int, int]) -> None:
    no_records = room.no_records
    monkeypatch.setattr(encoding, "no_records", lambda *_: no_records(*sizes))
    instance = grid_instance(Grid(4, 4), Fleet(9))
    assert_alike(instance, Neighbourhood(m=3))
    plans = carp_reference.plan(instance, Carp()).plans
    fleet = PlannedFleet(instance)
    fleet.commit(plans)
    assert fleet.plans == plans


def test_a_plan_longer_than_the_records_that_a_fleet_begins_with_is_planned() -> None:
    cells = tuple(Resource(k) for k in range(10_000))
    line = ResourceGraph(cells, tuple((k, k + 1) for k in range(len(cells) - 1)))
    (plan,) = carp_optimized.plan(Instance(line, (Robot("r", 0, cells[-1].id),)), Carp()).plans
    assert [visit.enter for visit in plan.visits] == [cell.id for cell in cells]


UNEVEN = ResourceGraph((*LINE.resources[:2], Resource("c", duration=2), Resource("d")), (*LINE.edges, ("b", "d")))


@pytest.mark.parametrize(
    ("cut", "instance", "planner"),
    [
        (("keys", "nodes"), grid_instance(Grid(4, 4), Fleet(9)), Neighbourhood(m=3)),
        (("expanded", "ready"), grid_instance(Grid(4, 4), Fleet(9)), Neighbourhood(m=3)),
        (("keys", "nodes"), Instance(UNEVEN, (Robot("r", "a", "b"), Robot("s", "d", "c"))), Carp()),
    ],
    ids=["the queue of a query", "what it expands", "the queue of a guide, where a resource waits several times"],
)
def test_scratch_grows(
    monkeypatch: pytest.MonkeyPatch, cut: tuple[str, str], instance: Instance, planner: Planner
) -> None:
    no_search, calls = room.no_search, count()

    def search(windows: int, edges: int) -> Search:
        whole = no_search(windows, edges)
        return whole if next(calls) else whole._replace(**{name: getattr(whole, name)[:2].copy() for name in cut})

    monkeypatch.setattr(encoding, "no_search", search)
    assert_alike(instance, planner)


def test_guides_that_do_not_all_fit_are_made_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "GUIDE_PLACES", 1)
    instance = grid_instance(Grid(9, 9), Fleet(70, distinct="goals"))
    for planner in (Carp(), Greedy()):
        assert_alike(instance, planner)


@pytest.mark.parametrize("pace", [1, 3])
@pytest.mark.parametrize(("each", "last"), [(1, 1), (1, 2), (MOST_LEVELS, MOST_LEVELS + 1)])
def test_a_guide_ends_a_detour_behind_the_start_until_more_of_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, each: int, last: int, pace: int
) -> None:
    """On a line, whose far end makes the durations alike or not."""
    monkeypatch.setattr(room, "DETOUR", 3)
    cells = (*(Resource(str(k), duration=each) for k in range(19)), Resource("19", duration=last))
    line = ResourceGraph(cells, tuple((str(k), str(k + 1)) for k in range(19)))
    fleet = PlannedFleet(Instance(line, (Robot("r", "4", "2", pace=pace), Robot("s", "17", "2", pace=pace))))
    to_goal = [*(pace * each * abs(k - 2) for k in range(19)), pace * (16 * each + last)]
    reached = 4 + 3 * last // each
    assert fleet.ticks_to_goal(0) == 2 * pace * each
    assert fleet.state.guides.ticks[0].tolist() == [*to_goal[: reached + 1], *(FURTHER,) * (19 - reached)]
    assert fleet.ticks_to_goal(1) == 15 * pace * each
    assert potentials(fleet, 0) == [dict(enumerate(to_goal))]


@pytest.mark.parametrize("planner", PLANNERS, ids=str)
def test_a_detour_longer_than_that_of_a_guide_is_found(monkeypatch: pytest.MonkeyPatch, planner: Planner) -> None:
    """The short way from a to d is blocked by a robot that stays, or for 33 ticks; the long one has eleven cells."""
    long = tuple(f"l{k}" for k in range(11))
    cells = tuple(Resource(cell) for cell in ("a", "b", "d", "side", *long))
    around = ("a", *long, "d")
    graph = ResourceGraph(cells, (("a", "b"), ("b", "d"), ("b", "side"), *pairwise(around)))
    robot = Robot("r", "a", "d", release=20)
    for stays in (Robot("stays", "b", "b"), Robot("stays", "b", "side", pace=33)):
        for detour in (0, 1, 8, LARGEST):
            monkeypatch.setattr(room, "DETOUR", detour)
            assert_alike(Instance(graph, (stays, robot), "park"), planner)
            assert_alike(Instance(replace(graph, edges=graph.edges[:-1]), (stays, robot), "park"), planner)


@pytest.mark.parametrize("longest", [1, 2, MOST_LEVELS + 1])
def test_ranks_take_the_place_of_ticks_and_indices_that_do_not_fit_into_32_bits(
    monkeypatch: pytest.MonkeyPatch, longest: int
) -> None:
    instance = grid_instance(Grid(9, 9), Fleet(70))
    durations = cycle([1, 1, longest])
    cells = tuple(replace(cell, duration=next(durations)) for cell in instance.graph.resources)
    instance = replace(instance, graph=replace(instance.graph, resources=cells))
    assert PlannedFleet(instance).state.guides.rank.size == 0
    monkeypatch.setattr(encoding, "scale_of_tolls", lambda *_: 0)
    assert PlannedFleet(instance).state.guides.rank.size > 0
    for planner in (Carp(), Neighbourhood(m=3)):
        assert_alike(instance, planner)


@pytest.mark.parametrize(("duration", "last", "pace"), [(LARGEST, 1, 1), (LARGEST, LARGEST, 1), (1, 1, LARGEST)])
def test_a_goal_that_is_too_far_is_refused(duration: int, last: int, pace: int) -> None:
    cells = (Resource("a", duration=duration), Resource("b", duration=duration), Resource("c", duration=last))
    far = ResourceGraph(cells, LINE.edges)
    for planner in PLANNERS:
        with pytest.raises(Refusal, match="the reference engine has no such limit"):
            carp_optimized.plan(Instance(far, (Robot("r", "a", "c", pace=pace),)), planner)


def test_robots_whose_plans_have_ended_are_left_alone() -> None:
    robots = (Robot("r", "a", "b"), Robot("s", "b", "c", 5), Robot("t", "a", "c", 40))
    instance = Instance(LINE, robots)
    plans = (
        Plan("r", (Visit("a", 0, 1), Visit("b", 1, 2))),
        Plan("s", (Visit("b", 5, 6), Visit("c", 6, 7))),
    )
    for now in (0, 2, 6, 7, 40):
        question = (instance, Solution(plans, ("r", "s"), ("t",)), "t", now, Neighbourhood(m=3))
        assert carp_optimized.add(*question) == carp_reference.add(*question)


def test_terms_of_distances_are_whole_roots() -> None:
    called = numba.njit(lambda dx, dy: term(dx, dy))  # noqa: PLW0108 - Python itself cannot call what is compiled for compiled code
    stream = splitmix64(1)
    for _ in range(2000):
        most = 2 ** (1 + next(stream) % 29)
        dx, dy = next(stream) % most, next(stream) % most
        assert called(dx, dy) == isqrt((dx * dx + dy * dy) << 32)
    for dx, dy in ROUNDED_UP:
        assert called(dx, dy) == isqrt((dx * dx + dy * dy) << 32) < int(sqrt(dx * dx + dy * dy) * 2**16)
