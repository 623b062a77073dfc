"""`check --footprint`: vehicles of a size keep apart, recomputed from positions and plans alone."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.roadmaps import Place, graphml
from tests.oracle.running import Run

from carp_spec import Carp, Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit
from carproof import Footprint, Settings, check, import_layout, write_instance, write_solution
from carproof.engines import engine_named

Pairs = set[frozenset[object]]


def plant(lanes: list[tuple[Place, Place]], both: bool = False, **settings: object) -> Instance:
    """A roadmap with ends in mm; its points are named by their places."""
    wanted = Settings(**({"robots": 0} | settings))  # type: ignore[arg-type]
    return import_layout(graphml(lanes, both), settings=wanted).instance


def all_at_once(instance: Instance, size: Footprint) -> Pairs:
    """The pairs of resources in which two vehicles of the size overlap: one stands in each, and groups are unknown."""
    robots = tuple(Robot(index, each.id, each.id) for index, each in enumerate(instance.graph.resources))
    full = replace(instance, graph=replace(instance.graph, groups=()), robots=robots)
    plans = [Plan(robot.id, (Visit(robot.start, 0, None),)) for robot in robots]
    found = [each for each in check(full, Solution.of(full, plans), None, size).violations if each.rule.startswith("f")]
    assert all((each.start, each.end) == (0, None) for each in found)
    return {frozenset(robots[int(robot)].start for robot in each.robots) for each in found}


coordinates = st.integers(0, 12)
places = st.tuples(coordinates, coordinates)
sizes = st.one_of(
    st.builds(Footprint, st.integers(1, 9), st.integers(1, 9)),
    st.integers(1, 9).map(lambda diameter: Footprint(diameter, diameter, round=True)),
)


@st.composite
def roadmaps(draw: st.DrawFn) -> list[tuple[Place, Place]]:
    """Lanes of at least 2 mm: of 1 mm, a lane has the position of its end."""
    ends = st.tuples(places, places).filter(lambda each: max(abs(a - b) for a, b in zip(*each, strict=True)) > 1)
    return draw(st.lists(ends, min_size=1, max_size=5, unique_by=frozenset))


@given(roadmaps(), sizes, st.booleans(), st.booleans())
def test_what_the_importer_keeps_apart_is_what_the_check_wants_apart(
    lanes: list[tuple[Place, Place]], size: Footprint, both: bool, turning: bool
) -> None:
    made = plant(lanes, both, footprint=size, turning=Fraction(2) if turning else None)
    groups = {frozenset((one, two)) for each in made.graph.groups for one in each.resources for two in each.resources}
    assert all_at_once(made, size) == {each for each in groups if len(each) > 1}


def crossing(gap: int = 0) -> Instance:
    """Two lanes of 4 m that cross at their middles, or pass each other at the gap, and a robot for each."""
    lanes = (
        [((0, 0), (4000, 0)), ((2000, -2000), (2000, 2000))]
        if not gap
        else [((0, 0), (4000, 0)), ((0, gap), (4000, gap))]
    )
    rows = "\n".join(f'r{number},"{a},{b}","{c},{d}"' for number, ((a, b), (c, d)) in enumerate(lanes))
    return plant(lanes, requests=f"robot,start,goal\n{rows}\n".encode(), robots=None)


def test_who_where_and_when(carproof: Run, elsewhere: Path) -> None:
    instance = crossing()
    (elsewhere / "plant.json").write_bytes(write_instance(instance))
    (elsewhere / "plans.json").write_bytes(write_solution(engine_named("reference").plan(instance, Carp())))
    assert carproof("check plant.json plans.json").code == 0
    answer = carproof("check plant.json plans.json --footprint 900x600mm --json")
    assert answer.code == 1
    (found,) = json.loads(answer.stdout)["violations"]
    assert (found["rule"], found["robots"], found["from"], found["to"]) == ("footprint/apart", ["r0", "r1"], 1, 5)
    assert found["resource"] == "0,0 -> 4000,0"
    assert "2000,-2000 -> 2000,2000" in found["message"]


def test_floors_with_too_many_pairs_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    instance, size = crossing(), Footprint(900, 600)
    solution = engine_named("reference").plan(instance, Carp())
    pairs = 5  # each lane with both its ends, and the two lanes
    monkeypatch.setattr("carp_verify.footprint.rules.MOST_PAIRS", pairs)
    assert check(instance, solution, footprint=size).violations
    monkeypatch.setattr("carp_verify.footprint.rules.MOST_PAIRS", pairs - 1)
    with pytest.raises(Refusal, match="at most"):
        check(instance, solution, footprint=size)


def driven(robot: Robot, late: int = 0) -> Plan:
    """At once over its lane."""
    lane = f"{robot.start} -> {robot.goal}"
    return Plan(
        robot.id,
        (Visit(robot.start, late, late + 1), Visit(lane, late + 1, late + 5), Visit(robot.goal, late + 5, None)),
    )


@pytest.mark.parametrize(
    ("size", "gap", "are_apart"),
    [
        (Footprint(900, 600), 600, True),  # they touch; at their ends they do not turn
        (Footprint(900, 600), 599, False),
        (Footprint(900, 900, round=True), 900, True),
        (Footprint(900, 900, round=True), 899, False),
        (Footprint(900, 900, round=True), 0, False),  # the lanes cross, far from their ends
    ],
)
def test_vehicles_may_touch(size: Footprint, gap: int, are_apart: bool) -> None:
    instance = crossing(gap)
    solution = Solution.of(instance, [driven(robot) for robot in instance.robots])
    assert check(instance, solution, footprint=size).valid == are_apart


@pytest.mark.parametrize(("late", "ticks"), [(3, [(4, 5)]), (4, [])])
def test_a_vehicle_that_has_left_is_out_of_the_way(late: int, ticks: list[tuple[int, int]]) -> None:
    instance = crossing()
    first, second = instance.robots
    released = replace(instance, robots=(first, replace(second, release=late)))
    solution = Solution.of(released, [driven(first), driven(second, late)])
    found = check(released, solution, footprint=Footprint(900, 600)).violations
    assert [(each.start, each.end) for each in found] == ticks


@pytest.mark.parametrize(
    ("resources", "edges", "rule", "path"),
    [
        ([Resource("a", 1, 1, 0, 0), Resource("b")], [], "footprint/positions", "$.graph.resources[1]"),
        ([Resource("a", 1, 1, 0, 0), Resource("b", 1, 1, 9, 0)], [("a", "b")], "footprint/lanes", "$.graph.edges[0]"),
    ],
)
def test_a_floor_that_is_not_known_is_refused(
    resources: list[Resource], edges: list[tuple[str, str]], rule: str, path: str
) -> None:
    instance = Instance(ResourceGraph(tuple(resources), tuple(edges)), ())
    with pytest.raises(Refusal) as refused:
        check(instance, Solution((), ()), footprint=Footprint(900, 600))
    assert (refused.value.rule, refused.value.path) == (rule, path)
    assert check(instance, Solution((), ())).valid


def test_a_refusal_names_the_file_of_the_instance(carproof: Run, elsewhere: Path) -> None:
    instance = Instance(ResourceGraph((Resource("a", 1, 1, 0, 0), Resource("b")), ()), ())
    (elsewhere / "plant.json").write_bytes(write_instance(instance))
    (elsewhere / "plans.json").write_bytes(write_solution(Solution((), ())))
    refused = carproof("check plant.json plans.json --footprint 900x600mm -o verdict.json")
    assert refused.code == 2
    assert refused.stderr.startswith("Error: plant.json: $.graph.resources[1]")
    assert not (elsewhere / "verdict.json").exists()


@pytest.mark.parametrize("size", [Footprint(0, 1), Footprint(True, 1), Footprint(2, 1, round=True)])
def test_a_size_that_is_none_is_refused(size: Footprint) -> None:
    with pytest.raises(Refusal, match="footprint/vehicle"):
        check(crossing(), Solution((), (), ("r0", "r1")), footprint=size)
