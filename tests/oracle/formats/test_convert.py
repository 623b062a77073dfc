"""MovingAI maps and scenarios: what they mean, and where a broken one is wrong."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Run

from carproof import read_instance
from carproof.formats.movingai import read_map, read_scenario

EXAMPLES = Path(__file__).parents[3] / "oracle/carproof/examples"
MAP = "type octile\nheight 2\nwidth 3\nmap\n.G@\nS.T\n"
SCENARIO = "version 1\n0\tm.map\t3\t2\t0\t0\t1\t1\t1.41\n0\tm.map\t3\t2\t1\t1\t0\t0\t1.41\n"


@pytest.fixture(autouse=True)
def _files(elsewhere: Path) -> None:
    (elsewhere / "m.map").write_text(MAP)
    (elsewhere / "m.scen").write_text(SCENARIO)


def test_passable_cells_become_resources_joined_to_those_beside_them(carproof: Run) -> None:
    outcome = carproof("convert m.map m.scen --agents 1")
    assert outcome.code == 0
    instance = read_instance(outcome.stdout.encode())
    assert [resource.id for resource in instance.graph.resources] == ["0,0", "1,0", "0,1", "1,1"]
    assert set(instance.graph.edges) == {("0,0", "1,0"), ("0,1", "1,1"), ("0,0", "0,1"), ("1,0", "1,1")}
    assert [(robot.id, robot.start, robot.goal) for robot in instance.robots] == [("r1", "0,0", "1,1")]
    assert instance.after_goal == "park"


BROKEN_MAPS = (
    ("", 1),
    ("type octile\nheight x\nwidth 3\nmap\n", 2),
    ("type octile\nheight 2\nwith 3\nmap\n", 3),
    ("type octile\nheight 2\nwidth 3\n", 4),
    (MAP + "...\n", 7),
    (MAP.replace("S.T", "S."), 6),
    (MAP.replace("S.T", "S.x"), 6),
    (MAP.replace("height 2", "height " + "9" * 5000), 2),
)
BROKEN_SCENARIOS = (
    ("", 1),
    ("version 2\n", 1),
    (SCENARIO + "0\tm.map\t3\n", 4),
    (SCENARIO.replace("\t1\t1\t1.41\n0", "\t1\t-1\t1.41\n0"), 2),
    (SCENARIO.replace("\t3\t2\t0", "\t4\t2\t0"), 2),
    (SCENARIO.replace("\t1\t1\t1.41\n0", "\t2\t0\t1.41\n0"), 2),
    (SCENARIO.replace("\t1\t1\t0", "\t1\t7\t0"), 3),
)


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [*(("m_$.map", *each) for each in BROKEN_MAPS), *(("m.scen", *each) for each in BROKEN_SCENARIOS)],
)
def test_a_broken_file_is_refused_with_name_and_line(
    carproof: Run, elsewhere: Path, name: str, text: str, line: int
) -> None:
    (elsewhere / name).write_text(text)
    outcome = carproof(f"convert {name if name.endswith('map') else 'm.map'} m.scen")
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith(f"Error: {name}:{line}: ")
    assert outcome.stderr.endswith(f" [movingai/{'map' if name.endswith('map') else 'scenario'}]\n")


def test_lines_of_a_map_may_end_as_on_windows() -> None:
    assert read_map(MAP.replace("\n", "\r\n").encode()) == read_map(MAP.encode())


def test_agents_beyond_the_last_asked_for_are_not_read() -> None:
    grid = read_map(MAP.encode())
    assert len(read_scenario((SCENARIO + "nonsense\n").encode(), grid, 2)) == 2


def test_after_goal_can_be_vanish_and_all_agents_are_the_default(carproof: Run) -> None:
    outcome = carproof("convert", EXAMPLES / "depot.map", EXAMPLES / "depot.scen", "--after-goal", "vanish")
    document = json.loads(outcome.stdout)
    assert document["after_goal"] == "vanish"
    assert len(document["robots"]) == 30
