"""Taking a reserved stay back gives the free windows that were there before.

At any capacity the occupancy of each tick is what it was, and that determines the windows ("The occupancy determines
the free windows"). At capacity 1, joining the two parts over the stay gives back the window that was split.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, Int, any_of, counted, integer, integers, same
from carp_verify.theorems.reserving_splits_a_window import held_by_parts
from carp_verify.vocabulary import Interval, holds, interval, is_interval, stay_fits


def _joined(window: Interval, stay: Interval, tick: Int) -> Bool:
    """Whether one of the two parts or the stay between them holds the tick."""
    return any_of(held_by_parts(window, stay, tick), holds(stay, tick))


def _premises(window: Interval, stay: Interval) -> Sequence[Bool]:
    return [is_interval(window), is_interval(stay)]


def lemmas() -> Iterator[Lemma]:
    """The occupancy, and the joined window."""
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity, duration = integers("tick occupancy capacity duration")
    in_stay = counted(holds(stay, tick))
    back = same(occupancy + in_stay - in_stay < capacity, occupancy < capacity)
    yield Lemma("a tick is free again if and only if it was free", [occupancy >= 0, is_interval(stay)], back)
    premises = [*_premises(window, stay), stay_fits(window, stay, duration)]
    yield Lemma("the joined parts are the window", premises, same(_joined(window, stay, tick), holds(window, tick)))


def mutants() -> Iterator[Lemma]:
    """Something else is taken back than was reserved."""
    window, stay, other = interval("window"), interval("stay"), interval("other")
    tick, occupancy, capacity = integers("tick occupancy capacity")
    wrong = same(
        occupancy + counted(holds(stay, tick)) - counted(holds(other, tick)) < capacity,
        occupancy < capacity,
    )
    intervals = [occupancy >= 0, is_interval(stay), is_interval(other)]
    yield Lemma("another stay is taken back", intervals, wrong)
    is_window = same(_joined(window, stay, integer("tick")), holds(window, tick))
    yield Lemma("the parts are joined over a stay that was never in the window", _premises(window, stay), is_window)


THEOREM = Theorem("Unreserving a stay inverts reserving it", __doc__, ("window/free",), lemmas, mutants)
