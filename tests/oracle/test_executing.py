"""The commands about executions: `check-trace`, `dependencies`, `execute`, `retime`, `untangle`."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from tests.oracle.running import Document, Run
from tests.profiles import draws

from carp_spec import check, judge, read_instance, read_solution
from carp_spec.execution_rules import is_acyclic, trace_violations
from carp_spec.traces import read_trace
from carproof.engines import engine_named
from carproof.executing import DRIVERS, execute, random_delays
from carproof.strategies import PlannedInstance, Sizes, planned_instances
from carproof.untangling import untangle

SIZES = Sizes(resources=5, robots=5)


def square(robots: list[tuple[str, str]]) -> Document:
    """Four cells in a ring, with robots that go one cell on."""
    return {
        "format": "carproof-instance/1",
        "graph": {
            "nodes": [{"id": cell} for cell in "abcde"],
            "edges": [{"source": a, "target": b} for a, b in ("ab", "bc", "cd", "da", "ae")],
        },
        "after_goal": "vanish",
        "robots": [{"id": f"r{number}", "start": start, "goal": goal} for number, (start, goal) in enumerate(robots)],
    }


def steps(robots: list[tuple[str, str]]) -> Document:
    """Each robot moves at tick 1."""
    plans = [
        {"robot": f"r{number}", "visits": [[start, 0, 1], [goal, 1, 2]]} for number, (start, goal) in enumerate(robots)
    ]
    return {
        "format": "carproof-solution/1",
        "plans": plans,
        "order": [plan["robot"] for plan in plans],
        "unplanned": [],
    }


TRAIN = [("b", "c"), ("a", "b")]
RING = [("a", "b"), ("b", "c"), ("c", "d"), ("d", "a")]


@pytest.fixture
def files(tmp_path: Path) -> dict[str, Path]:
    documents = {
        "train": square(TRAIN),
        "train-plans": steps(TRAIN),
        "ring": square(RING),
        "ring-plans": steps(RING),
        "trace": {
            "format": "carproof-trace/1",
            "now": 3,
            "plans": [
                {"robot": "r0", "visits": [["b", 0, 3], ["c", 3, None]]},
                {"robot": "r1", "visits": [["a", 0, None]]},
            ],
        },
        "delays": [["r0", 0, 4]],
    }
    found = {}
    for name, document in documents.items():
        found[name] = tmp_path / f"{name}.json"
        found[name].write_text(json.dumps(document))
    return found


def test_a_trace_is_checked_against_the_plans(carproof: Run, files: dict[str, Path]) -> None:
    outcome = carproof("check-trace", files["train"], files["train-plans"], files["trace"])
    assert (outcome.code, outcome.stderr) == (0, "")
    assert outcome.stdout == "no rule is broken: by tick 3, 1 of 2 robots are at their goals\n"
    wrong = json.loads(files["trace"].read_text())
    wrong["plans"][1]["visits"] = [["a", 0, 2], ["b", 2, None]]
    files["trace"].write_text(json.dumps(wrong))
    outcome = carproof("check-trace", files["train"], files["train-plans"], files["trace"])
    assert outcome.code == 1
    assert outcome.stdout.startswith("[execution/order] resource b in [2,for ever): robot r1 (by the plans robot r0")
    verdict = json.loads(carproof("check-trace", files["train"], files["train-plans"], files["trace"], "--json").stdout)
    assert [violation["rule"] for violation in verdict["violations"]] == ["execution/order"]


def test_dependencies_name_the_cycle_and_who_is_late(carproof: Run, files: dict[str, Path], tmp_path: Path) -> None:
    outcome = carproof("dependencies", files["ring"], files["ring-plans"])
    assert outcome.code == 1
    assert "cycle at tick 1: " in outcome.stdout
    assert all(f"robot r{number} into" in outcome.stdout for number in range(4))
    picture = tmp_path / "graph.dot"
    outcome = carproof("dependencies", files["train"], files["train-plans"], "--delay", "r0:0:4", "--dot", picture)
    assert outcome.code == 0
    assert "robot r0 is late by 4\nrobot r1 is late by 4\n" in outcome.stdout
    assert "on the clock, robots collide by these delays: robot r0 at visit 0 by 1" in outcome.stdout
    assert picture.read_text().count("->") == 3
    document = json.loads(carproof("dependencies", files["train"], files["train-plans"], "--json").stdout)
    assert document["acyclic"]
    assert [visit["slack"] for visit in document["visits"]] == [0, 0, None, None]


def test_drivers_collide_wait_or_stand(carproof: Run, files: dict[str, Path], tmp_path: Path) -> None:
    outcome = carproof("execute", files["train"], files["train-plans"], "--delays", files["delays"])
    assert outcome.code == 1
    rows = {row.split()[0]: row.split() for row in outcome.stdout.splitlines()[2:5]}
    assert [rows[driver][7] for driver in DRIVERS] == ["1", "0", "0"]
    assert [rows[driver][4] for driver in DRIVERS] == ["1", "2", "2"]
    outcome = carproof("execute", files["ring"], files["ring-plans"], "--driver", "order", "--delays", "0")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[2].split() == ["order", "4", "0", "0", "0", "-", "-", "0", "4", "0"]
    done = tmp_path / "done.json"
    options = ("--driver", "order", "--delays", files["delays"], "--trace", done)
    assert carproof("execute", files["train"], files["train-plans"], *options).code == 0
    assert carproof("check-trace", files["train"], files["train-plans"], done).code == 0


def test_retimed_plans_are_a_fleet_under_way(carproof: Run, files: dict[str, Path], tmp_path: Path) -> None:
    late = tmp_path / "late.json"
    outcome = carproof("retime", files["train"], files["train-plans"], files["trace"], "-o", late)
    assert outcome.code == 0
    assert outcome.stdout.splitlines() == [
        "total cost 2 before, 7 now",
        "robot r0 arrives 2 ticks later",
        "robot r1 arrives 3 ticks later",
    ]
    assert carproof("check", files["train"], late).code == 0
    assert carproof("query", files["train"], late, "r1", "--now", "3", "--engine", "reference").code == 0


def test_a_rotation_is_untangled_at_least_cost_or_named(carproof: Run, files: dict[str, Path], tmp_path: Path) -> None:
    out = tmp_path / "in-order.json"
    outcome = carproof("untangle", files["ring"], files["ring-plans"], "-o", out, "--engine", "reference")
    assert outcome.code == 0
    assert outcome.stdout.splitlines()[2].split() == ["4", "1", "6", "2"]
    instance, solution = read_instance(files["ring"].read_bytes()), read_solution(out.read_bytes())
    assert judge(instance, solution).valid
    assert not list(is_acyclic(instance, solution))
    closed = square(RING)
    closed["graph"]["nodes"].pop()
    closed["graph"]["edges"].pop()
    files["ring"].write_text(json.dumps(closed))
    out.unlink()
    outcome = carproof("untangle", files["ring"], files["ring-plans"], "-o", out, "--engine", "reference")
    assert (outcome.code, outcome.stdout, out.exists()) == (1, "", False)
    assert outcome.stderr.startswith("Out of the rotation of the robots ")


@settings(max_examples=draws(60), deadline=None)
@given(planned_instances(SIZES))
def test_untangled_plans_are_lawful_and_can_be_followed_in_order(case: PlannedInstance) -> None:
    found = untangle(case.instance, case.solution, engine_named("reference"))
    assert judge(case.instance, found.solution).valid
    if not found.rotation:
        assert not list(is_acyclic(case.instance, found.solution))
        assert judge(case.instance, found.solution).cost == judge(case.instance, case.solution).cost + found.extra


@settings(max_examples=draws(60), deadline=None)
@given(planned_instances(SIZES))
def test_who_switches_follows_the_order_that_came_of_it(case: PlannedInstance) -> None:
    instance, solution = case.instance, case.solution
    delays = random_delays(solution, 300_000, 5, 1)
    order, switching = (execute(instance, solution, driver, delays) for driver in ("order", "switching"))
    if order.standing:
        return
    assert not trace_violations(instance, switching.followed, switching.trace)
    assert not {each.rule for each in check(instance, switching.trace.plans)} & {"joint/capacity", "joint/exchange"}
    assert sum(switching.late.values()) <= sum(order.late.values())


def test_an_executed_trace_reads_as_it_was_written(carproof: Run, files: dict[str, Path], tmp_path: Path) -> None:
    done, followed = tmp_path / "done.json", tmp_path / "followed.json"
    options = ("--driver", "switching", "--trace", done, "--followed", followed, "--json")
    outcome = carproof("execute", files["train"], files["train-plans"], *options)
    assert json.loads(outcome.stdout)["driver"] == "switching"
    assert read_trace(done.read_bytes()).now == 2
    assert read_solution(followed.read_bytes()).order == ("r0", "r1")
