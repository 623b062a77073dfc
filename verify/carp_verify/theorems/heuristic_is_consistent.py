"""Along a transition f = g + h never falls, so h is consistent.

h(r) is the least number of ticks from entering r to entering the goal on the empty graph, so h(r) <= d(r) + h(s) for
every move from r to s, and h(goal) = 0. A transition enters s no earlier than d(r) after it entered r. It follows that
f of a node never exceeds the arrival of a plan through it, for any number of transitions, by induction.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, equal, integers


def _shortest() -> Bool:
    """What every move gives h, as h is the least over all paths."""
    h, h_after, duration = integers("h h_after duration")
    return h <= duration + h_after


def _premises() -> Sequence[Bool]:
    g, g_after, h, h_after, duration = integers("g g_after h h_after duration")
    return [duration >= 1, h >= 0, h_after >= 0, g >= 0, g_after >= g + duration]


def lemmas() -> Iterator[Lemma]:
    """F along a transition, f at the goal, and the induction over a plan's transitions."""
    g, g_after, h, h_after, arrival = integers("g g_after h h_after arrival")
    premises = [*_premises(), _shortest()]
    yield Lemma("f does not fall along a transition", premises, g_after + h_after >= g + h)
    yield Lemma("f at the goal is the arrival", [equal(h, 0), equal(arrival, g)], g + h <= arrival)
    rest = [*premises, g_after + h_after <= arrival]
    yield Lemma("if f after a transition is no more than the arrival, f before is not", rest, g + h <= arrival)


def mutants() -> Iterator[Lemma]:
    """Heuristics that are no shortest paths."""
    g, g_after, h, h_after, duration = integers("g g_after h h_after duration")
    falls = g_after + h_after >= g + h
    yield Lemma("h is a tick too large", [*_premises(), h <= duration + h_after + 1], falls)
    yield Lemma("h is anything", _premises(), falls)
    early = [duration >= 1, h >= 0, h_after >= 0, g >= 0, g_after >= g, _shortest()]
    yield Lemma("a transition may be shorter than the duration", early, falls)


THEOREM = Theorem("The heuristic is consistent", __doc__, ("query/optimal", "query/ties"), lemmas, mutants)
