"""The first entry of a window that A* takes from its queue is the earliest of all, so a window is expanded once.

Any other way to the window has, by the invariant of A*, a node in the queue, and h is consistent, so the f of that
node is at most the f with which the way reaches the window. The node taken has the least f in the queue, and h depends
on the resource alone. For the goal this says that the first plan found arrives earliest.

By hand: the invariant of A*, by induction over expansions and along a way ("The heuristic is consistent"). It is the
larger part of the argument; z3 checks the comparison that follows from it. Tests look for the invariant at every step
of the reference on small graphs.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, integers


def is_taken(g: Int, h: Int, f_queued: Int) -> Bool:
    """Whether a node may be taken from the queue before one with `f_queued`: `query/ties`."""
    return g + h <= f_queued


def is_ahead(f_queued: Int, g: Int, h: Int) -> Bool:
    """The invariant of A*: a way that reaches a window at g has a node in the queue, whose f is no more than g + h."""
    return f_queued <= g + h


def is_final(g: Int, g_other: Int) -> Bool:
    """Whether another way is no earlier than the one taken."""
    return g <= g_other


def _premises() -> Sequence[Bool]:
    """`g` belongs to the node taken, `g_other` to another way to its window, `f_queued` to its queued node."""
    g, g_other, h, f_queued = integers("g g_other h f_queued")
    return [g >= 0, g_other >= 0, h >= 0, is_ahead(f_queued, g_other, h)]


def formulas() -> Iterator[Formula]:
    """No other way is earlier."""
    g, g_other, h, f_queued = integers("g g_other h f_queued")
    taken = [*_premises(), is_taken(g, h, f_queued)]
    yield Formula("no other way reaches the window earlier", taken, is_final(g, g_other))


def mutants() -> Iterator[Formula]:
    """Orders of the queue and heuristics under which a first pop is not final."""
    g, g_other, h, h_other, f_queued = integers("g g_other h h_other f_queued")
    yield Formula("the queue is not in the order of f", _premises(), is_final(g, g_other))
    taken = [g >= 0, g_other >= 0, h >= 0, is_taken(g, h, f_queued)]
    yield Formula("h is not consistent", taken, is_final(g, g_other))
    differs = [*taken, h_other >= 0, is_ahead(f_queued, g_other, h_other)]
    yield Formula("h depends on the way", differs, is_final(g, g_other))


LEMMA = Lemma("The first pop of a window is final", __doc__, ("query/optimal", "query/ties"), formulas, mutants)
