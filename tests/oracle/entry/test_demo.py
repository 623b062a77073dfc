"""`carproof demo`, on small instances in place of its own, and the files that it leaves."""

from pathlib import Path

import pytest
from tests.oracle.running import Run

from carproof.generate import Fleet, Grid, grid_instance


def test_the_demo_plans_checks_and_compares(carproof: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = grid_instance(Grid(5, 5), Fleet(robots=6))
    monkeypatch.setattr("carproof.commands.run.demo.grid_instance", lambda *_: small)
    folder = tmp_path / "new" / "demo"
    outcome = carproof("demo", folder)
    assert (outcome.code, outcome.stderr) == (0, "")
    rows = [tuple(line.split()[:2]) for line in outcome.stdout.splitlines()[3:7]]
    assert rows == [(name, planner) for name in ("paper", "depot") for planner in ("carp", "neighbourhood")]
    plans = [f"{name}-{planner}.json" for name, planner in rows]
    assert {path.name for path in folder.iterdir()} == {*plans, "paper.json", "depot.json", "depot.map", "depot.scen"}
    for (name, _), file in zip(rows, plans, strict=True):
        assert carproof("check", folder / f"{name}.json", folder / file).code == 0
