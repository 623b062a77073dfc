"""`bound` and `verify-bound`."""

from collections.abc import Callable
from itertools import count
from pathlib import Path
from time import process_time

import pytest
from msgspec import to_builtins
from tests.oracle.running import HEAD_ON, Run, corridor, save

from carp_optimum.bound import Progress, lower_bound
from carp_spec.documents.bounds import BOUND_FORMAT, BoundDocument
from carp_spec.documents.instances import write_instance
from carp_verify.bound.verify import verify_bound
from carproof.generate import Fleet, Grid, Range, grid_instance

EMPTY = BoundDocument(BOUND_FORMAT, "", 0, 1, 0, (), (), (), ())


pytestmark = pytest.mark.usefixtures("folder")


def test_a_robot_without_a_way_is_told(carproof: Run) -> None:
    document = corridor([{"id": "r1", "start": "a", "goal": "island"}, HEAD_ON])
    document["graph"]["nodes"].append({"id": "island"})
    save(islands=document)
    outcome = carproof("bound islands.json --steps 3 -o certificate.json")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1] == "unplanned: no way leads from a to island, the goal of robot r1"
    verified = carproof("verify islands.json certificate.json")
    assert verified.code == 0
    assert verified.stdout.splitlines()[-1] == "robot r1 has no way to its goal: the bound is that of the others"


def test_stops_of_a_robot_alone_and_of_very_many_are_bounded_in_the_time(carproof: Run) -> None:
    """The shortest paths alone are a bound; by formulas, they took 15 s for 500 robots before the first look."""
    for robots, size in ((1, 4), (500, 40)):
        fleet = Fleet(robots, orders="pick-and-drop", service=Range(1, 2))
        Path("orders.json").write_bytes(write_instance(grid_instance(Grid(size, size), fleet)))
        started = process_time()
        outcome = carproof("bound orders.json --seconds 1")
        assert process_time() - started < 5
        assert outcome.code == 0
        assert outcome.stdout.splitlines()[-1].split()[0] == str(robots)


@pytest.mark.parametrize("fleet", [Fleet(80), Fleet(80, orders="pick-and-drop")])
def test_robots_that_there_is_no_time_for_count_as_0(fleet: Fleet) -> None:
    instance = grid_instance(Grid(12, 12), fleet)
    clock = (10**9 * each for each in count())
    found = lower_bound(instance, 0.5, clock=clock.__next__)
    assert verify_bound(instance, found) == found.bound
    assert 0 < found.bound < lower_bound(instance, steps=0).bound


def test_how_many_robots_there_was_no_time_for_is_told(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carproof.commands.plan.bound.time_left", lambda *_: 1e-9)
    Path("many.json").write_bytes(write_instance(grid_instance(Grid(12, 12), Fleet(80))))
    outcome = carproof("bound many.json --seconds 1")
    *_, numbers, told = outcome.stdout.splitlines()
    assert (numbers.split()[:2], outcome.code) == (["80", "-"], 0)
    assert told == "there was no time for the shortest paths of 48 robots, which count as 0"


@pytest.mark.parametrize(
    "command", ["bound town.json --steps 1 --plans plans.json", "polish town.json plans.json --bound bound.json"]
)
def test_plans_that_cost_less_than_the_bound_are_a_contradiction(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    def too_much(_: object, __: object, ___: object, keep: Callable[[Progress], None], **____: object) -> BoundDocument:
        keep(Progress(1, 1_000_000))
        return EMPTY

    monkeypatch.setattr("carp_verify.bound.verify.verify_bound", lambda *_: 1_000_000)
    monkeypatch.setattr("carp_optimum.bound.lower_bound", too_much)
    save(bound=to_builtins(EMPTY))
    outcome = carproof(command)
    assert outcome.code == 70
    assert outcome.stderr.startswith("Internal contradiction: plans that break no rule cost 5, less than the lower")
    assert "Traceback" not in outcome.stderr
