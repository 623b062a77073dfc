"""Two maximal intervals of free ticks that share a tick are the same, so the occupancy determines the free windows.

Maximal: every tick in it is free, the tick before it is not or none exists, and the tick after its end is not free
or it has no end. z3 is given "every tick" only at the ticks at which the intervals begin and end, which is enough.

By hand: that every free tick lies in one maximal interval, so that the windows as a set are determined.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, all_of, any_of, equal, implies, integer, negation, predicate, same
from carp_verify.vocabulary import Interval, holds, interval, is_interval

free = predicate("free")


def is_maximal(window: Interval) -> Bool:
    """Whether the window cannot be made longer."""
    return all_of(
        any_of(equal(window.start, 0), negation(free(window.start - 1))),
        any_of(window.for_ever, negation(free(window.end))),
    )


def is_free_at(window: Interval, ticks: Sequence[Int]) -> Sequence[Bool]:
    """That the window's ticks are free, said of these ticks."""
    return [implies(holds(window, tick), free(tick)) for tick in ticks]


def _premises() -> Sequence[Bool]:
    one, two, shared = interval("one"), interval("two"), integer("shared")
    ticks = [each for window in (one, two) for each in (window.start - 1, window.end)]
    free_ticks = [premise for window in (one, two) for premise in is_free_at(window, ticks)]
    return [is_interval(one), is_interval(two), *free_ticks, holds(one, shared), holds(two, shared)]


def _are_same() -> Bool:
    one, two = interval("one"), interval("two")
    same_end = any_of(one.for_ever, equal(one.end, two.end))
    return all_of(equal(one.start, two.start), same(one.for_ever, two.for_ever), same_end)


def formulas() -> Iterator[Formula]:
    """The windows are the same."""
    maximal = [is_maximal(interval("one")), is_maximal(interval("two"))]
    yield Formula("maximal free windows that share a tick are the same", [*_premises(), *maximal], _are_same())


def mutants() -> Iterator[Formula]:
    """Windows that are not maximal, or share no tick."""
    one_only = [*_premises(), is_maximal(interval("one"))]
    yield Formula("one of the windows is not maximal", one_only, _are_same())
    *apart, _, _ = _premises()
    maximal = [is_maximal(interval("one")), is_maximal(interval("two"))]
    yield Formula("the windows need not share a tick", [*apart, *maximal], _are_same())


LEMMA = Lemma("The occupancy determines the free windows", __doc__, ("window/free",), formulas, mutants)
