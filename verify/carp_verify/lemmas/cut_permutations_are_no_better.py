"""Cutting the orders that begin with a prefix loses no strictly better candidate.

A prefix is cut if the cost of the plans so far, with a lower bound on each plan to come, is no less than the best
total. The plan of a robot costs no less than its shortest path on the empty graph. z3 checks that an order whose costs
are no less than the bounds would not replace the best.

By hand: the costs of all robots to come add up to at least their bounds, because each cost does; a prefix in which a
robot finds no plan has no candidate behind it; and the optimised planner cuts by this test, which is tested by
comparing planners.
"""

from collections.abc import Iterator

from carp_verify.lemmas.engine import Formula, Lemma
from carp_verify.lemmas.smt import Bool, Int, integers, negation
from carp_verify.lemmas.vocabulary import replaces_best


def is_cut(prefix: Int, bounds: Int, best: Int) -> Bool:
    """Whether a prefix is cut: its cost, the sum of the bounds of the robots to come, and the best total."""
    return prefix + bounds >= best


def formulas() -> Iterator[Formula]:
    """The cut."""
    prefix, bounds, costs, best = integers("prefix bounds costs best")
    cut = [costs >= bounds, is_cut(prefix, bounds, best)]
    yield Formula("a cut order would not replace the best", cut, negation(replaces_best(prefix + costs, best)))


def mutants() -> Iterator[Formula]:
    """Cuts that are too greedy."""
    prefix, bounds, costs, best = integers("prefix bounds costs best")
    not_better = negation(replaces_best(prefix + costs, best))
    greedy = [costs >= bounds, prefix + bounds >= best - 1]
    yield Formula("a prefix is cut that may improve by one tick", greedy, not_better)
    unsound = [bounds >= 0, costs >= 0, is_cut(prefix, bounds, best)]
    yield Formula("the bounds are no lower bounds", unsound, not_better)


LEMMA = Lemma(
    "A cut of permutations loses no strictly better one",
    __doc__,
    ("neighbourhood/best", "neighbourhood/orders", "cost/total"),
    formulas,
    mutants,
)
