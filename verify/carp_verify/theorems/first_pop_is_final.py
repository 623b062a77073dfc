"""The first entry of a window that A* takes from its queue is the earliest of all, so a window is expanded once.

Any other way to the window has, by the invariant of A*, a node in the queue, and h is consistent, so the f of that
node is at most the f with which the way reaches the window. The node taken has the least f in the queue, and h
depends on the resource alone. For the goal this says that the first plan found arrives earliest.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, integers


def _premises() -> Sequence[Bool]:
    """`g` is of the node taken, `g_other` of another way to its window, `f_queued` of that way's node in the queue."""
    g, g_other, h, f_queued = integers("g g_other h f_queued")
    return [g >= 0, g_other >= 0, h >= 0, f_queued <= g_other + h]


def lemmas() -> Iterator[Lemma]:
    """No other way is earlier; and the invariant that f along a way does not fall."""
    g, g_other, h, f_queued, f_between = integers("g g_other h f_queued f_between")
    least = g + h <= f_queued
    yield Lemma("no other way reaches the window earlier", [*_premises(), least], g <= g_other)
    chain = [f_queued <= f_between, f_between <= g_other + h]
    yield Lemma("one transition more keeps f from falling below the queue's", chain, f_queued <= g_other + h)


def mutants() -> Iterator[Lemma]:
    """Orders of the queue and heuristics under which a first pop is not final."""
    g, g_other, h, h_other, f_queued = integers("g g_other h h_other f_queued")
    yield Lemma("the queue is not in the order of f", _premises(), g <= g_other)
    inconsistent = [g >= 0, g_other >= 0, h >= 0, g + h <= f_queued]
    yield Lemma("h is not consistent", inconsistent, g <= g_other)
    differs = [g >= 0, g_other >= 0, h >= 0, h_other >= 0, g + h <= f_queued, f_queued <= g_other + h_other]
    yield Lemma("h depends on the way", differs, g <= g_other)


THEOREM = Theorem("The first pop of a window is final", __doc__, ("query/optimal", "query/ties"), lemmas, mutants)
