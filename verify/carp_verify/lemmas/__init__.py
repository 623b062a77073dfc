"""The lemmas, one a module: formulas about whole numbers of any size, checked by z3, and what is left to argue by hand.

A module has a name, which is a sentence, the rules that it supports, its formulas and their mutants. Its docstring is
the statement and, after "By hand:", the part that z3 does not check. To add a lemma, write the module and list it here.
"""

from importlib import import_module

from carp_verify.lemmas.engine import Lemma

MODULES = (
    "reserving_splits_a_window",
    "cut_permutations_are_no_better",
    "freed_stays_come_too_late",
    "ended_plans_occupy_nothing",
)


def lemma_named(module: str) -> Lemma:
    """Load a lemma by the name of its module."""
    lemma = import_module(f"carp_verify.lemmas.{module}").LEMMA
    assert isinstance(lemma, Lemma)  # noqa: S101 - a promise of ours, not of the user's
    return lemma
