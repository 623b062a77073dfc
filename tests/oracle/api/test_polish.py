"""`carproof polish` and the op `polish`."""

import json
from pathlib import Path

import msgspec
import pytest
from tests.oracle.running import BEHIND, EAST, TWO, TWO_PLANNED, Run, corridor, save, solution

from carproof import polish, read_instance, read_solution, total_cost
from carproof.engines import engine_named
from carproof.protocol.ops.op import Session
from carproof.protocol.server import respond

LATE = solution({"r1": [["a", 0, 2], ["b", 2, 4], ["c", 4, 5]], "r2": TWO_PLANNED["plans"][1]["visits"]})
BEST = 5
INSTANCE, GIVEN = read_instance(msgspec.json.encode(TWO)), read_solution(msgspec.json.encode(LATE))


@pytest.fixture(autouse=True)
def _late(folder: Path) -> None:
    """Plans that are later than they must be."""
    del folder
    save(late=LATE)


def test_the_gap_is_that_of_a_certificate_which_is_verified(carproof: Run) -> None:
    assert carproof("bound town.json --steps 0 -o bound.json").code == 0
    outcome = carproof("polish town.json late.json --iterations 0 --bound bound.json")
    assert outcome.stdout.splitlines()[2].split() == ["given", "0", "7", "5", "40.00", "%"]
    certificate = Path("bound.json")
    certificate.write_text(certificate.read_text().replace('"bound":5', '"bound":6'))
    refused = carproof("polish town.json late.json --iterations 0 --bound bound.json")
    assert refused.code == 2
    assert "$.bound" in refused.stderr


def test_for_a_time_the_command_python_and_the_op_improve_plans(carproof: Run) -> None:
    assert carproof("polish town.json late.json --seconds 0.1").stdout.splitlines()[-1].split()[:3] == [
        "polished",
        "0",
        "5",
    ]
    assert total_cost(INSTANCE, polish(INSTANCE, GIVEN, seconds=0.2).plans) == BEST
    op = {"id": 1, "op": "polish", "instance": TWO, "solution": LATE, "seconds": 0.3}
    response, _ = respond(msgspec.json.encode(op), Session(engine_named(None)))
    found = read_solution(json.dumps(json.loads(msgspec.json.encode(response))["result"]).encode())
    assert total_cost(INSTANCE, found.plans) == BEST


def test_plans_stay_as_they_are_where_there_is_no_time(carproof: Run) -> None:
    outcome = carproof("polish town.json late.json --seconds 1e-9 -o same.json")
    assert outcome.stdout.splitlines()[-1].split()[:5] == ["polished", "0", "7", "-", "-"]
    assert read_solution(Path("same.json").read_bytes()) == GIVEN


def test_an_engine_keeps_to_rounds_that_never_raise_the_total(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carp_optimized.improve.annealing.polish_or_anneal", None)
    assert carproof("polish town.json late.json --seconds 0.1 --engine optimized").code == 0


def test_nobody_asks_after_the_time_why_robots_are_left_out(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """To ask takes a query for each robot: seconds in a large fleet."""
    save(three=corridor([EAST, BEHIND, {**EAST, "id": "r3"}]))
    monkeypatch.setattr("carproof.command_line.output.have_plans_beside", None)
    assert carproof("polish three.json late.json --seconds 0.1").code == 1
