"""`carproof demo`, on small instances in place of its own, and the files that it leaves."""

from pathlib import Path

import pytest
from tests.oracle.running import Run

from carproof.generate import Fleet, Grid, grid_instance

FILES = [
    "depot-carp.json",
    "depot-neighbourhood.json",
    "depot.json",
    "depot.map",
    "depot.scen",
    "paper-carp.json",
    "paper-neighbourhood.json",
    "paper.json",
]


@pytest.fixture
def small_paper_map(monkeypatch: pytest.MonkeyPatch) -> None:
    small = grid_instance(Grid(5, 5), Fleet(robots=6))
    monkeypatch.setattr("carproof.commands.run.demo.grid_instance", lambda *_: small)


@pytest.mark.usefixtures("small_paper_map")
def test_the_demo_plans_checks_and_compares(carproof: Run, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "demo"
    outcome = carproof("demo", folder)
    assert (outcome.code, outcome.stderr) == (0, "")
    assert max(map(len, outcome.stdout.splitlines()[:7])) <= 80
    rows = [line.split() for line in outcome.stdout.splitlines()[3:7]]
    assert [row[:2] for row in rows] == [
        [name, planner] for name in ("paper", "depot") for planner in ("carp", "neighbourhood")
    ]
    assert sorted(path.name for path in folder.iterdir()) == FILES
    for name in ("paper", "depot"):
        for planner in ("carp", "neighbourhood"):
            assert carproof("check", folder / f"{name}.json", folder / f"{name}-{planner}.json").code == 0
