"""The output of `carproof dev bench` for made-up figures, and its progress."""

import json
from collections.abc import Callable
from types import SimpleNamespace

import pytest
from tests.oracle.running import Run

from carp_experiments.measuring import bench
from carp_experiments.measuring import bench_command as command
from carp_experiments.measuring.bench import GROWTH, PARTS, Added, OnMap, on_grid, on_map, weight

KINDS = ("kept", "unchanged", "prefixes", "shared", "bounds")


def figures(map: int, _: int, __: Callable[[], None]) -> OnMap:
    return OnMap(
        map, 12.34, 1234.5, [Added(100, name, 5.6, 23.45, 78, dict.fromkeys(KINDS, 9)) for name in ("4", "10")]
    )


def test_the_document_has_the_ratios_of_the_last_robot_on_the_full_map(
    carproof: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "on_map", figures)
    outcome = carproof("dev", "bench", "--assignments", "3", "--no-growth", "--json")
    document = json.loads(outcome.stdout)
    assert document["ratios"] == {"4": 23.45, "10": 23.45}
    assert (document["query_us"], document["pass_us"], document["growth"]) == (12.34, 1234.5, [])


def test_progress_ends_when_all_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "PROPOSED", {"4": bench.PROPOSED["4"]})
    done = SimpleNamespace(steps=0)

    def advance() -> None:
        done.steps += 1

    assert on_map(20, 1, advance).added[-1].asked > 0
    assert done.steps == 1
    grid = on_grid(20, advance)
    assert done.steps == 1 + PARTS * weight(20)
    assert (grid.robots, grid.asked > 0) == (100, True)
    assert [weight(side) for side in GROWTH] == sorted(weight(side) for side in GROWTH)
