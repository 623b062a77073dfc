"""The planners by name, and what their options may be."""

import pytest

from carp_spec import Carp, FixedPaths, Greedy, LongestFirst, Neighbourhood, Planner, Shuffled, TimeExpanded
from carp_spec.inputs.options import LARGEST_SAMPLE, options_are_right
from carp_spec.planners import LARGEST_SEED
from carproof.planner_options import PLANNERS, planner_named


@pytest.mark.parametrize(
    ("name", "options", "planner"),
    [
        ("carp", {}, Carp()),
        ("shuffled", {}, Shuffled(attempts=10, seed=0)),
        ("shuffled", {"attempts": 100, "seed": LARGEST_SEED}, Shuffled(100, LARGEST_SEED)),
        ("longest-first", {}, LongestFirst()),
        ("greedy", {}, Greedy()),
        ("neighbourhood", {}, Neighbourhood(m=4, sample=None, seed=0, baseline=True, fallback=None)),
        ("neighbourhood", {"m": 1, "sample": 1, "fallback": 1}, Neighbourhood(1, 1, 0, True, 1)),
        ("neighbourhood", {"sample": LARGEST_SAMPLE, "baseline": False}, Neighbourhood(4, LARGEST_SAMPLE, 0, False)),
        ("neighbourhood", {"sample": None, "fallback": None}, Neighbourhood()),
        ("fixed-paths", {}, FixedPaths(k=3, paths="shortest")),
        ("fixed-paths", {"k": 1, "paths": "disjoint"}, FixedPaths(1, "disjoint")),
        ("time-expanded", {}, TimeExpanded()),
    ],
)
def test_a_planner_is_made_from_its_name_and_options(name: str, options: dict[str, object], planner: Planner) -> None:
    assert planner_named(name, options) == planner
    assert PLANNERS[name] is type(planner)
    assert planner.name == name


def test_all_faults_of_a_planner_made_by_hand_are_told() -> None:
    planner = Neighbourhood(m=0, sample=0, seed=-1, fallback=0)
    assert [fault.path for fault in options_are_right(planner)] == ["$.m", "$.sample", "$.seed", "$.fallback"]
