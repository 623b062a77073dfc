"""Layouts of fleet systems: what becomes of each feature, what is listed instead, and where a broken file is wrong."""

import json
import re
from contextlib import suppress
from fractions import Fraction
from itertools import permutations
from pathlib import Path

import pytest
from tests.oracle.layouts.layout_files import (
    ANNOTATED,
    BUILDING,
    GRAPHML,
    LAYOUTS,
    NAV_GRAPH,
    NODE_LINK,
    OLD_OPENTCS,
    OPENTCS,
    lif,
    nav2,
)
from tests.oracle.running import Run

from carp_spec import Instance, Plan, Refusal, Robot, Solution, Visit, judge
from carproof import Settings, import_layout
from carproof.layouts import READERS


def imported(text: str, **settings: object) -> Instance:
    return import_layout(text.encode(), settings=Settings(**settings)).instance  # type: ignore[arg-type]


def groups(instance: Instance) -> dict[object, set[object]]:
    return {each.id: set(each.resources) for each in instance.graph.groups}


@pytest.mark.parametrize("name", LAYOUTS)
def test_each_format_gives_the_same_row_of_points_with_its_lanes_in_millimetres(name: str) -> None:
    graph = imported(LAYOUTS[name], robots=0, tick=Fraction(1, 2)).graph
    assert {each: (graph.resource[each].x, graph.resource[each].y) for each in "abc"} == {
        "a": (0, 0),
        "b": (3000, 0),
        "c": (3000, 4000),
    }
    lanes = {
        (before, after): each.duration
        for each in graph.resources
        for before, into in graph.moves
        for out, after in graph.moves
        if into == out == each.id and each.id not in tuple("abc")
    }
    assert {ends for ends in lanes if ends[0] != ends[1]} == {("a", "b"), ("b", "c"), ("c", "b")}
    assert lanes["a", "b"] == 6
    slow = {"opentcs": (6, 16), "old opentcs": (6, 16), "annotated": (8, 8)}.get(name, (16, 16))
    assert (lanes["b", "c"], lanes["c", "b"]) == slow


@pytest.mark.parametrize("name", sorted(set(LAYOUTS) - {"annotated"}))
def test_two_robots_never_meet_on_the_two_directions_of_a_lane(name: str) -> None:
    instance = imported(LAYOUTS[name], robots=0)
    there, back = (
        next(lane for source, lane in instance.graph.moves if source == one and (lane, two) in instance.graph.moves)
        for one, two in ("bc", "cb")
    )
    assert any({there, back} <= members for members in groups(instance).values())


def test_the_tick_and_the_speed_of_vehicles_decide_durations_which_are_rounded_up() -> None:
    assert imported(OPENTCS, tick=Fraction(7, 10), robots=0).graph.resource["bc"].duration == 4  # 2.67 s
    assert imported(OPENTCS, speed=Fraction(100), robots=0).graph.resource["bc"].duration == 40
    assert imported(OPENTCS, speed=Fraction(9000), robots=0).graph.resource["bc"].duration == 3


def test_vehicles_of_the_file_are_the_robots_and_goals_are_drawn_from_the_seed() -> None:
    assert imported(ANNOTATED).robots == (Robot("agent0", "a", "c"),)
    assert imported(BUILDING, seed=5).robots == imported(BUILDING, seed=5).robots
    assert [each.id for each in imported(BUILDING).robots] == ["tiny"]


def test_robots_are_drawn_on_points_where_vehicles_may_stand_and_that_reach_each_other() -> None:
    drawn = imported(NAV_GRAPH, robots=2, seed=3).robots
    assert {each.start for each in drawn} | {each.goal for each in drawn} <= {"b", "c"}  # a is not reached again
    with pytest.raises(Refusal, match=r"reach each other, and the layout has 2 \[generate/ends\]"):
        imported(NAV_GRAPH, robots=3)


def test_robots_are_drawn_only_where_they_may_stand_together() -> None:
    shared = OPENTCS.replace('<member name="ab"/><member name="bc"/>', '<member name="a"/><member name="c"/>')
    shared = shared.replace('type="HALT_POSITION"', 'type="PARK_POSITION"')
    shared = shared.replace('maxReverseVelocity="0"', 'maxReverseVelocity="1000"')
    for seed in range(8):
        robots = imported(shared, robots=2, seed=seed).robots
        assert {each.start for each in robots} != {"a", "c"} != {each.goal for each in robots}
    with pytest.raises(Refusal, match="3 robots need as many points where vehicles may stand together"):
        imported(shared, robots=3)


def test_requests_name_robots_starts_goals_and_releases() -> None:
    rows = b"robot,start,goal,release\nr1,a,c,5\nr2,b,c,\n"
    assert imported(OPENTCS, requests=rows).robots == (Robot("r1", "a", "c", 5), Robot("r2", "b", "c"))
    for rows, where in (
        (b"robot,start\nr1,a\n", "orders.csv:1"),
        (b"", "orders.csv:1"),
        (b"robot,start,goal,relase\nr1,a,c,5\n", "orders.csv:1"),
        (b"robot,start,goal\n\nr1,a,z\n", "orders.csv:3"),
        (b"robot,start,goal\nr1,a,z\n", "orders.csv:2"),
        (b"robot,start,goal\nr1,a,b\nr1,b,c\n", "orders.csv:3"),
    ):
        with pytest.raises(Refusal, match=where):
            imported(OPENTCS, requests=rows, requests_file="orders.csv")


def test_values_that_a_graph_has_for_all_edges_are_those_of_each_without_its_own() -> None:
    slow = GRAPHML.replace('attr.name="speed" attr.type="double"/>', 'attr.name="speed"><default>0.1</default></key>')
    assert [imported(slow, robots=0).graph.resource[each].duration for each in ("a -> b", "b -> c")] == [30, 8]


def test_ids_of_edges_and_nodes_of_lif_may_be_equal_and_of_any_characters() -> None:
    named = lif("1.0").replace('"edgeId": "ab"', '"edgeId": "a"')
    assert "a -> b" in imported(named, robots=0).graph.resource
    escaped = lif("1.0").replace('"a"', '"\\ud83d\\ude9a"')
    assert "\N{DELIVERY TRUCK}" in imported(escaped, robots=0).graph.resource


def test_a_robot_on_a_vertex_without_lanes_stays_one() -> None:
    parked = BUILDING.replace('900, 0, ""]', '900, 0, "", {spawn_robot_name: [1, parked]}]')
    assert [each.id for each in imported(parked).robots] == ["tiny", "parked"]


@pytest.mark.parametrize("settings", [{"tick": Fraction(0)}, {"speed": Fraction(-1)}, {"tick": 1.0}, {"requests": "a"}])
def test_wrong_settings_are_refused(settings: dict[str, object]) -> None:
    with pytest.raises(Refusal, match=rf"\$\.{next(iter(settings))}"):
        imported(OPENTCS, **settings)


def test_degrees_become_lengths_on_the_ground() -> None:
    """At 60 degrees north a degree is 55.80 km from west to east and 111.41 km from south to north."""
    vertices = "- [5, 60, {name: a}]\n      - [5.01, 60, {name: b}]\n      - [5.01, 60.01, {name: c}]"
    text = f"coordinate_system: wgs84\nlevels:\n  L1:\n    lanes: [[0, 1], [1, 2]]\n    vertices:\n      {vertices}\n"
    places = {each.id: (each.x, each.y) for each in imported(text, robots=0).graph.resources}
    assert places["a"] == (0, 0)
    assert places["b"] == pytest.approx((558_000, 0), abs=100)
    assert places["c"] == pytest.approx((558_000, 1_114_120), abs=100)


def test_a_lift_of_lif_joins_nodes_at_one_place_of_two_maps() -> None:
    document = json.loads(lif("0.11.0"))
    lower, upper = document["layouts"][0]["nodes"][:2]
    lower["mapId"], upper["mapId"] = "ground", "first"
    upper["nodePosition"] = lower["nodePosition"]
    with_lift = import_layout(json.dumps(document, indent=1).encode(), settings=Settings(robots=0))
    assert with_lift.instance.graph.resource["ab"].duration == 1
    assert any("between maps" in each.feature for each in with_lift.notes)


def test_nodes_of_lif_at_one_place_hold_one_robot_and_an_edge_between_them_is_a_turn() -> None:
    """As the rotation station of LIF.md, section 10.9, and stations of several nodes."""
    document = json.loads(lif("1.0.0"))
    layout = document["layouts"][0]
    layout["nodes"].append({**layout["nodes"][1], "nodeId": "turned"})
    layout["edges"].append({**layout["edges"][0], "edgeId": "turn", "startNodeId": "b", "endNodeId": "turned"})
    layout["edges"].append({**layout["edges"][0], "edgeId": "away", "startNodeId": "turned", "endNodeId": "a"})
    with_turn = import_layout(json.dumps(document, indent=1).encode(), settings=Settings(robots=0))
    assert with_turn.instance.graph.resource["turn"].duration == 1
    assert {"b", "turned", "turn"} in groups(with_turn.instance).values()
    assert {"ab", "away"} in groups(with_turn.instance).values(), "there and back, the same piece of the floor"
    assert any("turns on the spot" in each.feature for each in with_turn.notes)


def test_mutexes_and_conflicts_become_groups() -> None:
    for text in (BUILDING, NAV_GRAPH):
        assert groups(imported(text, robots=0))["mutex door way"] >= {"a -> b", "b -> c"}
    conflicts = [members for members in groups(imported(ANNOTATED)).values() if len(members) == 2]
    assert {"a -> b", "b -> c"} in conflicts
    assert {"b -> c", "a"} in conflicts


UNKNOWN = {
    "nav2": (
        nav2()
        .replace(
            '"metadata": {}', '"overridable": true,\n"lit": true, "metadata": {"speed_limit": 50,\n"gate": {"open": 1}}'
        )
        .replace('"id": "a"', '"id": "a",\n"metadata": {"speed_limit": 50, "class": null}'),
        {"the field speed_limit": [8], "costs of edges": [50], "the field lit": [51], "the field gate": [52]},
    ),
    "roadmap": (
        NODE_LINK.replace('"id": "b"', '\n"floor": 2, "id": "b"').replace('"length": 4', '"length": 4,\n"slope": 3'),
        {"the field floor": [2], "the field slope": [3]},
    ),
    "graphml": (
        GRAPHML.replace("<graph e", '<key id="d3" attr.name="slope"/>\n<graph e').replace(
            'target="b"/>', 'target="b">\n<data key="d3">2</data></edge>'
        ),
        {"the field slope": [10]},
    ),
    "building": (
        BUILDING.replace("spawn_robot_name:", "dock_name: [1, ''], lit: [4, true],\n spawn_robot_name:").replace(
            "mutex: [1", "\n orientation: [1, forward], slope: [3, 2.0], flat: [4, false], mutex: [1", 1
        ),
        {"the field lit": [12], "orientations of robots on lanes": [9], "the field slope": [9], "doors": [18]},
    ),
    "old opentcs": (
        OLD_OPENTCS.replace('locked="true"/>', '><property name="wet" value="yes"/></path>').replace(
            '<vehicle name="v1"', '<vehicle name="v1" length="900"'
        ),
        {"properties of points and paths": [10], "sizes of vehicles; --footprint sets one for all": [11]},
    ),
    "opentcs": (
        OPENTCS.replace(' locked="true"', ' lockd="true"').replace("</model>", '<blok name="x"/>\n</model>'),
        {"the field lockd": [10], "the element <blok>": [14]},
    ),
    "lif": (
        lif("1.0").replace('"layoutId"', '"floor": 2, "layoutId"').replace("EdgeProperties", "EdgeProps"),
        {"the field floor": [7], "the field vehicleTypeEdgeProps": [46, 56, 66]},
    ),
    "lif for two types": (
        lif("1.0").replace('"maxSpeed": 1', '"maxSpeed": 1, "vehicleTypeId": "v"'),
        {"edges that are not for all types of vehicles; here they are": [46, 56, 66]},
    ),
    "annotated": (
        ANNOTATED.replace("start: a", "potentialGoals: [b], start: a") + "conflict: [1]\n",
        {"the field potentialGoals": [17], "the field conflict": [18]},
    ),
    "links and edges": (
        NODE_LINK.replace('"nodes"', '\n"edges": [{"source": "a", "target": "c"}], "nodes"'),
        {"the field edges": [2]},
    ),
}


@pytest.mark.parametrize("name", UNKNOWN)
def test_fields_that_are_not_known_are_listed_with_their_lines(name: str, carproof: Run, elsewhere: Path) -> None:
    text, features = UNKNOWN[name]
    (elsewhere / "plant").write_text(text)
    listed = json.loads(carproof("convert plant -o plant.json --robots 0 --json").stdout)["not_expressed"]
    found = {each["feature"]: each["lines"] for each in listed}
    assert found | features == found
    assert not {each for each in found if each.startswith("the field")} - features.keys()


PLANT = """<model version="6.0.0" name="cross">
{points}
{paths}
<block name="block" type="SINGLE_VEHICLE_ONLY">{members}</block>
</model>
"""


def cross(members: str) -> Instance:
    """Paths ab, bc, cd in a row and xy beside it, with members in a block."""
    points = "".join(f'<point name="{each}" positionX="{n}000" positionY="0"/>' for n, each in enumerate("abcdxy"))
    paths = "".join(
        f'<path name="{each}" sourcePoint="{each[0]}" destinationPoint="{each[1]}" length="2" maxVelocity="1"'
        ' maxReverseVelocity="0"/>'
        for each in ("ab", "bc", "cd", "xy")
    )
    named = "".join(f'<member name="{each}"/>' for each in members.split())
    return imported(PLANT.format(points=points, paths=paths, members=named), robots=0)


def blocks() -> list[tuple[str, str, bool, str]]:
    """The rows of the table of openTCS's semantics, with the sections of its user's guide that they follow."""
    page = Path(__file__).parents[3] / "docs" / "reference" / "opentcs-blocks.md"
    rows = [re.split(r" *\| *", line)[1:-1] for line in page.read_text().splitlines() if line.startswith("| ")][1:]
    return [(members, places, allowed == "yes", source) for members, places, allowed, _, source in rows]


@pytest.mark.parametrize(("members", "places", "granted", "source"), blocks())
def test_blocks_of_opentcs_admit_what_its_scheduler_grants(
    members: str, places: str, granted: bool, source: str
) -> None:
    instance = cross(members.replace(",", " "))
    for order in permutations(places.split(", ")):
        robots = tuple(Robot(f"r{number}", place, place) for number, place in enumerate(order))
        standing = Instance(instance.graph, robots, "park", instance.following)
        plans = [Plan(robot.id, (Visit(robot.start, 0, None),)) for robot in robots]
        verdict = judge(standing, Solution.of(standing, plans))
        assert {each.rule for each in verdict.violations} == (set() if granted else {"joint/group"}), source


BROKEN = {
    "wrong version": (OPENTCS.replace('"7.0.0"', '"5.0.0"'), 2, "the version must be"),
    "external entity": ('<!DOCTYPE m [<!ENTITY e SYSTEM "file:///etc/passwd">]>\n' + OPENTCS[39:], 1, "document type"),
    "bomb": ('<!DOCTYPE m [<!ENTITY e "ha"><!ENTITY f "&e;&e;">]>\n<model version="7">&f;</model>', 1, "document type"),
    "unknown encoding": (OPENTCS.replace('"UTF-8"', '"UTF-88"'), 1, "its encoding must be UTF-8"),
    "no end": (OPENTCS[:-10], 13, "it must be XML"),
    "dangling path": (OPENTCS.replace('sourcePoint="a"', 'sourcePoint="z"'), 8, "'z' must be one of the layout"),
    "dangling member": (OPENTCS.replace('<member name="bc"/>', '<member name="zz"/>'), 12, "'zz' must be a point or"),
    "repeated member": (OPENTCS.replace('<member name="bc"/>', '<member name="ab"/>'), 12, "must be named once"),
    "position that is no number": (OPENTCS.replace('positionX="3000"', 'positionX="NaN"', 1), 4, "must be a number"),
    "aliases without end": ("levels: &a [*a]", 1, "must name an anchor that is complete"),
    "billion laughs": (
        "a: &a [x]\n"
        + "".join(f"{b}: &{b} [{','.join(['*' + a] * 99)}]\n" for a, b in zip("abcde", "bcdef", strict=True)),
        4,
        "at most 2000000 values",
    ),
    "tabs": ("levels:\n\tL1: {}", 2, "it must be YAML"),
    "vertex that is none": (NAV_GRAPH.replace("[0, 1, {m", "[0, 9, {m"), 6, "must be one of the 3 vertices"),
    "negative limit": (NAV_GRAPH.replace("0.5}", "-0.5}"), 7, "must be above 0"),
    "position that is a text": (lif("1.0").replace('"x": 3.0', '"x": "3.0"', 1), 23, "a number, not the text '3.0'"),
    "lif node of null": (lif("1.0").replace('"nodeId": "a"', '"nodeId": null'), 11, "a text in quotes, not null"),
    "nav2 node of null": (nav2().replace('"id": "a"', '"id": null'), 7, "or a whole number, not null"),
    "nav2 node of true": (nav2().replace('"id": "a"', '"id": true'), 7, "or a whole number, not true"),
    "nav2 node that is a fraction": (nav2().replace('"id": "a"', '"id": 1.0'), 7, "or a whole number, not 1.0"),
    "node of null": (NODE_LINK.replace('"id": "b"', '"id": null'), 1, "or a whole number, not null"),
    "node that is a fraction": (NODE_LINK.replace('"id": "b"', '"id": 1e0'), 1, "or a whole number, not 1e0"),
    "position in a roadmap that is a text": (NODE_LINK.replace('"x": 3', '"x": "3"', 1), 1, "not the text '3'"),
    "agent of null": (ANNOTATED.replace("name: agent0", "name: ~"), 17, "a text or a number, not null"),
    "answer that is a text": (NODE_LINK.replace("true", '"true"'), 1, "true or false, not the text 'true'"),
    "field twice": (NAV_GRAPH.replace("building_name: row", "levels: {}"), 4, "must be given once"),
    "degrees on Mars": (
        BUILDING.replace("reference_image", "iau2000"),
        2,
        "must be reference_image, cartesian_meters or",
    ),
    "degrees beyond the pole": (
        BUILDING.replace("reference_image", "wgs84").replace("[0, 0, 0, a", "[0, 90, 0, a"),
        11,
        "must be between -85 and 85",
    ),
    "lif 3": (lif("3.0"), 3, "the version must be 1, 0.11 as in"),
    "lif node": (lif("1.0").replace('"endNodeId": "b"', '"endNodeId": "q"', 1), 42, "'q' must be one of the layout"),
    "point of an unknown kind": (OPENTCS.replace("HALT_POSITION", "HALT"), 4, "HALT_POSITION, PARK_POSITION, REPORT"),
    "closed path of a name in use": (OPENTCS.replace('"ca"', '"bc"'), 10, "'bc' must be given once"),
    "vehicle at two places": (
        OPENTCS.replace("</vehicle>", '\n<property name="loopback:initialPosition" value="b"/></vehicle>'),
        12,
        "the position of a vehicle must be given once",
    ),
    "lif edge twice": (lif("1.0").replace('"edgeId": "bc"', '"edgeId": "ab"'), 53, "'ab' must be given once"),
    "value twice": (
        GRAPHML.replace('<data key="d1">0</data></node>', '<data key="d0">0</data></node>', 1),
        5,
        "given once",
    ),
    "unfinished JSON": (nav2()[:-2], 86, "it must be JSON"),
    "conflict with itself": (ANNOTATED.replace("    - [1]\n", "    - [0]\n", 1), 12, "must be another of the 4 edges"),
    "too few conflicts": (ANNOTATED.replace("    - []\n", ""), 12, "conflicts of each of 4 edges, not 3"),
    "points at one place": (
        NODE_LINK.replace('"x": 3, "y": 0', '"x": 0, "y": 0'),
        1,
        "length of a lane must be above 0",
    ),
    "nothing": ("", 1, "must hold one document"),
    "an instance": ('{"format": "carproof-instance/1"}', 1, "it looks like none of"),
    "deep": ('{"nodes":' + "[" * 5000, 1, "it must"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_layout_is_refused_with_its_line_and_nothing_is_written(
    name: str, carproof: Run, elsewhere: Path
) -> None:
    text, line, message = BROKEN[name]
    (elsewhere / "plant").write_text(text)
    outcome = carproof("convert plant -o plant.json")
    assert outcome.code == 2, outcome
    assert outcome.stderr.startswith(f"Error: plant:{line}: "), outcome.stderr
    assert message in outcome.stderr
    assert outcome.stderr.count("\n") == 1
    assert not (elsewhere / "plant.json").exists()


def test_whole_numbers_and_texts_are_names_and_all_attributes_of_graphml_are_texts() -> None:
    for text in (nav2(), NODE_LINK):
        graph = imported(text.replace('"a"', "-7").replace('"b"', "0").replace('"c"', '"true"'), robots=0).graph
        assert {"-7", "0", "true"} <= graph.resource.keys()
    graph = imported(GRAPHML.replace('"a"', '"true"').replace('"b"', '"1.5"'), robots=0).graph
    assert {"true", "1.5"} <= graph.resource.keys()


@pytest.mark.parametrize("format", READERS)
def test_a_layout_of_another_format_than_named_is_refused_or_has_nothing_to_read(format: str) -> None:
    for text in LAYOUTS.values():
        with suppress(Refusal):
            import_layout(text.encode(), "plant", format, Settings(robots=0))
