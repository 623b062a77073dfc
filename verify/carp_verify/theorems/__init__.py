"""The theorems, one a module: each proves its statement for all whole numbers, whatever their size.

A module has its name, a sentence; its statement, in its docstring; the rules that it supports; its lemmas and
their mutants. To add a theorem, write the module and its name here.
"""

from collections.abc import Iterator
from importlib import import_module

from carp_verify.engine import Theorem

MODULES = (
    "counting_gives_occupancy",
    "occupancy_changes_only_where_stays_begin_or_end",
    "sweeping_makes_the_free_windows",
    "reserving_splits_a_window",
    "reserving_counts_at_any_capacity",
    "free_windows_are_unique",
    "unreserving_inverts_reserving",
    "stays_that_fit_keep_capacity",
    "entry_is_the_least_allowed",
    "earliest_entry_dominates",
    "heuristic_is_consistent",
    "first_pop_is_final",
    "certificate_bounds_every_tick",
    "cut_permutations_are_no_better",
    "skipped_queries_return_the_same",
    "freed_stays_come_too_late",
    "prices_bound_the_total",
    "history_is_kept",
    "ended_plans_occupy_nothing",
)


def theorem_named(module: str) -> Theorem:
    """Load a theorem by the name of its module."""
    theorem = import_module(f"carp_verify.theorems.{module}").THEOREM
    assert isinstance(theorem, Theorem)  # noqa: S101 - a promise of ours, not of the user's
    return theorem


def all_theorems() -> Iterator[Theorem]:
    """Load all theorems, one after the other."""
    return map(theorem_named, MODULES)
