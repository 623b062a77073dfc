"""`check --footprint --cells`: vehicles of a size keep apart on a floor without lanes."""

import json
from dataclasses import replace
from itertools import pairwise, product
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs
from tests.oracle.running import Run

from carp_spec import Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit
from carproof import Footprint, check, write_instance, write_solution

Place = tuple[int, int]
Floats = npt.NDArray[Any]


def floor(*routes: list[Place]) -> tuple[Instance, Solution]:
    """A cell for each place, and a robot for each route, which is a tick in each of its cells and stays in the last."""
    places = dict.fromkeys(place for route in routes for place in route)
    edges = dict.fromkeys((f"{a}/{b}", f"{c}/{d}") for route in routes for (a, b), (c, d) in pairwise(route))
    resources = tuple(Resource(f"{x}/{y}", 9, 1, x, y) for x, y in places)
    names = [[f"{x}/{y}" for x, y in route] for route in routes]
    robots = tuple(Robot(f"r{number}", route[0], route[-1]) for number, route in enumerate(names))
    plans = [
        Plan(
            robot.id,
            tuple(Visit(name, tick, tick + 1 if tick + 1 < len(route) else None) for tick, name in enumerate(route)),
        )
        for robot, route in zip(robots, names, strict=True)
    ]
    instance = Instance(ResourceGraph(resources, tuple(edges), directed=True), robots, "park")
    return instance, Solution.of(instance, plans)


def too_near(size: Footprint, *routes: list[Place], cells: int = 1) -> set[int | None]:
    """The first ticks at which two robots are too near."""
    instance, solution = floor(*routes)
    found = check(instance, solution, None, size, cells).violations
    return {each.start for each in found if each.rule == "footprint/apart"}


coordinates = st.integers(0, 9)
routes = st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=4).filter(
    lambda route: all(one != two for one, two in pairwise(route))
)


def ways(route: list[Place], tick: int) -> list[tuple[float, float]]:
    """The corners of where the middle of a vehicle may be, at a tick: half ways and the cell between."""
    now = min(tick, len(route) - 1)
    x, y = route[now]
    beside = [route[other] for other in (now - 1, now + 1) if 0 <= other < len(route)]
    halves = [((x + a) / 2, (y + b) / 2) for a, b in beside]
    return [*halves[:1], (float(x), float(y)), *halves[1:]] if now else [(float(x), float(y)), *halves]


def samples(corners: list[tuple[float, float]], most: int = 60) -> Floats:
    """Places on the way, as complex numbers."""
    shares = np.arange(most + 1) / most
    ends = pairwise([complex(*each) for each in (*corners, corners[-1])])
    return np.concatenate([one + (two - one) * shares for one, two in ends])


@given(routes, routes, st.integers(1, 8))
def test_discs_are_too_near_where_their_middles_may_be(one: list[Place], two: list[Place], diameter: int) -> None:
    found = too_near(Footprint(diameter, diameter, round=True), one, two)
    for tick in range(max(len(one), len(two))):
        here, there = (samples(ways(route, tick)) for route in (one, two))
        nearest = np.abs(here[:, None] - there).min()
        if nearest < diameter - 1e-6:
            assert tick in found
        elif nearest > diameter + 0.25:  # more than two samples are apart
            assert tick not in found


SPOTS = (np.arange(-10, 30)[:, None] + 1j * np.arange(-10, 30)).ravel() / 2


def covered(size: Footprint, route: list[Place], tick: int) -> Floats:
    """Which spots are well within what a rectangle sweeps during a tick, on its way and while it turns."""
    corners = ways(route, tick)
    inside = np.zeros(SPOTS.shape, bool)
    moves = [complex(c - a, d - b) for (a, b), (c, d) in pairwise(corners)]
    for ends, move in zip(pairwise(corners), moves, strict=True):
        for place in samples([*ends], 12):
            apart = (SPOTS - place) * move.conjugate() / abs(move)
            inside |= (abs(apart.real) < size.length / 2 - 1e-6) & (abs(apart.imag) < size.width / 2 - 1e-6)
    if not moves or abs((moves[0] * moves[-1].conjugate()).imag) > 1e-6:
        reach = hypot(size.length, size.width) / 2 - 1e-6
        inside |= abs(SPOTS - complex(*route[min(tick, len(route) - 1)])) < reach
    return inside


@given(routes, routes, st.integers(1, 5), st.integers(1, 5))
def test_rectangles_that_sweep_one_place_are_too_near(
    one: list[Place], two: list[Place], length: int, width: int
) -> None:
    size = Footprint(length, width)
    found = too_near(size, one, two)
    for tick in range(max(len(one), len(two))):
        if (covered(size, one, tick) & covered(size, two, tick)).any():
            assert tick in found


@pytest.mark.parametrize(
    ("size", "routes", "found"),
    [
        # side by side, as they touch; ways that cross between the cells, where nobody ever stands
        (Footprint(900, 1000), ([(0, 0), (3, 0)], [(0, 1), (3, 1)]), set()),
        (Footprint(900, 1001), ([(0, 0), (3, 0)], [(0, 1), (3, 1)]), {0, 1}),
        (Footprint(9, 9), ([(0, 0), (3, 3)], [(3, 0), (0, 3)]), {0, 1}),
        # one that follows at a distance of two cells, and one that turns beside another
        (Footprint(900, 600), ([(2, 0), (3, 0), (4, 0)], [(0, 0), (1, 0), (2, 0)]), set()),
        (Footprint(900, 600), ([(0, 0), (1, 0), (2, 0)], [(1, 1), (3, 1)]), set()),
        (Footprint(1200, 700), ([(0, 0), (1, 0), (1, -1)], [(0, 1), (1, 1), (2, 1)]), {1}),
        # along diagonals, without a turn; on the chord of a turn that was made before; one beside the other
        (Footprint(400, 707), ([(0, 0), (1, 1), (2, 2)], [(1, 0), (2, 1), (3, 2)]), set()),
        (Footprint(100, 100), ([(0, 0), (2, 0), (2, 2)], [(1, 1)]), set()),
        (Footprint(900, 900, round=True), ([(0, 0)], [(1, 0)]), set()),
    ],
)
def test_vehicles_in_cells_of_a_metre(size: Footprint, routes: list[list[Place]], found: set[int]) -> None:
    for across, x, y in product((False, True), (1, -1), (1, -1)):
        turned = [[(x * a, y * b) for a, b in (each[:: -1 if across else 1] for each in route)] for route in routes]
        assert too_near(size, *turned, cells=1000) == found


def test_cells_without_positions_are_refused() -> None:
    instance = Instance(ResourceGraph((Resource("a"),), ()), ())
    with pytest.raises(Refusal, match=r"\$\.graph\.resources\[0\].* \[footprint/positions\]"):
        check(instance, Solution((), ()), footprint=Footprint(1, 1), cells=1)


def test_two_visits_are_told_once_though_several_shapes_of_them_overlap() -> None:
    instance, solution = floor([(0, 0), (3, 3), (6, 0)], [(3, 0), (0, 3), (3, 6)])
    found = check(instance, solution, None, Footprint(9, 9), 1).violations
    assert [each.start for each in found] == [0, 1, 2]


def test_a_vehicle_turns_between_the_headings_of_a_cell() -> None:
    instance, solution = floor([(0, 0), (2, 0)], [(0, 1), (2, 1)])
    turned = Resource("0/0 north", 1, 1, 0, 0)
    graph = ResourceGraph((*instance.graph.resources, turned), (*instance.graph.edges, ("0/0 north", "0/0")))
    first, second = solution.plans
    later = replace(first, visits=tuple(structs.replace(visit, enter=visit.enter + 1) for visit in first.visits))
    turning = replace(
        first, visits=(Visit("0/0 north", 0, 1), structs.replace(later.visits[0], leave=2), later.visits[1])
    )
    robots = (Robot("r0", "0/0 north", "2/0"), instance.robots[1])
    split = Instance(graph, robots, "park")
    found = check(split, Solution.of(split, [turning, second]), footprint=Footprint(1200, 700), cells=1000)
    assert {each.start for each in found.violations} == {0}


def test_command_op_and_python_agree(carproof: Run, process: Run, elsewhere: Path) -> None:
    instance, solution = floor([(0, 0), (3, 3)], [(3, 0), (0, 3)])
    (elsewhere / "grid.json").write_bytes(write_instance(instance))
    (elsewhere / "plans.json").write_bytes(write_solution(solution))
    answer = carproof("check grid.json plans.json --footprint 450mm --cells 1m --json")
    assert answer.code == 1
    said = json.loads(answer.stdout)["violations"]
    expected = check(instance, solution, footprint=Footprint(900, 900, round=True), cells=1000).violations
    assert [each["message"] for each in said] == [each.message for each in expected]
    documents = {name: json.loads((elsewhere / f"{name}.json").read_text()) for name in ("grid", "plans")}
    asked = {"id": 1, "op": "check", "instance": documents["grid"], "solution": documents["plans"]}
    sizes = [{"footprint": "450mm", "cells": "1m"}, {"footprint": "450mm"}, {"footprint": "450"}, {"cells": "1m"}, {}]
    lines = "\n".join(json.dumps(asked | size) for size in sizes)
    result, *refused, plain = map(json.loads, process("serve", stdin=f"{lines}\n".encode()).stdout.splitlines())
    assert result["result"]["violations"] == said
    assert [(each["error"]["rule"], each["error"]["path"]) for each in refused] == [
        ("footprint/lanes", "$.instance.graph.edges[0]"),
        ("layout/settings", "$.footprint"),
        ("footprint/cells", "$.cells"),
    ]
    assert plain["result"]["violations"] == []


@pytest.mark.parametrize("cells", [0, -1, True])
def test_a_step_that_is_none_is_refused(cells: int) -> None:
    with pytest.raises(Refusal, match="footprint/cells"):
        check(*floor([(0, 0)]), footprint=Footprint(1, 1), cells=cells)
