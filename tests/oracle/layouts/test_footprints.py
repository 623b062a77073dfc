"""Footprints and turning: which points and lanes vehicles of a size may not use together, and what a turn takes."""

import json
from fractions import Fraction
from math import hypot
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.layouts.layout_files import lif
from tests.oracle.layouts.roadmaps import Place
from tests.oracle.layouts.test_footprint_check import kept_apart, plant
from tests.oracle.running import Run

from carproof import Footprint, Settings, import_layout, read_instance
from carproof.engines import engine_named


def apart(lanes: list[tuple[Place, Place]], size: Footprint) -> bool:
    """Whether the first two lanes may be used together."""
    names = {f"{a},{b} -> {c},{d}" for (a, b), (c, d) in lanes[:2]}
    return names not in kept_apart(plant(lanes, footprint=size), size)


NARROW, WIDE, DISC = Footprint(900, 600), Footprint(900, 900, round=True), Footprint(6, 6, round=True)
ALONG_3_4 = [((0, 0), (3000, 4000)), ((400, -300), (3400, 3700))]
"""500 mm apart: there the distance of parallel lanes is whole."""
ALONG_1_2 = [((0, 0), (1000, 2000)), ((1000, 0), (2000, 2000))]
"""1000 * 2 / sqrt(5) = 894.427 mm apart."""


@pytest.mark.parametrize(
    ("lanes", "size", "are_apart"),
    [
        ([((0, 0), (5000, 0)), ((0, 600), (5000, 600))], NARROW, True),  # they touch
        ([((0, 0), (5000, 0)), ((0, 599), (5000, 599))], NARROW, False),
        ([((0, 0), (5000, 0)), ((0, 900), (5000, 900))], WIDE, True),
        ([((0, 0), (5000, 0)), ((0, 899), (5000, 899))], WIDE, False),
        ([((5000, 0), (9000, 0)), ((8900, -2000), (8900, 2000))], NARROW, False),  # they cross near the end of one
        ([((0, 0), (2, 0)), ((-5, 3), (-7, 3))], DISC, False),  # their starts are nearest: 34 in square, not 36
        ([((0, 0), (2, 0)), ((-6, 0), (-8, 0))], DISC, True),
        (ALONG_3_4, Footprint(10, 500), True),
        (ALONG_3_4, Footprint(10, 501), False),
        (ALONG_1_2, Footprint(10, 894), True),
        (ALONG_1_2, Footprint(10, 895), False),
    ],
)
def test_lanes_may_be_used_together_if_vehicles_only_touch(
    lanes: list[tuple[Place, Place]], size: Footprint, are_apart: bool
) -> None:
    assert apart(lanes, size) == are_apart


def test_a_vehicle_that_turns_sweeps_a_disc_and_one_that_goes_on_does_not() -> None:
    size = Footprint(800, 600)  # half a diagonal is 500

    def meets(bend: Place, gap: int) -> bool:
        lanes = [((0, 0), (5000, 0)), ((5000, 0), bend), ((0, -gap), (9000, -gap))]
        return {"5000,0", f"0,{-gap} -> 9000,{-gap}"} in kept_apart(plant(lanes, footprint=size), size)

    assert meets((5000, 5000), 799)
    assert not meets((5000, 5000), 800)
    assert meets((9000, 0), 599)
    assert not meets((9000, 0), 600)


@pytest.mark.parametrize(
    ("size", "beside", "other", "met"),
    [
        ("8x6mm", (50, 8), "a -> b", False),
        ("8x6mm", (50, 7), "a -> b", True),
        ("8x6mm", (50, 20), "c", False),
        ("8x6mm", (50, 21), "c", True),
        ("8x6mm", (58, 38), "c", False),
        ("8x6mm", (57, 37), "c", True),
        ("7x4mm", (104, 6), "a -> b", False),  # it touches the corner
        ("7x4mm", (104, 5), "a -> b", True),
    ],
)
def test_a_point_without_lanes_is_a_disc(
    size: str, beside: Place, other: str, met: bool, carproof: Run, elsewhere: Path
) -> None:
    places = {"a": (0, 0), "b": (100, 0), "c": (50, 30), "beside": beside}
    nodes = [{"id": name, "x": x / 1000, "y": y / 1000} for name, (x, y) in places.items()]
    graph = {"directed": True, "nodes": nodes, "links": [{"source": "a", "target": "b"}]}
    (elsewhere / "plant").write_text(json.dumps(graph))
    assert carproof(f"convert plant -o plant.json --robots 0 --footprint {size}").code == 0
    found = read_instance((elsewhere / "plant.json").read_bytes()).graph.groups
    assert any({other, "beside"} == set(each.resources) for each in found) == met


def test_a_turn_on_the_spot_sweeps_a_disc() -> None:
    """Also where it is the first lane of a node; half a diagonal is 500 mm, half a width 300."""
    document = json.loads(lif("1.0.0"))
    layout = document["layouts"][0]
    node, edge = layout["nodes"][1], layout["edges"][0]
    layout["nodes"] += [{**node, "nodeId": "on"}, {**node, "nodeId": "near", "nodePosition": {"x": 3.999, "y": 0}}]
    layout["edges"].insert(0, {**edge, "edgeId": "turn", "startNodeId": "b", "endNodeId": "on"})
    layout["edges"].append({**edge, "edgeId": "away", "startNodeId": "on", "endNodeId": "a"})
    settings = Settings(robots=0, footprint=Footprint(800, 600))
    groups = import_layout(json.dumps(document).encode(), settings=settings).instance.graph.groups
    beside = {each for group in groups if "near" in group.resources for each in group.resources}
    assert beside == {"near", "turn", "b"}


def test_a_footprint_needs_positions(carproof: Run, elsewhere: Path) -> None:
    (elsewhere / "plant").write_text("roadmap:\n  undirected: true\n  edges: [[a, b]]\n")
    outcome = carproof("convert plant -o plant.json --footprint 450mm")
    assert outcome.code == 2
    assert outcome.stderr.startswith("Error: plant:1: the point 'a' must have a position, for a footprint")
    assert carproof("convert plant -o plant.json --robots 0").code == 0


coordinates = st.integers(0, 20)
places = st.tuples(coordinates, coordinates)
segments = st.tuples(places, places).filter(lambda ends: max(abs(a - b) for a, b in zip(*ends, strict=True)) > 1)


def swept(lane: tuple[Place, Place], size: Footprint, x: int, y: int) -> bool:
    """Whether the place is well within what a vehicle sweeps on the lane."""
    (a, b), (c, d) = lane
    long = hypot(c - a, d - b)
    across = ((c - a) * (y - b) - (d - b) * (x - a)) / long
    along = ((c - a) * (x - a) + (d - b) * (y - b)) / long
    beyond = max(-along, along - long)
    if size.round:
        return hypot(max(beyond, 0), across) < size.length / 2 - 1e-6
    return abs(across) < size.width / 2 - 1e-6 and beyond < size.length / 2 - 1e-6


@given(st.lists(segments, min_size=2, max_size=2, unique=True), st.integers(1, 9), st.integers(1, 9), st.booleans())
def test_lanes_that_sweep_one_place_are_never_used_together(
    lanes: list[tuple[Place, Place]], length: int, width: int, round: bool
) -> None:
    size = Footprint(length, length if round else width, round=round)
    common = any(all(swept(lane, size, x, y) for lane in lanes) for x in range(-6, 27) for y in range(-6, 27))
    if common and lanes[0] != lanes[1][::-1]:
        assert not apart(lanes, size)


def test_a_turn_takes_its_time_and_a_straight_way_none() -> None:
    corner = [((0, 0), (1000, 0)), ((1000, 0), (2000, 0)), ((1000, 0), (1000, 1000)), ((1000, 0), (0, 1000))]
    instance = plant(corner, turning=Fraction(3))
    rows = [("0,0", "2000,0", 0), ("0,0", "1000,1000", 3), ("0,0", "0,1000", 6)]
    for start, goal, turning in rows:
        asked = f'robot,start,goal\nr1,"{start}","{goal}"\n'.encode()
        plans = [
            engine_named("reference").find(plant(corner, turning=time, requests=asked, robots=None), [], "r1")
            for time in (Fraction(3), None)
        ]
        slow, fast = (plan.visits[-1].enter for plan in plans if plan is not None)
        # the heading before and after a turn, and the goal itself, take a tick each
        assert slow - fast == (turning + 1 if turning else 0) + 1, (start, goal)
    assert any({"1000,0", "1000,0 @1,0", "1000,0 @0,1"} <= set(each.resources) for each in instance.graph.groups)
