"""Along a transition f = g + h never falls, so h is consistent.

h(r) is the least number of ticks from entering r to entering the goal on the empty graph, so h(r) <= d(r) + h(s) for
every move from r to s, and h(goal) = 0. A transition enters s no earlier than d(r) after it entered r. z3 adds the two
inequalities.

By hand: the induction over transitions, at whose end f is the arrival, so that f of a node never exceeds the arrival
of a plan through it. That h keeps its inequality is a premise, and tested of the reference's h on small graphs.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, integers


def _shortest() -> Bool:
    """The inequality that every move gives h, as h is the least over all paths."""
    h, h_after, duration = integers("h h_after duration")
    return h <= duration + h_after


def _premises() -> Sequence[Bool]:
    g, g_after, h, h_after, duration = integers("g g_after h h_after duration")
    return [duration >= 1, h >= 0, h_after >= 0, g >= 0, g_after >= g + duration]


def formulas() -> Iterator[Formula]:
    """The value of f before and after a transition."""
    g, g_after, h, h_after = integers("g g_after h h_after")
    yield Formula("f does not fall along a transition", [*_premises(), _shortest()], g_after + h_after >= g + h)


def mutants() -> Iterator[Formula]:
    """Heuristics that are no shortest paths."""
    g, g_after, h, h_after, duration = integers("g g_after h h_after duration")
    falls = g_after + h_after >= g + h
    yield Formula("h is a tick too large", [*_premises(), h <= duration + h_after + 1], falls)
    yield Formula("h is anything", _premises(), falls)
    early = [duration >= 1, h >= 0, h_after >= 0, g >= 0, g_after >= g, _shortest()]
    yield Formula("a transition may be shorter than the duration", early, falls)


LEMMA = Lemma("The heuristic is consistent", __doc__, ("query/optimal", "query/ties"), formulas, mutants)
