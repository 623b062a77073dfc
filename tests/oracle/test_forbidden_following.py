"""Instances that forbid following: all parts that plan, judge, prove and execute keep a free tick."""

from pathlib import Path

import pytest
from tests.oracle.running import BEHIND_PLAN, ONE_PLANNED, TWO, Run, save, solution

FORBIDDING = {**TWO, "following": "forbidden"}
APART = solution({"r1": [["a", 0, 2], ["b", 2, 3], ["c", 3, 4]], "r2": BEHIND_PLAN})


@pytest.fixture(autouse=True)
def _instances(elsewhere: Path) -> None:
    del elsewhere
    save(allowing=TWO, forbidding=FORBIDDING, one=ONE_PLANNED, apart=APART)


@pytest.mark.parametrize(
    "command",
    [
        "plan forbidding.json --engine reference -o plans.json",
        "add forbidding.json one.json r2 --engine reference -o plans.json",
        "polish forbidding.json apart.json --engine reference --iterations 1 -o plans.json",
        "execution give-way forbidding.json apart.json r1 --engine reference -o plans.json",
        "execution untangle forbidding.json apart.json --engine reference -o plans.json",
    ],
)
def test_commands_that_plan_keep_a_free_tick(command: str, carproof: Run) -> None:
    assert carproof(command).code == 0
    assert carproof("check forbidding.json plans.json").code == 0
    assert carproof("execution dependencies forbidding.json plans.json").code == 0
    assert carproof("execution simulate forbidding.json plans.json --driver order --delays 0.5").code == 0


def test_optima_and_gaps_keep_a_free_tick(carproof: Run) -> None:
    assert carproof("optimum forbidding.json -o best.json --proof proof").code == 0
    assert carproof("check forbidding.json best.json").code == 0
    assert carproof("verify forbidding.json proof").code == 0
    assert carproof("gap forbidding.json").code == 0
