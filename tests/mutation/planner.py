"""Mutants of the compiled planner, run uncompiled, each in a process forked from one that has loaded all but it.

`python -m tests.mutation.planner` lists the mutants that no check notices; with names of modules, of these alone, and
with a name and lines, `queries.search:89:91`, of these lines alone. The checks are those of tests/optimized that fit
into a few seconds: random small questions and fleets to which robots are added, whose answers by the reference are
known before the first fork; test_replanning.py, test_reasons.py, test_reuse.py and test_adding.py. Beside a mutant that
survives stands how many queries it asks of the fleets, where it asks other ones: more cost time alone, fewer want a
reason. Starting pytest and numba for each mutant would take ten times as long.
"""

import os
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from importlib import import_module
from inspect import signature
from itertools import product
from pathlib import Path
from typing import Any

os.environ["NUMBA_DISABLE_JIT"] = "1"  # numba looks when it is loaded
os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import numpy as np
import pytest
import tests.conftest  # noqa: F401 - the profile
from tests.mutation.forking import ROOT, Case, Changed, chosen, outcome, run_mutants
from tests.mutation.mutants import Mutant, mutants
from tests.optimized.neighbourhood.arrivals import CROWDED, ROOMS, Arrivals, arrivals, convoy, scaled

import carp_reference
from carp_spec import Instance, Neighbourhood, Planner, Solution
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
    "draws",
    "passes",
    "windows.rows",
    "windows.sweeps",
    "windows.reserving",
    "windows.fitting",
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
TESTS: Mapping[str, str] = {
    "neighbourhood.test_replanned_robots": "",
    "neighbourhood.test_replanning": "",
    "queries.test_reasons": "",
    "neighbourhood.test_reuse": "beginning-4 every_query each_kind sampled_orders",
    "neighbourhood.test_adding": "law reserved",
    "queries.test_corners": "too_far_is_refused-1 guide_ends detour_longer",
    "test_limits": "too_far largest_tick",
}
"""Modules of tests/optimized, and words in names or parameters of their tests that take part; "" is all of them."""


def source_of(module: str) -> Path:
    """The file of a module, which is named as below `carp_optimized`."""
    return FOLDER / f"{module.replace('.', '/')}.py"


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
    tests = [each for module, words in TESTS.items() for each in tests_of(module, words)]
    return [*(Case(each, SECONDS) for each in asked), *(Case(each, TEST_SECONDS) for each in tests)]


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


def tests_of(module: str, words: str) -> Iterator[Callable[[], int]]:
    """The tests of a module of tests/optimized as pytest calls them, if one of the words is in name and parameters."""
    for name, test in vars(import_module(f"tests.optimized.{module}")).items():
        if name.startswith("test_"):
            marks = [mark for mark in getattr(test, "pytestmark", ()) if mark.name == "parametrize"]
            for values in product(*(mark.args[1] for mark in marks)):
                given = dict(
                    pair for mark, value in zip(marks, values, strict=True) for pair in named(mark.args[0], value)
                )
                shown = "-".join((name, *map(str, given.values())))
                if not words or any(word in shown for word in words.split()):
                    yield partial(call, module, name, given)


def named(names: str | Sequence[str], values: Any) -> Iterator[tuple[str, object]]:  # noqa: ANN401 - one or several
    """The parameters that a mark gives, one or several."""
    return zip([names], [values], strict=True) if isinstance(names, str) else zip(names, values, strict=True)


def call(module: str, name: str, given: Mapping[str, object]) -> int:
    """Call a test with its parameters."""
    test = getattr(import_module(f"tests.optimized.{module}"), name)
    with pytest.MonkeyPatch.context() as patch:
        test(**given, **({"monkeypatch": patch} if "monkeypatch" in signature(test).parameters else {}))
    return 0


def ask(plan: Callable[..., Solution], add: Callable[..., Solution], subject: object, planner: Planner) -> Solution:
    if isinstance(subject, Instance):
        return plan(subject, planner)
    fleet = subject
    return add(fleet.instance, fleet.solution, fleet.robot, fleet.now, planner)  # type: ignore[attr-defined]


def load(module: str, source: str) -> None:
    """Load the planner again, with another source of one module; "" is its own. Guides end where they can."""
    for name in [*sys.modules]:
        if name.startswith("carp_optimized") or (name.startswith("tests.optimized.") and ".test_" in name):
            del sys.modules[name]
    if source:
        sys.meta_path.insert(0, Changed(f"carp_optimized.{module}", source_of(module), source))
    import_module("carp_optimized.state.room").DETOUR = 0  # type: ignore[attr-defined]


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
