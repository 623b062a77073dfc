"""The sum of the changes up to a tick is the occupancy at that tick.

A stay [enter, leave) changes the occupancy by +1 at enter and by -1 at leave; a stay for ever has no second change. z3
checks that one more stay adds the same to the sum of the changes and to the occupancy.

By hand: the induction over stays, from none, where both are 0. That `free_windows` adds up these changes is read in
its source, and tested on small stays.
"""

from collections.abc import Iterator

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, all_of, any_of, choose, counted, equal, integer
from carp_verify.vocabulary import Interval, holds, interval, is_interval


def changes_up_to(stay: Interval, tick: Int) -> Int:
    """The stay's part of the sum of the changes up to the tick."""
    left = choose(stay.for_ever, 0, counted(stay.end <= tick))
    return counted(stay.start <= tick) - left


def _adds_the_same(stay: Interval, tick: Int) -> tuple[Bool, Bool]:
    """Equal sums before the stay is added, and equal sums after."""
    changes, occupancy = integer("changes"), integer("occupancy")
    after = equal(changes + changes_up_to(stay, tick), occupancy + counted(holds(stay, tick)))
    return equal(changes, occupancy), after


def formulas() -> Iterator[Formula]:
    """The induction step; that both sums are 0 without stays needs no proof."""
    stay, tick = interval("stay"), integer("tick")
    before, after = _adds_the_same(stay, tick)
    yield Formula("one stay more adds the same to both sums", [before, is_interval(stay)], after)


def mutants() -> Iterator[Formula]:
    """Errors in the count."""
    stay, tick = interval("stay"), integer("tick")
    before, after = _adds_the_same(stay, tick)
    yield Formula("stays may end before they begin", [before, any_of(stay.for_ever, stay.start >= 0)], after)
    late = counted(stay.start <= tick) - choose(stay.for_ever, 0, counted(stay.end < tick))
    wrong = equal(late, counted(holds(stay, tick)))
    yield Formula("a stay is counted one tick too long", [all_of(before, is_interval(stay))], wrong)


LEMMA = Lemma("The sum of changes is the occupancy", __doc__, ("window/free",), formulas, mutants)
