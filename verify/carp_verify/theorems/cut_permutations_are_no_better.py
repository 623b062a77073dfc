"""Cutting the orders that begin with a prefix loses no strictly better candidate.

A prefix is cut if the cost of the plans so far, with a lower bound on each plan to come, is no less than the best
total. The plan of a robot costs no less than its shortest path on the empty graph. So, for any number of robots to
come, by induction, the total of every order behind the prefix is no less than the best, and `neighbourhood/best`
would not take it. A prefix in which a robot finds no plan has no candidate behind it at all.
"""

from collections.abc import Iterator

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, Int, integers, negation


def replaces_best(cost: Int, best: Int) -> Bool:
    """Whether a candidate replaces a best one that there is: `neighbourhood/best`."""
    return cost < best


def is_cut(prefix: Int, bounds: Int, best: Int) -> Bool:
    """Whether a prefix is cut: its cost, the sum of the bounds of the robots to come, and the best total."""
    return prefix + bounds >= best


def lemmas() -> Iterator[Lemma]:
    """The induction over the robots to come, and the cut."""
    prefix, bounds, costs, best, bound, cost = integers("prefix bounds costs best bound cost")
    step = [costs >= bounds, cost >= bound]
    yield Lemma("one robot more keeps the costs above the bounds", step, costs + cost >= bounds + bound)
    cut = [costs >= bounds, is_cut(prefix, bounds, best)]
    yield Lemma("a cut order would not replace the best", cut, negation(replaces_best(prefix + costs, best)))


def mutants() -> Iterator[Lemma]:
    """Cuts that are too greedy."""
    prefix, bounds, costs, best = integers("prefix bounds costs best")
    not_better = negation(replaces_best(prefix + costs, best))
    greedy = [costs >= bounds, prefix + bounds >= best - 1]
    yield Lemma("a prefix is cut that may improve by one tick", greedy, not_better)
    unsound = [bounds >= 0, costs >= 0, is_cut(prefix, bounds, best)]
    yield Lemma("the bounds are no lower bounds", unsound, not_better)


THEOREM = Theorem(
    "A cut of permutations loses no strictly better one",
    __doc__,
    ("neighbourhood/best", "neighbourhood/orders", "cost/total"),
    lemmas,
    mutants,
)
