"""How fast a query of the optimised planner is, beside C++ written by hand and the reference: `make bench`."""

import subprocess
from pathlib import Path
from statistics import median
from time import thread_time_ns

import pytest
from tests.programs import require_programs

import carp_reference
from carp_experiments.measuring.bench_times import ROBOTS
from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.orderings import carp
from carp_optimized.state.arrays import NEVER
from carproof.generate import Fleet, Grid, grid_instance

HERE = Path(__file__).parent
ASSIGNMENTS = range(20)
TIMES = 5_000


def fleet_of(seed: int, robots: int = ROBOTS) -> PlannedFleet:
    """A fleet on map 20 with all robots but the last planned."""
    fleet = PlannedFleet(grid_instance(Grid(map=20), Fleet(robots=robots, seed=seed)))
    carp(fleet, range(robots - 1))
    return fleet


def dump(fleet: PlannedFleet, robots: list[int]) -> str:
    """The windows and the guides as numbers, for `query.cpp`."""
    state = fleet.state
    windows, graph = state.windows, state.graph
    numbers = [graph.duration.size, graph.target.size, len(robots), TIMES]
    for offset, size in zip(windows.offset.tolist(), windows.size.tolist(), strict=True):
        numbers.append(size)
        for slot in range(offset, offset + size):
            numbers += [int(windows.start[slot]), int(windows.end[slot]), int(windows.source[slot])]
    for resource in range(graph.duration.size):
        targets = graph.target[graph.first[resource] : graph.first[resource + 1]].tolist()
        numbers += [len(targets), *targets]
    for robot in robots:
        passes.shortest(fleet.native, robot)
        ticks = state.guides.ticks[state.guides.slot[state.robots.destination[robot]]]
        numbers += [int(state.robots.start[robot]), int(state.robots.release[robot]), int(state.robots.goal[robot])]
        for resource, each in enumerate(ticks.tolist()):
            numbers += [-1, 0] if each < 0 else [each, each * state.scale + resource & (NEVER * 2 + 1)]
    return " ".join(map(str, numbers))


def by_hand(program: Path, fleet: PlannedFleet, robot: int) -> tuple[int, float]:
    """The arrival by `query.cpp`, and the nanoseconds that it takes."""
    done = subprocess.run([program], input=dump(fleet, [robot]), capture_output=True, text=True, check=True)
    arrival, nanoseconds = done.stdout.split()
    return int(arrival), float(nanoseconds)


def ours(fleet: PlannedFleet, robot: int) -> tuple[int, float]:
    """The same by the optimised planner."""
    plan = fleet.find(robot, None, 0)
    fleet.call(lambda: passes.repeat_query(fleet.native, robot, 10))
    began = thread_time_ns()
    fleet.call(lambda: passes.repeat_query(fleet.native, robot, TIMES))
    return -1 if plan is None else plan.visits[-1].enter, (thread_time_ns() - began) / TIMES


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_programs("g++")
    path = tmp_path_factory.mktemp("query") / "query"
    subprocess.run(["g++", "-O3", "-march=native", "-std=c++17", "-o", path, HERE / "query.cpp"], check=True)  # noqa: S607
    return path


def test_a_query_takes_at_most_1_3_times_what_it_takes_by_hand(program: Path) -> None:
    hand, own = [], []
    for seed in ASSIGNMENTS:
        fleet = fleet_of(seed)
        (arrival, by_hand_ns), (own_arrival, own_ns) = by_hand(program, fleet, ROBOTS - 1), ours(fleet, ROBOTS - 1)
        assert arrival == own_arrival
        hand.append(by_hand_ns)
        own.append(own_ns)
    ratio = median(one / other for one, other in zip(own, hand, strict=True))
    print(f"a query: {median(own):.0f} ns, by hand {median(hand):.0f} ns, ratio {ratio:.2f}")  # noqa: T201
    assert ratio <= 1.3


def test_a_query_is_at_least_a_hundred_times_as_fast_as_the_reference() -> None:
    ratios = []
    for seed in ASSIGNMENTS[:5]:
        fleet = fleet_of(seed)
        began = thread_time_ns()
        carp_reference.query(fleet.instance, fleet.plans, fleet.instance.robots[-1].id)
        reference_ns = thread_time_ns() - began
        ratios.append(reference_ns / ours(fleet, ROBOTS - 1)[1])
    print(f"the reference takes {median(ratios):.0f} times as long for a query")  # noqa: T201
    assert median(ratios) >= 100
