"""Mutants of the compiled planner, run uncompiled, each in a process forked from one that has loaded all but it.

`python -m tests.mutation.planner` lists the mutants that no check notices; with names of modules, of these alone, and
with a name and lines, `windows:89:91`, of these lines alone. The checks are those of tests/optimized that fit into a
few seconds: random small questions and fleets to which robots are added, whose answers by the reference are known
before the first fork; test_replanning.py, test_reasons.py, test_reuse.py and test_adding.py. Beside a mutant that
survives stands how many queries it asks of the fleets, where it asks other ones: more cost time alone, fewer want a
reason. Starting pytest and numba for each mutant would take ten times as long.
"""

import os
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from itertools import product
from pathlib import Path
from types import ModuleType

os.environ["NUMBA_DISABLE_JIT"] = "1"  # numba looks when it is loaded
os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import numpy as np
import pytest
import tests.conftest  # noqa: F401 - the profile
from tests.mutation.forking import ROOT, Case, chosen, outcome, run_mutants
from tests.mutation.mutants import Mutant, mutants
from tests.optimized.arrivals import CROWDED, ROOMS, Arrivals, arrivals, convoy, scaled
from tests.optimized.towns import TOWNS

import carp_reference
from carp_spec import Instance, Neighbourhood, Planner, Solution
from carproof.generate import Range
from carproof.testing.random_instances import question

FOLDER = ROOT / "optimized" / "carp_optimized"
MODULES = (
    "neighbourhood.replanning",
    "neighbourhood.order_search",
    "queries.relevant_plans",
    "neighbourhood.answers",
    "neighbourhood.adding",
    "neighbourhood.orders",
    "neighbourhood.distances",
    "passes",
    "queries.windows",
    "queries.guides",
    "queries.search",
)
QUESTIONS = 150
FLEETS = 300  # of each kind
CONVOYS = 10
SECONDS = 4  # of the processor, for one question or fleet
TEST_SECONDS = 30
KINDS = ("kept", "unchanged", "prefixes", "shared", "bounds")
CHOICES = list(product((True, False), repeat=len(KINDS)))
TESTS: Sequence[tuple[str, str, tuple[object, ...]]] = (
    *(("test_replanned_robots", "test_the_robots_behind_get_the_plans_of_the_reference", (name,)) for name in TOWNS),
    (
        "test_replanned_robots",
        "test_a_plan_alone_is_not_taken_over_from_before_a_round_that_left_a_robot_outside_without_a_plan",
        (),
    ),
    ("test_replanned_robots", "test_orders_are_drawn_in_a_round_too_in_which_a_member_has_no_plan", ()),
    ("test_replanning", "test_a_query_is_repeated_only_where_the_lemma_says_and_else_finds_the_same", ()),
    ("test_reasons", "test_a_query_does_the_same_without_plans_that_are_no_reasons", ()),
    (
        "test_reasons",
        "test_a_plan_in_the_way_is_a_reason_and_one_that_has_passed_or_is_elsewhere_is_none",
        (),
    ),
    (
        "test_reasons",
        "test_a_plan_that_passes_the_goal_later_is_a_reason_for_a_robot_that_parks_there",
        (),
    ),
    *(
        (
            "test_reasons",
            "test_a_plan_that_leaves_as_the_robot_comes_is_a_reason_where_following_is_forbidden",
            case,
        )
        for case in (("allowed", 0), ("forbidden", 1))
    ),
    (
        "test_reasons",
        "test_a_plan_that_comes_as_the_robot_leaves_is_a_reason_where_following_is_forbidden",
        (),
    ),
    ("test_reuse", "test_orders_that_begin_alike_share_the_queries_of_their_beginning", (4, 64, 96)),
    ("test_reuse", "test_without_reuse_every_query_is_asked", ()),
    *(("test_reuse", "test_each_kind_avoids_queries_and_counts_them", (kind,)) for kind in KINDS),
    ("test_reuse", "test_sampled_orders_share_their_beginnings_too", ()),
    ("test_adding", "test_a_distance_is_that_of_the_law_or_larger_than_the_best_as_it_should_be", ()),
    ("test_adding", "test_the_nearest_robot_is_that_of_the_law", ()),
    *(
        ("test_adding", "test_members_are_planned_alone_as_long_as_they_cost_less_than_the_limit", (more,))
        for more in (0, 1)
    ),
    ("test_adding", "test_a_plan_where_nothing_is_reserved_is_made_as_by_a_search", ()),
    ("test_adding", "test_a_plan_where_nothing_is_reserved_passes_by_places_that_do_not_lead_to_the_goal", ()),
    ("test_adding", "test_of_two_robots_equally_near_the_earlier_is_taken_though_the_other_is_the_likelier", ()),
    (
        "test_adding",
        "test_a_plan_must_cost_less_than_what_is_known_of_the_members_behind_leaves",
        (),
    ),
    ("test_corners", "test_a_goal_that_is_too_far_is_refused", (1,)),
    *(
        ("test_limits", "test_a_goal_behind_resources_that_are_too_far_is_refused_and_not_called_out_of_reach", (last,))
        for last in (2**29, 1)
    ),
    *(
        (
            "test_limits",
            "test_a_detour_that_is_too_far_is_refused_where_no_other_way_is_free",
            (pytest.MonkeyPatch(), detour),
        )
        for detour in (0, 2**30 - 1)
    ),
    *(
        (
            "test_corners",
            "test_a_guide_ends_a_detour_behind_the_start_until_more_of_it_is_asked_for",
            (pytest.MonkeyPatch(), last, pace),
        )
        for last in (1, 2)
        for pace in (1, 3)
    ),
    ("test_limits", "test_a_plan_that_would_pass_the_largest_tick_is_refused_while_planning", ()),
    *(
        (
            "test_adding",
            "test_tolls_are_in_the_order_of_the_ticks_to_the_goal_and_then_of_the_indices",
            (pytest.MonkeyPatch(), durations, ranked),
        )
        for durations in (Range(1, 1), Range(1, 3))
        for ranked in (False, True)
    ),
    ("test_adding", "test_the_least_sum_is_no_larger_than_the_sum_of_the_terms", ()),
)


def source_of(module: str) -> Path:
    """The file of a module, which is named as below `carp_optimized`."""
    return FOLDER / f"{module.replace('.', '/')}.py"


class Changed(MetaPathFinder, Loader):
    """Loads a module from another source than its file."""

    def __init__(self, name: str, source: str) -> None:
        self.name, self.source = name, source

    def find_spec(self, name: str, path: object, target: object = None) -> ModuleSpec | None:
        del path, target
        return spec_from_loader(name, self) if name == self.name else None

    def exec_module(self, module: ModuleType) -> None:
        module.__file__ = str(source_of(self.name.partition(".")[2]))
        exec(compile(self.source, module.__file__, "exec"), module.__dict__)  # noqa: S102 - a mutant is to be run


def cases() -> list[Case]:
    """The cases that a right planner passes, with the reference's answers; each loads the planner and counts
    queries."""
    asked: list[Callable[[], int]] = []
    questions = [question(1, number) for number in range(QUESTIONS)]
    questions += [
        (replace(subject, following="forbidden"), planner)
        for subject, planner in questions[::2]
        if isinstance(subject, Instance)
    ]
    for number, (subject, planner) in enumerate(questions):
        expected = ask(carp_reference.plan, carp_reference.add, subject, planner)
        choices = {CHOICES[0], CHOICES[number % len(CHOICES)]} if isinstance(planner, Neighbourhood) else {CHOICES[0]}
        asked += [partial(ask_question, subject, planner, choice, expected) for choice in choices]
    fleets = [arrivals(number, mix) for number in range(FLEETS) for mix in (CROWDED, ROOMS)]
    fleets += [*map(convoy, range(CONVOYS)), *(scaled(fleet, 2**26, 1) for fleet in fleets[:10:2])]
    asked += [partial(ask_fleet, fleet, fleet.by_reference()) for fleet in fleets]
    tests = [Case(as_case(test), TEST_SECONDS) for test in TESTS]
    return [*(Case(each, SECONDS) for each in asked), *tests]


def ask_question(subject: object, planner: Planner, choice: Sequence[bool], expected: Solution) -> int:
    import carp_optimized
    from carp_optimized import Reuse

    reuse = Reuse(*choice)
    plan, add = partial(carp_optimized.plan, reuse=reuse), partial(carp_optimized.add, reuse=reuse)
    assert ask(plan, add, subject, planner) == expected
    return 0


def ask_fleet(fleet: Arrivals, expected: Solution) -> int:
    solution, queries = fleet.by_fleet()
    assert solution == expected
    return queries.asked


def as_case(test: tuple[str, str, tuple[object, ...]]) -> Callable[[], int]:
    """A test of a module of tests/optimized, called with arguments."""
    module, name, arguments = test

    def case() -> int:
        getattr(import_module(f"tests.optimized.{module}"), name)(*arguments)
        for each in arguments:
            if isinstance(each, pytest.MonkeyPatch):
                each.undo()
        return 0

    return case


def ask(plan: Callable[..., Solution], add: Callable[..., Solution], subject: object, planner: Planner) -> Solution:
    if isinstance(subject, Instance):
        return plan(subject, planner)
    fleet = subject
    return add(fleet.instance, fleet.solution, fleet.robot, fleet.now, planner)  # type: ignore[attr-defined]


def load(module: str, source: str) -> None:
    """Load the planner again, with another source of one module; "" is its own. Guides end where they can."""
    for name in [name for name in sys.modules if name.startswith(("carp_optimized", "tests.optimized.test_"))]:
        del sys.modules[name]
    if source:
        sys.meta_path.insert(0, Changed(f"carp_optimized.{module}", source))
    import_module("carp_optimized.state.encoding").DETOUR = 0  # type: ignore[attr-defined]


def main(arguments: Sequence[str]) -> int:
    warnings.simplefilter("ignore")
    np.seterr(all="ignore")
    all_cases = cases()
    unchanged = outcome(lambda: load("", ""), all_cases)
    if unchanged.status:
        sys.exit("the planner fails the checks without any mutation")
    for module, lines in chosen(arguments, MODULES).items():

        def changed(mutant: Mutant, module: str = module) -> None:
            load(module, mutant.source)

        run_mutants(module, mutants(source_of(module), omit=False), lines, all_cases, changed, unchanged.work)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
