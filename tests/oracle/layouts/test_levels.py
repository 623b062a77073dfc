"""Vehicles of a size on levels above each other are not in each other's way."""

import json
from itertools import combinations

import pytest
from tests.oracle.layouts.layout_files import OLD_OPENTCS, OPENTCS

from carproof import Footprint, Settings, import_layout
from carproof.layouts import Imported

SIZE = Footprint(900, 600)
PLANE = "check --footprint takes the positions of all as one plane"


def plant(text: str) -> Imported:
    return import_layout(text.encode(), settings=Settings(robots=0, footprint=SIZE))


def too_near(made: Imported) -> set[str]:
    """The pairs of resources that a group of two shapes keeps apart, like `a ab`."""
    found = [each.resources for each in made.instance.graph.groups if " | " in str(each.id)]
    return {" ".join(sorted(map(str, pair))) for each in found for pair in combinations(each, 2)}


def listed(made: Imported) -> list[int]:
    return [line for each in made.notes if each.feature.endswith(PLANE) for line in each.lines]


def opentcs(heights: dict[str, int | None], *paths: str) -> str:
    """Points at one place, but for `b` and `d`, which are 5 m away."""
    rises = {name: "" if height is None else f'positionZ="{height}"' for name, height in heights.items()}
    points = "".join(
        f'<point name="{name}" positionX="{5000 if name in "bd" else 0}" positionY="0" {rise}/>\n'
        for name, rise in rises.items()
    )
    rows = "".join(
        f'<path name="{each}" sourcePoint="{each[0]}" destinationPoint="{each[1]}" length="5000" maxVelocity="1"'
        ' maxReverseVelocity="0"/>'
        for each in paths
    )
    return f'<model version="6.0.0" name="levels">\n{points}{rows}</model>'


def lif(maps: dict[str, str | None], *edges: str) -> str:
    """Nodes at one place, but for `b` and `d`, which are 5 m away."""
    nodes = [
        {"nodeId": name, "nodePosition": {"x": 5 if name in "bd" else 0, "y": 0}}
        | ({} if map is None else {"mapId": map})
        for name, map in maps.items()
    ]
    ways = [{"edgeId": each, "startNodeId": each[0], "endNodeId": each[1]} for each in edges]
    layout = {"layoutId": "1", "nodes": nodes, "edges": ways, "stations": []}
    return json.dumps({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": [layout]})


def building(*levels: str) -> str:
    """A lane of 5 m on each level."""
    vertices = "[[0, 0, {name: a}], [5, 0, {name: b}]]"
    rows = "".join(f"\n  {each}: {{lanes: [[0, 1, {{}}]], vertices: {vertices}}}" for each in levels)
    return f"building_name: tower\nlevels:{rows}\n"


LANE = {"a ab", "ab b"}
FLOORS = {
    "openTCS": opentcs({"a": 0, "b": 0, "c": 4000, "d": 4000}, "ab", "cd"),
    "LIF": lif({"a": "ground", "b": "ground", "c": "first", "d": "first"}, "ab", "cd"),
}
ONE_PLANE = {
    "openTCS": opentcs({"a": 0, "b": 0, "c": 0, "d": None}, "ab", "cd"),
    "LIF": lif({"a": "ground", "b": "ground", "c": "ground", "d": "ground"}, "ab", "cd"),
}


@pytest.mark.parametrize("name", FLOORS)
def test_points_and_lanes_of_different_levels_are_never_too_near(name: str) -> None:
    assert too_near(plant(FLOORS[name])) == LANE | {"c cd", "cd d"}
    assert listed(plant(FLOORS[name]))
    assert too_near(plant(ONE_PLANE[name])) > LANE | {"a c", "b d", "ab cd", "a cd"}
    assert not listed(plant(ONE_PLANE[name]))


def test_levels_of_open_rmf_are_never_too_near() -> None:
    made = plant(building("L1", "L2"))
    lanes = [(f"{level}/a", f"{level}/a -> {level}/b", f"{level}/b") for level in ("L1", "L2")]
    assert too_near(made) == {f"{a} {lane}" for a, lane, _ in lanes} | {f"{lane} {b}" for _, lane, b in lanes}
    assert listed(made)
    assert not listed(plant(building("L1")))


@pytest.mark.parametrize(
    "text",
    [
        opentcs({"a": 0, "b": 0, "c": 4000, "d": 4000}, "ab", "cd", "ad"),
        lif({"a": "ground", "b": "ground", "c": "first", "d": "first"}, "ab", "cd", "ad"),
    ],
)
def test_a_lane_between_levels_is_on_both(text: str) -> None:
    found = too_near(plant(text))
    assert found >= {"ab ad", "ad cd", "a ad", "ad b", "ad c", "ad d"}
    assert found.isdisjoint({"ab cd", "a c", "b d", "a cd", "ab c", "ab d", "b cd"})


def test_a_node_of_lif_without_a_map_may_be_on_any() -> None:
    found = too_near(plant(lif({"a": "ground", "b": "ground", "c": "first", "d": None}, "ab")))
    assert {"ab d", "b d"} <= found
    assert found.isdisjoint({"a c", "ab c"})


@pytest.mark.parametrize(("heights", "are_apart"), [((0, 1999), False), ((0, 2000), True), ((-1000, 1000), True)])
def test_heights_of_opentcs_are_levels_where_a_vehicle_has_room_between(
    heights: tuple[int, int], are_apart: bool
) -> None:
    made = plant(opentcs({"a": heights[0], "c": heights[1]}))
    assert too_near(made) == (set() if are_apart else {"a c"})
    assert listed(made) == [3]


def test_the_points_of_a_ramp_of_opentcs_are_on_one_level() -> None:
    assert too_near(plant(opentcs({"a": 0, "b": 1500, "c": 3000}))) == {"a c"}


def test_points_of_opentcs_without_a_height_are_at_0() -> None:
    raised = OPENTCS.replace('positionZ="0"', 'positionZ="3000"', 1)
    assert listed(plant(raised)) == [4, 5]
    assert listed(plant(OLD_OPENTCS)) == []
    assert listed(plant(raised.replace(' positionZ="0"', ""))) == [4, 5]
    assert listed(plant(OLD_OPENTCS.replace('positionZ="0"', 'zPosition="3000"', 1))) == [4, 5]
