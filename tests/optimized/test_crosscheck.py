"""`first_difference` finds a planted difference, makes it small, and finds none where none exists."""

import pytest

import carp_optimized
from carp_experiments.measuring.crosscheck import first_difference
from carp_spec import Instance, Planner, Solution


def test_a_planted_difference_is_found_and_made_small(monkeypatch: pytest.MonkeyPatch) -> None:
    def forgetful(instance: Instance, planner: Planner) -> Solution:
        del planner
        return Solution((), (), tuple(instance.robot))

    monkeypatch.setattr(carp_optimized, "plan", forgetful)
    difference = first_difference(200, seed=1)
    assert difference is not None
    assert len(difference.instance.robots) == 1
    assert difference.reference.plans
    assert not difference.optimized.plans
