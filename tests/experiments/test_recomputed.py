"""`carproof experiment recomputed`: the reference finds what a store holds, or the command says where it does not."""

from pathlib import Path
from typing import cast

import pytest
from tests.oracle.running import Run

from carp_experiments.command import RECOMPUTED
from carp_experiments.recomputed import AGAIN, AGAIN_IN_FEW
from carp_experiments.store import Store, stored_rows

SMALL = "--robots 5 --map 20 --assignments 2"
pytestmark = pytest.mark.usefixtures("elsewhere")


def test_the_command_names_the_experiments_that_can_be_computed_again() -> None:
    assert {*RECOMPUTED} == {*AGAIN} == {*AGAIN_IN_FEW}


@pytest.mark.parametrize(
    "experiment",
    [
        "related",
        "reuse",
        *(
            pytest.param(name, marks=pytest.mark.ci)
            for name in ("quality", "gap", "time", "neighbours", "nearest", "polish")
        ),
    ],
)
def test_the_reference_finds_what_a_run_has_stored(carproof: Run, experiment: str) -> None:
    small = SMALL.replace("--assignments 2", "--assignments 1") if experiment == "gap" else SMALL
    assert carproof(f"experiment {experiment} {small} --store run").code == 0
    again = carproof(f"experiment recomputed {experiment} run --robots 5 --cases 2 --json")
    assert again.code == 0, again
    assert '"equal":2' in again.stdout or experiment == "gap"


def test_a_result_that_the_reference_does_not_find_is_named(carproof: Run) -> None:
    carproof(f"experiment related {SMALL} --store run")
    wrong = Store(Path("wrong"), "related of 5 robots")
    for key, row in stored_rows(Path("run"), "related of 5 robots").items():
        costs = cast("dict[str, list[int]]", row["costs"])
        costs["3 disjoint paths"][4] += key == "assignment 001 map 20"
        wrong.add(key, row)
    wrong.close()
    outcome = carproof("experiment recomputed related wrong --robots 5")
    assert outcome.code == 1
    assert "not equal: 3 disjoint paths, assignment 001 map 20" in outcome.stdout
    assert outcome.stdout.count("not equal") == 1
