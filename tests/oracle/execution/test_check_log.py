"""`carproof check-log`: logs of other systems, who conflicts with whom, which stops were served when, and bad files."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import Outcome, Run, corridor, save

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


LEAGUE_LOG, RHCR_LOG, TABLE = "--map m.map log --from league", "--map m.map log --from rhcr", "town.json log --from csv"


def check_log(carproof: Run, log: str, arguments: str) -> Outcome:
    """The answer of the command beside the map and a town."""
    save(town=corridor([{"id": 1, "start": "a", "goal": "c"}, {"id": "x", "start": "d", "goal": "b"}]))
    Path("m.map").write_text(MAP)
    Path("log").write_text(log)
    return carproof(f"check-log {arguments}")


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
    outcome = check_log(carproof, json.dumps(log), f"{LEAGUE_LOG} --json")
    found = json.loads(outcome.stdout)
    assert (outcome.code, found["valid"], found["now"], found["served"]) == (0, True, 4, served)


@pytest.mark.parametrize(
    ("log", "said"),
    [
        (SWAPPING, "they exchange 0,0 and 1,0 at tick 1"),
        (CROWDED, "resource 1,0 in [1,3): robots 0, 1 (capacity 1)"),
        (INTO_A_RACK, "the graph has no such resource"),
    ],
)
def test_conflicts_in_a_log_are_told_by_robot_place_and_tick(carproof: Run, log: object, said: str) -> None:
    found = check_log(carproof, json.dumps(log), LEAGUE_LOG)
    assert (found.code, said in found.stdout) == (1, True)


def test_paths_of_rhcr_are_judged(carproof: Run) -> None:
    found = check_log(carproof, RHCR, RHCR_LOG)
    assert found.code == 0
    assert found.stdout == "no rule is broken by tick 2: 2 of 2 stops served, 2 of 2 robots done\n"


def test_tables_are_judged_against_an_instance(carproof: Run) -> None:
    table = "resource,robot,tick\na,1,0\nd,x,0\nb,1,1\nd,x,1\nc,x,1\nc,1,2\nb,x,2\n,1,3\n"
    found = check_log(carproof, table, f"{TABLE} --served")
    assert found.code == 1
    assert "they exchange b and c at tick 2" in found.stdout
    assert "1         0  c            2   3" in found.stdout


def test_a_resource_called_0_is_a_place_in_a_table(carproof: Run) -> None:
    town = corridor([{"id": 1, "start": "a", "goal": "c"}])
    save(town=json.loads(json.dumps(town).replace('"a"', "0")))
    Path("log").write_text("robot,tick,resource\n1,0,0\n1,1,b\n1,2,0\n")
    found = carproof("check-log town.json log --from csv")
    assert (found.code, found.stdout) == (0, "no rule is broken by tick 2: 0 of 1 stops served, 0 of 1 robots done\n")


@pytest.mark.parametrize(
    ("log", "arguments", "place"),
    [
        ("{}", LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "start": [[0, 0, "E"]]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "start": [[0, 0, "E"], [0, 1, "X"]]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "actualPaths": ["F,F", "F,J"]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "events": [7]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "events": [[2, -1, 0, 1]], "tasks": [[0, 0, [0, 1]]]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "events": [[2, 0, 0, -1]], "tasks": [[0, 0, [0, 1]]]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "tasks": [[0, 0, 1], [0, 1, 1]]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "tasks": [[0, 0, 0.7]]}), LEAGUE_LOG, "log"),
        (json.dumps({**LEAGUE, "teamSize": 3}), LEAGUE_LOG, "log"),
        ("", RHCR_LOG, "log"),
        ("1\n0,0,0;1,0,2;\n", RHCR_LOG, "log"),
        ("robot,tick,resource\n", "--map m.map log --from csv", "--from: "),
        ("", TABLE, "log:1: "),
        ("robot,tick\n1,2\n", TABLE, "log:1: "),
        ("robot,tick,resource\n1,x,a\n", TABLE, "log:2: "),
        ("robot,tick,resource\n1,2,a\n1,1,b\n", TABLE, "log:3: "),
        ("robot,tick,resource\n1,0,6,1\n", TABLE, "log:2: "),
        ("robot,tick,resource\n1,0\n", TABLE, "log:2: "),
        ("robot,tick,resource\n\n\n1,x,a\n", TABLE, "log:4: "),
        ("robot,tick,resource,tick\n1,0,a,0\n", TABLE, "log:1: "),
        ("robot,tick,resource\r1,0,a\r1,x,a\r", TABLE, "log:3: "),
        ("robot,tick,resource\n1,0," + "a" * 200_000 + "\n", TABLE, "log:2: "),
    ],
)
def test_bad_logs_are_refused_by_name_and_line(carproof: Run, log: str, arguments: str, place: str) -> None:
    found = check_log(carproof, log, arguments)
    assert found.code == 2
    assert found.stderr.startswith(f"Error: {place}")
    assert found.stderr.endswith("[adapter/log]\n")
    assert found.stderr.count("\n") == 1


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
