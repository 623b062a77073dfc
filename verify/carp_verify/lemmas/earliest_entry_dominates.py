"""Whatever a robot can do after a later entry into a window, it can do after an earlier one.

Waiting in a window is free: the stay from the earlier entry to the same leave fits too. So does the last visit of a
plan, of exactly one duration (`vanish`) or for ever (`park`). So a window needs only its earliest entry. (The window
in which a query begins is not among the windows entered, as a robot under way may have stayed too long to end there.)

By hand: the induction over the rest of the plan, which begins at the same leave and so is allowed as before.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, all_of, implies, integers, truth
from carp_verify.vocabulary import Interval, interval, is_interval, stay_fits


def stay(enter: Int, leave: Int) -> Interval:
    """A stay that may be for ever."""
    return Interval(enter, leave, truth("for ever"))


def _premises(later: Int) -> Sequence[Bool]:
    """Both entries are in the window, and after the later one the stay fits."""
    window, (early, leave, duration) = interval("window"), integers("early leave duration")
    fits = stay_fits(window, stay(later, leave), duration)
    return [is_interval(window), duration >= 1, early >= window.start, fits]


def formulas() -> Iterator[Formula]:
    """Leaving at the same tick, and ending the plan there."""
    window, (early, later, leave, duration) = interval("window"), integers("early later leave duration")
    premises = [*_premises(later), early <= later]
    fits = stay_fits(window, stay(early, leave), duration)
    yield Formula("the stay from the earlier entry to the same leave fits", premises, fits)
    one = stay_fits(window, stay(early, early + duration), duration)
    other = stay_fits(window, stay(later, later + duration), duration)
    yield Formula("a last visit from the earlier entry on fits", premises, implies(other, one))


def mutants() -> Iterator[Formula]:
    """Entries that are not earlier, or not in the window."""
    window, (early, later, leave, duration) = interval("window"), integers("early later leave duration")
    fits = stay_fits(window, stay(early, leave), duration)
    yield Formula("the later entry dominates", [*_premises(later), early >= later], fits)
    outside = [is_interval(window), early <= later, duration >= 1, stay_fits(window, stay(later, leave), duration)]
    yield Formula("the earlier entry is into an earlier window", outside, fits)
    exactly = all_of(*_premises(later), early <= later, stay_fits(window, stay(later, later + duration), duration))
    longer = stay_fits(window, stay(early, later + duration + 1), duration)
    yield Formula("the earlier entry makes the window longer", [exactly], longer)


LEMMA = Lemma(
    "The earliest entry into a window dominates",
    __doc__,
    ("query/optimal", "query/complete", "window/fits"),
    formulas,
    mutants,
)
