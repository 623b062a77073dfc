"""Between two ticks at which stays begin or end, the occupancy stays the same.

For any number of stays, by induction: a stay that neither begins nor ends in (from, to] holds both or neither. So it
is enough to look at the ticks of the changes, as `free_windows` does.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, Int, all_of, between, counted, equal, integer, integers, negation
from carp_verify.vocabulary import Interval, holds, interval, is_interval


def no_change(stay: Interval, start: Int, end: Int) -> Bool:
    """Whether the stay neither begins nor ends in the ticks (start, end]."""
    ends = all_of(negation(stay.for_ever), between(start + 1, stay.end, end + 1))
    return all_of(negation(between(start + 1, stay.start, end + 1)), negation(ends))


def _same_occupancy(stay: Interval, start: Int, end: Int) -> tuple[Sequence[Bool], Bool]:
    """Equal occupancies of the stays before, and equal ones with one stay more."""
    at_start, at_end = integer("occupancy at start"), integer("occupancy at end")
    after = equal(at_start + counted(holds(stay, start)), at_end + counted(holds(stay, end)))
    return [equal(at_start, at_end), is_interval(stay), start <= end], after


def lemmas() -> Iterator[Lemma]:
    """The induction step; that the occupancy without stays is 0 throughout needs no proof."""
    stay, (start, end) = interval("stay"), integers("start end")
    premises, after = _same_occupancy(stay, start, end)
    yield Lemma("one stay more keeps the occupancies equal", [*premises, no_change(stay, start, end)], after)


def mutants() -> Iterator[Lemma]:
    """Changes that are overlooked."""
    stay, (start, end) = interval("stay"), integers("start end")
    premises, after = _same_occupancy(stay, start, end)
    begins = negation(between(start + 1, stay.start, end + 1))
    yield Lemma("the ends of stays are overlooked", [*premises, begins], after)
    yield Lemma("a change at the last tick is overlooked", [*premises, no_change(stay, start, end - 1)], after)


THEOREM = Theorem("Occupancy changes only where stays begin or end", __doc__, ("window/free",), lemmas, mutants)
