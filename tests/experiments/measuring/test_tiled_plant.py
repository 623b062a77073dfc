"""Layouts tiled side by side: each tile is the layout, and robots go from tile to tile."""

from collections import Counter
from dataclasses import replace

import pytest
from tests.oracle.layouts.layout_files import LAYOUTS

import carp_optimized
from carp_experiments.measuring.tiled_plant import instance_of_tiles
from carp_experiments.measuring.tiling import tiled
from carp_spec import Carp, Refusal, judge
from carproof.layouts import read_layout
from carproof.layouts.strips import Strip

BROKEN = {
    "the layout must have lanes": '<model version="7.0.0"><point name="a" positionX="0" positionY="0"/></model>',
    "and a position of each point": "roadmap:\n  undirected: true\n  edges: [[a, b]]\n",
    "must have points where vehicles stand": LAYOUTS["opentcs"].replace("PARK", "HALT"),
}


def untiled(strips: tuple[Strip, ...]) -> tuple[Strip, ...]:
    return tuple(replace(each, ends=frozenset(end[2:] for end in each.ends)) for each in strips)


@pytest.mark.parametrize("name", LAYOUTS)
def test_each_tile_is_the_layout_and_neighbours_are_joined_both_ways(name: str) -> None:
    layout = read_layout(LAYOUTS[name].encode())[1]
    whole = tiled(layout, 5)  # in rows of three
    for tile in range(5):
        points = [each for each in whole.points.values() if each.id.startswith(f"{tile}/")]
        x, y = points[0].x or 0, points[0].y or 0
        found = [replace(each, id=each.id[2:], x=(each.x or 0) - x, y=(each.y or 0) - y) for each in points]
        assert found == list(layout.points.values())
        assert (x, y) == (8000 * (tile % 3), 9000 * (tile // 3))
        lanes = [each for each in whole.lanes.values() if each.source[0] == each.target[0] == str(tile)]
        assert [
            replace(each, id=each.id[2:], source=each.source[2:], target=each.target[2:], strips=untiled(each.strips))
            for each in lanes
        ] == list(layout.lanes.values())
        blocks = [each for each in whole.blocks.values() if each.id.startswith(f"{tile}/")]
        bare = [replace(each, id=each.id[2:], members=tuple(member[2:] for member in each.members)) for each in blocks]
        assert bare == list(layout.blocks.values())
    joins = Counter((int(each.source[0]), int(each.target[0])) for each in whole.lanes.values())
    pairs = {(0, 1), (1, 2), (3, 4), (0, 3), (1, 4)}
    assert {ends for ends in joins if ends[0] != ends[1]} == pairs | {(two, one) for one, two in pairs}
    assert all(joins[one, two] == 1 for one, two in joins if one != two)


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_plant_of_tiles_has_the_resources_and_plans_from_tile_to_tile(name: str) -> None:
    layout = read_layout(LAYOUTS[name].encode())[1]
    instance = instance_of_tiles(layout, 2, resources=24)
    assert 24 <= len(instance.graph.resources) <= 32
    assert any(str(robot.start)[0] != str(robot.goal)[0] for robot in instance.robots)
    solution = carp_optimized.plan(instance, Carp())
    assert judge(instance, solution).valid
    assert not solution.unplanned
    assert len(instance_of_tiles(layout, 7, resources=1).robots) == 7


@pytest.mark.parametrize("message", BROKEN)
def test_what_cannot_be_tiled_is_refused(message: str) -> None:
    layout = read_layout(BROKEN[message].encode())[1]
    with pytest.raises(Refusal, match=message):
        instance_of_tiles(layout, 1)
