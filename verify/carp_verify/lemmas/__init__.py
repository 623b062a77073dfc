"""The lemmas, one a module: formulas about whole numbers of any size, checked by z3, and what is left to argue by hand.

A module has a name, which is a sentence, the rules that it supports, its formulas and their mutants. Its docstring is
the statement and, after "By hand:", the part that z3 does not check. To add a lemma, write the module and list it here.
"""

from collections.abc import Iterator
from importlib import import_module

from carp_verify.engine import Lemma

MODULES = (
    "counting_gives_occupancy",
    "occupancy_changes_only_where_stays_begin_or_end",
    "sweeping_makes_the_free_windows",
    "reserving_splits_a_window",
    "free_windows_are_unique",
    "stays_that_fit_keep_capacity",
    "entry_is_the_least_allowed",
    "earliest_entry_dominates",
    "heuristic_is_consistent",
    "first_pop_is_final",
    "cut_permutations_are_no_better",
    "freed_stays_come_too_late",
    "prices_bound_the_total",
    "history_is_kept",
    "ended_plans_occupy_nothing",
)


def lemma_named(module: str) -> Lemma:
    """Load a lemma by the name of its module."""
    lemma = import_module(f"carp_verify.lemmas.{module}").LEMMA
    assert isinstance(lemma, Lemma)  # noqa: S101 - a promise of ours, not of the user's
    return lemma


def all_lemmas() -> Iterator[Lemma]:
    """Load all lemmas, one after the other."""
    return map(lemma_named, MODULES)
