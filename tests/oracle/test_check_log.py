"""`carproof check-log`: logs of other systems, who conflicts with whom, which stops were served when, and bad files."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Run, corridor, save

pytestmark = pytest.mark.usefixtures("elsewhere")

MAP = "type octile\nheight 3\nwidth 4\nmap\n.S..\n.@E.\n....\n"
LEAGUE = {
    "start": [[0, 0, "E"], [2, 3, "E"]],
    "actualPaths": ["F,F,W,W", "C,F,C,F"],
    "events": [[[7, 0, "assigned"], [7, 2, "finished"]], []],
    "tasks": [[7, 0, 2]],
}
LEAGUE_2024 = {**LEAGUE, "tasks": [[7, 0, [0, 1, 0, 2]]], "events": [[1, 0, 7, 1], [2, 0, 7, 2]]}
SWAPPING = {"start": [[0, 0, "E"], [0, 1, "W"]], "actualPaths": ["F,R", "F,W"]}
CROWDED = {"start": [[0, 0, "E"], [0, 1, "W"]], "actualPaths": ["F,R", "W,W"]}
INTO_A_RACK = {"start": [[0, 1, "S"]], "actualPaths": ["F"]}
RHCR = "2\n0,0,0;1,0,1;2,0,2;\n11,0,0;11,0,1;7,0,2;\n"


def on_map(carproof: Run, log: str, format: str, *options: str) -> tuple[int, str, str]:
    Path("m.map").write_text(MAP)
    Path("log").write_text(log)
    found = carproof("check-log", "--map", "m.map", "log", "--from", format, *options)
    return found.code, found.stdout, found.stderr


@pytest.mark.parametrize(
    ("log", "served"),
    [
        (LEAGUE, [[0, 0, "2,0", 2, None], [1, 0, "2,1", 4, None]]),
        (LEAGUE_2024, [[0, 0, "1,0", 1, 2], [0, 1, "2,0", 2, None], [1, 0, "2,1", 4, None]]),
    ],
)
def test_outputs_of_the_league_are_judged_with_the_stops_served(
    carproof: Run, log: object, served: list[object]
) -> None:
    code, stdout, _ = on_map(carproof, json.dumps(log), "league", "--json")
    found = json.loads(stdout)
    assert (code, found["valid"], found["now"], found["served"]) == (0, True, 4, served)


@pytest.mark.parametrize(
    ("log", "said"),
    [
        (SWAPPING, "they exchange 0,0 and 1,0 at tick 1"),
        (CROWDED, "resource 1,0 in [1,3): robots 0, 1 (capacity 1)"),
        (INTO_A_RACK, "the graph has no such resource"),
    ],
)
def test_conflicts_in_a_log_are_told_by_robot_place_and_tick(carproof: Run, log: object, said: str) -> None:
    code, stdout, _ = on_map(carproof, json.dumps(log), "league")
    assert code == 1
    assert said in stdout


def test_paths_of_rhcr_are_judged(carproof: Run) -> None:
    code, stdout, _ = on_map(carproof, RHCR, "rhcr")
    assert (code, stdout) == (0, "no rule is broken by tick 2: 2 of 2 stops served, 2 of 2 robots done\n")


def test_tables_are_judged_against_an_instance(carproof: Run) -> None:
    save(town=corridor([{"id": 1, "start": "a", "goal": "c"}, {"id": "x", "start": "d", "goal": "b"}]))
    Path("log.csv").write_text("resource,robot,tick\na,1,0\nd,x,0\nb,1,1\nd,x,1\nc,x,1\nc,1,2\nb,x,2\n,1,3\n")
    found = carproof("check-log", "town.json", "log.csv", "--from", "csv", "--served")
    assert found.code == 1
    assert "they exchange b and c at tick 2" in found.stdout
    assert "1         0  c            2   3" in found.stdout


@pytest.mark.parametrize(
    ("log", "format"),
    [
        ("{}", "league"),
        (json.dumps({**LEAGUE, "start": [[0, 0, "E"]]}), "league"),
        (json.dumps({**LEAGUE, "start": [[0, 0, "E"], [0, 1, "X"]]}), "league"),
        (json.dumps({**LEAGUE, "actualPaths": ["F,F", "F,J"]}), "league"),
        (json.dumps({**LEAGUE, "events": [7]}), "league"),
        (json.dumps({**LEAGUE, "events": [[2, -1, 0, 1]], "tasks": [[0, 0, [0, 1]]]}), "league"),
        (json.dumps({**LEAGUE, "events": [[2, 0, 0, -1]], "tasks": [[0, 0, [0, 1]]]}), "league"),
        (json.dumps({**LEAGUE, "tasks": [[0, 0, 1], [0, 1, 1]]}), "league"),
        (json.dumps({**LEAGUE, "tasks": [[0, 0, 0.7]]}), "league"),
        (json.dumps({**LEAGUE, "teamSize": 3}), "league"),
        ("", "rhcr"),
        ("1\n0,0,0;1,0,2;\n", "rhcr"),
        ("robot,tick,resource\n", "csv"),
    ],
)
def test_bad_logs_are_refused_by_name(carproof: Run, log: str, format: str) -> None:
    code, _, stderr = on_map(carproof, log, format)
    assert code == 2
    assert stderr.startswith("Error: --from: " if format == "csv" else "Error: log")
    assert stderr.rstrip().endswith("[adapter/log]")
    assert len(stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ("", 1),
        ("robot,tick\n1,2\n", 1),
        ("robot,tick,resource\n1,x,a\n", 2),
        ("robot,tick,resource\n1,2,a\n1,1,b\n", 3),
        ("robot,tick,resource\n1,0,6,1\n", 2),
        ("robot,tick,resource\n1,0\n", 2),
        ("robot,tick,resource\n\n\n1,x,a\n", 4),
        ("robot,tick,resource,tick\n1,0,a,0\n", 1),
        ("robot,tick,resource\r1,0,a\r1,x,a\r", 3),
        ("robot,tick,resource\n1,0," + "a" * 200_000 + "\n", 2),
    ],
)
def test_bad_tables_are_refused_by_name_and_line(carproof: Run, table: str, line: int) -> None:
    save(town=corridor([{"id": 1, "start": "a", "goal": "c"}]))
    Path("log.csv").write_text(table)
    found = carproof("check-log", "town.json", "log.csv", "--from", "csv")
    assert found.code == 2
    assert found.stderr.startswith(f"Error: log.csv:{line}: ")
    assert found.stderr.rstrip().endswith("[adapter/log]")


def test_a_trace_is_a_log(carproof: Run) -> None:
    save(town=corridor([{"id": 1, "start": "a", "goal": "c"}]))
    save(log={"format": "carproof-trace/1", "now": 3, "plans": [{"robot": 1, "visits": [["a", 0, 1], ["b", 1, None]]}]})
    assert carproof("check-log", "town.json", "log.json").stdout == (
        "no rule is broken by tick 3: 0 of 1 stops served, 0 of 1 robots done\n"
    )
    save(log={"format": "carproof-trace/1", "now": 0, "plans": [{"robot": 1, "visits": [["a", 0, 1]]}]})
    refused = carproof("check-log", "town.json", "log.json")
    assert refused.stderr.rstrip().endswith("[log/now]")
    assert "log.json: $.plans[0].visits[0]" in refused.stderr
