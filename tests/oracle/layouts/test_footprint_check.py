"""`check --footprint`: vehicles of a size keep apart, recomputed from positions and plans alone."""

import json
import tracemalloc
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.layouts.roadmaps import Place, graphml
from tests.oracle.running import Run

from carp_spec import Carp, Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit
from carp_verify.footprint.apart import footprint_violations
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
    kept_apart(plant(lanes, both, footprint=size, turning=Fraction(2) if turning else None), size)


def kept_apart(made: Instance, size: Footprint) -> Pairs:
    """The pairs that the importer keeps apart; they are those that the check wants apart."""
    kept: Pairs = {frozenset(pair) for each in made.graph.groups for pair in combinations(each.resources, 2)}
    assert all_at_once(made, size) == kept, made
    return kept


def floor(places: dict[str, Place], *ways: str) -> Instance:
    """Resources at these places, and edges along the ways, such as `a ab b`."""
    resources = tuple(Resource(name, 9, 1, x, y) for name, (x, y) in places.items())
    edges = tuple(edge for way in ways for edge in pairwise(way.split()))
    return Instance(ResourceGraph(resources, edges, directed=True), ())


def near(size: Footprint, places: dict[str, Place], *ways: str) -> set[str]:
    """The pairs of resources in which two vehicles overlap, like `a ab`."""
    return {" ".join(sorted(map(str, each))) for each in all_at_once(floor(places, *ways), size)}


def near_to(name: str, size: Footprint, places: dict[str, Place], *ways: str) -> set[str]:
    """The resources in which a vehicle overlaps with one in the resource of that name."""
    pairs = [each.split() for each in near(size, places, *ways)]
    return {one for pair in pairs if name in pair for one in pair if one != name}


SMALL = Footprint(400, 300)
"""A vehicle with a diagonal of 500 mm; where no lane is, it turns in a disc."""


@pytest.mark.parametrize(("x", "y"), [(0, 0), (9000, 9000), (-9000, -9000), (9000, -9000)])
def test_places_without_lanes_are_discs_wherever_they_are(x: int, y: int) -> None:
    for way in ((500, 0), (-500, 0), (0, 500), (0, -500), (300, -400)):
        assert near(SMALL, {"a": (x, y), "b": (x + way[0], y + way[1])}) == set()
        nearer = [each - (each > 0) + (each < 0) for each in way]
        assert near(SMALL, {"a": (x, y), "b": (x + nearer[0], y + nearer[1])}) == {"a b"}


ROW = {name: (x, 7) for name, x in zip("pqozamn", range(-1500, 2000, 500), strict=True)}
"""Points 1 m apart with lanes between them; each but the ends is at the middle of its neighbours."""


@pytest.mark.parametrize("ways", [("p q o z a m n",), ("n m a z o q p",), ("p q o", "o z", "a z", "n m a")])
def test_lanes_are_known_from_the_ends_of_a_row_on(ways: tuple[str, ...]) -> None:
    along = {"p q", "o q", "o z", "a z", "a m", "m n", "q z", "m z"}
    assert near(SMALL, ROW, *ways) == along
    for point in "oa":  # it does not turn there, so that it reaches as far as on the lanes
        assert near_to("t", SMALL, ROW | {"t": (ROW[point][0], 7 + 400)}, *ways) == set()
        assert point in near_to("t", SMALL, ROW | {"t": (ROW[point][0], 7 + 399)}, *ways)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(("ways", "turns"), [(("w we e", "i ie e"), False), (("w we e", "i ie e", "e en n"), True)])
def test_a_point_is_a_disc_where_one_lane_of_several_leaves_the_line(
    side: int, ways: tuple[str, ...], turns: bool
) -> None:
    places = {"w": (-2000, 0), "we": (-1000, 0), "e": (0, 0), "ie": (1000, 0), "i": (2000, 0), "t": (0, -450 * side)}
    bend = {"en": (500, 1000 * side), "n": (1000, 2000 * side)} if turns else {}
    assert ("e" in near_to("t", SMALL, places | bend, *ways)) == turns


def test_resources_at_one_place_that_edges_join_are_one_point() -> None:
    places = dict.fromkeys(("b", "b1", "b2"), (2000, 0)) | {"a": (0, 0), "c": (2000, 2000)}
    found = near(SMALL, places | {"ab": (1000, 0), "bc": (2000, 1000)}, "a ab b1", "b b1", "b2 b1", "b2 bc c")
    assert found == {"b b1", "b b2", "b1 b2", "a ab", "bc c", "ab bc"} | {
        f"{lane} {point}" if lane < point else f"{point} {lane}" for lane in ("ab", "bc") for point in ("b", "b1", "b2")
    }


@pytest.mark.parametrize("end", [(3000, 0), (3001, 3), (-3001, -3), (0, 2999)])
def test_a_lane_is_at_the_middle_of_its_ends_rounded_down(end: Place) -> None:
    middle = (end[0] // 2, end[1] // 2)
    assert near(SMALL, {"a": (0, 0), "b": end, "ab": middle}, "a ab b") == {"a ab", "ab b"}
    for off in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        with pytest.raises(Refusal, match="footprint/lanes"):
            near(SMALL, {"a": (0, 0), "b": end, "ab": (middle[0] + off[0], middle[1] + off[1])}, "a ab b")


def test_no_more_meetings_are_looked_for_than_are_listed() -> None:
    hall = floor({"hall": (0, 0)})
    crowd = replace(hall, robots=tuple(Robot(number, "hall", "hall") for number in range(500)))
    plans = [Plan(robot.id, (Visit("hall", 0, None),)) for robot in crowd.robots]
    tracemalloc.start()
    found = footprint_violations(crowd, plans, SMALL, 100)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10_000_000
    assert [each.robots for each in found[:4]] == [(0, 1), (0, 2), (1, 2), (0, 3)]
    assert found == footprint_violations(crowd, plans[:40], SMALL)[:100]


@pytest.mark.parametrize("most", [1, 2, 3, 7, 30])
def test_the_meetings_listed_are_the_first_of_all(most: int) -> None:
    cells = floor({f"{x}{y}": (x, y) for x in range(4) for y in range(4)})
    crowd = replace(cells, robots=tuple(Robot(number, "00", "00") for number in range(6)))
    plans = []
    for robot in crowd.robots:  # all go the same way in twos, a tick apart, with two ticks at each step
        ticks = [int(robot.id) // 2 + 2 * step for step in range(8)]
        way = ("00", "10", "11", "01", "02", "12", "22", "21")
        plans.append(Plan(robot.id, tuple(Visit(at, tick, tick + 2) for at, tick in zip(way, ticks, strict=True))))
    every = footprint_violations(crowd, plans, Footprint(9, 9), cells=10)
    assert len(every) > 30
    assert footprint_violations(crowd, plans, Footprint(9, 9), most, 10) == every[:most]


def test_meetings_come_in_the_order_of_time_and_the_first_are_kept() -> None:
    """Who is there for no ticks meets nobody."""
    instance = floor({"a": (0, 0), "b": (1, 0), "c": (4000, 0), "d": (4001, 0), "e": (8000, 0), "f": (8001, 0)})
    stays = [("a", 1, 4), ("b", 0, 9), ("c", 5, None), ("d", 0, None), ("e", 0, 9), ("f", 0, 1)]
    stays += [("a", 6, 6), ("e", 7, 3)]
    robots = tuple(Robot(f"r{number}", place, place) for number, (place, _, _) in enumerate(stays))
    plans = [Plan(robot.id, (Visit(*stay),)) for robot, stay in zip(robots, stays, strict=True)]
    standing = replace(instance, robots=robots)
    for most, starts in ((None, [0, 1, 5]), (2, [0, 1])):
        found = check(standing, Solution.of(standing, plans), most, SMALL).violations
        apart = [each for each in found if each.rule == "footprint/apart"]
        assert [each.start for each in apart] == starts
        assert [each.end for each in apart] == [1, 4, None][: len(starts)]


def crossing() -> Instance:
    """Two lanes of 4 m that cross at their middles, and a robot for each."""
    lanes = [((0, 0), (4000, 0)), ((2000, -2000), (2000, 2000))]
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
        ([Resource("a", 1, 1, 0, 0), Resource("b", 1, 1, 9, 0)], [("b", "a")], "footprint/lanes", "$.graph.edges[0]"),
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


@pytest.mark.parametrize("size", [Footprint(0, 1), Footprint(True, 1), Footprint(2, 1, round=True)])
def test_a_size_that_is_none_is_refused(size: Footprint) -> None:
    with pytest.raises(Refusal, match="footprint/vehicle"):
        check(crossing(), Solution((), (), ("r0", "r1")), footprint=size)
