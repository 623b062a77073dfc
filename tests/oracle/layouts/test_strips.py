"""The two directions of a lane are one piece of the floor, however its length or its course is given."""

import json
from collections.abc import Sequence
from itertools import combinations

import pytest
from tests.oracle.layouts.test_footprint_check import kept_apart

from carproof import Footprint, Settings, import_layout
from carproof.layouts import Imported

Spot = tuple[float, float]
NOTE = "lanes of another length than the way back; robots may meet on the two"


def curve(*spots: Spot) -> dict[str, object]:
    """The properties of an edge with these control points, in m."""
    return {"trajectory": {"knotVector": [], "controlPoints": [{"x": x, "y": y} for x, y in spots]}}


def guided(length: float) -> dict[str, object]:
    return {"physicalLineGuidedProperty": {"length": length}}


def lif(end: Spot, there: Sequence[dict[str, object]], back: Sequence[dict[str, object]]) -> bytes:
    """Two nodes, one at the origin, and an edge in each direction with properties for each type of vehicle."""
    nodes = [{"nodeId": name, "nodePosition": {"x": x, "y": y}} for name, (x, y) in (("a", (0, 0)), ("b", end))]
    edges = [
        {"edgeId": ends, "startNodeId": ends[0], "endNodeId": ends[1], "vehicleTypeEdgeProperties": properties}
        for ends, properties in (("ab", list(there)), ("ba", list(back)))
    ]
    layout = {"layoutId": "1", "nodes": nodes, "edges": edges, "stations": []}
    return json.dumps({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": [layout]}, indent=1).encode()


def graph(*links: tuple[str, str, float | None]) -> bytes:
    """Two nodes that are 5 m apart, and links of a length in m."""
    nodes = [{"id": "a", "x": 0, "y": 0}, {"id": "b", "x": 3, "y": 4}]
    edges = [{"source": a, "target": b} | ({} if length is None else {"length": length}) for a, b, length in links]
    rows = ",\n".join(map(json.dumps, edges))
    return f'{{"directed": true, "nodes": {json.dumps(nodes)},\n"links": [\n{rows}]}}'.encode()


def plant(text: bytes, size: Footprint | None = None) -> Imported:
    return import_layout(text, settings=Settings(robots=0, footprint=size))


def together(made: Imported) -> set[frozenset[str]]:
    """The pairs of resources that are in a group."""
    return {
        frozenset(map(str, pair)) for each in made.instance.graph.groups for pair in combinations(each.resources, 2)
    }


def apart(made: Imported) -> list[int]:
    """The lines of the lanes of which it is not known whether robots meet on them."""
    return [line for each in made.notes if each.feature == NOTE for line in each.lines]


LINE = [(0, 0), (0.5, 0.5), (1, 1)]
BEND = [(0, 0), (0, 1), (1, 1)]
OTHER_BEND = [(0, 0), (1, 0), (1, 1)]
THIRDS = [(0, 0), (1.3333333, 1), (2.6666667, 2), (4, 3)]
ONE_PIECE = {
    "control points on a line": lif((1, 1), [curve(*LINE)], [curve(*LINE[::-1])]),
    "control points on a line, and none": lif((1, 1), [curve(*LINE)], []),
    "control points on a line but for less than a mm": lif((4, 3), [curve(*THIRDS)], []),
    "ends between two mm": lif((1.0004, 0), [curve((0, 0), (1.0004, 0))], [curve((1.0004, 0), (0.5003, 0), (0, 0))]),
    "a length that is not that of the straight lane": lif((1, 1), [guided(1.42)], [guided(1.42)]),
    "a curve driven both ways": lif((1, 1), [curve(*BEND)], [curve(*BEND[::-1])]),
    "a curve of which one direction leaves out the ends": lif((1, 1), [curve(*BEND)], [curve((0, 1))]),
    "a curve with a length that one direction has alone": lif((1, 1), [curve(*BEND) | guided(3)], [curve(*BEND[::-1])]),
    "one of several types drives the curve": lif((1, 1), [curve(*OTHER_BEND), curve(*BEND)], [curve(*BEND[::-1])]),
    "one of several types drives straight": lif((1, 1), [{}, curve(*BEND)], []),
}


@pytest.mark.parametrize("name", ONE_PIECE)
def test_the_two_directions_of_an_edge_of_lif_are_a_group(name: str) -> None:
    made = plant(ONE_PIECE[name])
    assert together(made) == {frozenset(("ab", "ba"))}
    assert apart(made) == []


def test_points_on_a_line_make_a_lane_no_longer_than_it_is() -> None:
    for points in (THIRDS, [(0, 0), (4, 3)]):
        made = plant(lif((4, 3), [curve(*points)], []))
        assert made.instance.graph.resource["ab"].duration == 5


@pytest.mark.parametrize("lengths", [(7, 7), (7.0001, 7.0004), (5, None), (None, None)])
def test_lanes_of_one_length_between_two_points_are_a_group(lengths: tuple[float | None, float | None]) -> None:
    made = plant(graph(("a", "b", lengths[0]), ("b", "a", lengths[1])))
    assert together(made) == {frozenset(("a -> b", "b -> a"))}
    assert apart(made) == []


def test_lanes_of_several_lengths_are_not_a_group_and_those_with_a_way_back_of_another_length_are_listed() -> None:
    made = plant(graph(("a", "b", 7), ("b", "a", 7), ("a", "b", 7), ("b", "a", 8), ("a", "b", None)))
    assert together(made) == {frozenset(pair) for pair in combinations(("a -> b", "b -> a", "a -> b'"), 2)}
    assert apart(made) == [3, 4, 5, 6, 7]
    assert apart(plant(graph(("a", "b", 7), ("a", "b", 8)))) == [], "robots that follow each other do not meet"


@pytest.mark.parametrize("back", [[guided(3)], []])
def test_a_way_back_of_which_the_course_is_not_known_is_listed_beside_a_curve(back: list[dict[str, object]]) -> None:
    text = lif((1, 1), [curve(*BEND)], back)
    made = plant(text)
    assert together(made) == set()
    assert apart(made) == [text[: text.index(b'"edgeId": "ba"')].count(b"\n")]


def test_a_curve_and_a_straight_way_back_are_two_pieces_of_the_floor() -> None:
    made = plant(lif((1, 1), [curve(*BEND)], [curve(*LINE[::-1])]))
    assert together(made) == set()
    assert apart(made) == []


@pytest.mark.parametrize("shift", [0, 5])
def test_two_half_circles_are_two_pieces_of_the_floor(shift: int) -> None:
    """As LIF.md, section 10.17, whose control points of version 1.0 do not lead from node to node."""
    above, below = ([(x + shift, y) for x, y in ((0, 0), (0, side), (3.6, side), (3.6, 0))] for side in (1.8, -1.8))
    made = plant(lif((10, 0), [curve(*above)], [curve(*below[::-1])]))
    assert together(made) == set()
    assert apart(made) == []


def test_who_holds_the_ends_of_a_lane_of_opentcs_meets_nobody_on_the_way_back() -> None:
    points = "".join(f'<point name="{name}" positionX="{x}" positionY="0"/>' for name, x in (("a", 0), ("b", 5000)))
    paths = "".join(
        f'<path name="{a}{b}" sourcePoint="{a}" destinationPoint="{b}" length="{length}" maxVelocity="1"'
        ' maxReverseVelocity="0"/>'
        for a, b, length in (("a", "b", 7000), ("b", "a", 8000))
    )
    made = plant(f'<model version="6.0.0" name="pair">{points}{paths}</model>'.encode())
    assert frozenset(("ab", "ba")) in together(made)
    assert apart(made) == []


@pytest.mark.parametrize("name", ONE_PIECE)
def test_lanes_between_two_points_are_one_shape_or_meet_for_vehicles_of_a_size(name: str) -> None:
    size = Footprint(300, 200)
    found = kept_apart(plant(ONE_PIECE[name], size).instance, size)
    assert frozenset(("ab", "ba")) in found
