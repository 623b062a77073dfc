"""Between two ticks at which stays begin or end, the occupancy stays the same.

z3 checks that a stay that neither begins nor ends in (from, to] holds both ticks or neither. So it is enough to look
at the ticks of the changes, as `free_windows` does.

By hand: the induction over stays, from none, where the occupancy is 0 throughout; and that `free_windows` looks at
every tick at which a stay begins or ends, which is read in its source.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
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


def formulas() -> Iterator[Formula]:
    """The induction step; that the occupancy without stays is 0 throughout needs no proof."""
    stay, (start, end) = interval("stay"), integers("start end")
    premises, after = _same_occupancy(stay, start, end)
    yield Formula("one stay more keeps the occupancies equal", [*premises, no_change(stay, start, end)], after)


def mutants() -> Iterator[Formula]:
    """Changes that are overlooked."""
    stay, (start, end) = interval("stay"), integers("start end")
    premises, after = _same_occupancy(stay, start, end)
    begins = negation(between(start + 1, stay.start, end + 1))
    yield Formula("the ends of stays are overlooked", [*premises, begins], after)
    yield Formula("a change at the last tick is overlooked", [*premises, no_change(stay, start, end - 1)], after)


LEMMA = Lemma("Occupancy changes only where stays begin or end", __doc__, ("window/free",), formulas, mutants)
