"""Reserving [a, b) in a window [s, e) of a resource of capacity 1 leaves [s, a) and [b, e).

Taking the reservation back joins them.

In the old window, exactly the ticks of the two are free afterwards; a part without ticks is no window. The two are
disjoint, in order, and as long as they can be: between them lies [a, b), which is not free. A reservation for ever
leaves no second part. The two parts and [a, b) together hold the ticks of the old window.

By hand: the induction over reservations and withdrawals, and that elsewhere nothing changes. That `split_window` and
`join_windows` of the optimised planner write these parts into their tables is tested by comparing planners.
"""

from collections.abc import Iterator, Sequence

from carp_verify.lemmas.engine import Formula, Lemma
from carp_verify.lemmas.smt import Bool, Int, all_of, any_of, counted, equal, implies, integers, negation, never, same
from carp_verify.lemmas.vocabulary import Interval, holds, interval, is_interval, stay_fits


def parts(window: Interval, stay: Interval) -> tuple[Interval, Interval]:
    """The parts of the window before and after the stay; a part may be without ticks."""
    return (
        Interval(window.start, stay.start, never()),
        Interval(stay.end, window.end, window.for_ever),
    )


def held_by_parts(window: Interval, stay: Interval, tick: Int) -> Bool:
    """Whether one of the two parts holds the tick."""
    one, two = parts(window, stay)
    return any_of(holds(one, tick), all_of(negation(stay.for_ever), holds(two, tick)))


def joined_parts(window: Interval, stay: Interval, tick: Int) -> Bool:
    """Whether one of the two parts or the stay between them holds the tick."""
    return any_of(held_by_parts(window, stay, tick), holds(stay, tick))


def _premises(window: Interval, stay: Interval, duration: Int) -> Sequence[Bool]:
    """A stay that keeps `window/fits`, in a window."""
    fits = stay_fits(window, stay, duration)
    return [is_interval(window), is_interval(stay), duration >= 1, fits]


def formulas() -> Iterator[Formula]:
    """The free ticks, the shape of the parts, and the parts joined."""
    window, stay = interval("window"), interval("stay")
    duration, tick, occupancy = integers("duration tick occupancy")
    premises = _premises(window, stay, duration)
    known = [*premises, occupancy >= 0, same(equal(occupancy, 0), holds(window, tick))]
    is_free_after = occupancy + counted(holds(stay, tick)) < 1
    yield Formula(
        "the parts hold exactly the free ticks", known, same(is_free_after, held_by_parts(window, stay, tick))
    )
    one, two = parts(window, stay)
    ordered = implies(all_of(holds(one, tick), negation(stay.for_ever)), tick < two.start - 1)
    yield Formula("the parts are disjoint, in order, and a tick lies between them", premises, ordered)
    joined = same(joined_parts(window, stay, tick), holds(window, tick))
    yield Formula("the parts joined over the stay are the window", premises, joined)


def mutants() -> Iterator[Formula]:
    """Errors in the premises and in the parts."""
    window, stay = interval("window"), interval("stay")
    duration, tick, occupancy = integers("duration tick occupancy")
    known = [occupancy >= 0, same(equal(occupancy, 0), holds(window, tick))]
    free_after = occupancy + counted(holds(stay, tick)) < 1
    right = same(free_after, held_by_parts(window, stay, tick))
    anywhere = [*known, is_interval(window), is_interval(stay)]
    yield Formula("the stay may lie outside the window", anywhere, right)
    longer = Interval(stay.start, stay.end - 1, stay.for_ever)
    wrong = same(free_after, held_by_parts(window, longer, tick))
    yield Formula("the second part begins a tick early", [*known, *_premises(window, stay, duration)], wrong)
    is_window = same(joined_parts(window, stay, tick), holds(window, tick))
    yield Formula("the parts are joined over a stay that was never in the window", anywhere, is_window)


LEMMA = Lemma(
    "Reserving a stay splits a window of capacity 1, and taking it back joins the parts",
    __doc__,
    ("window/free", "window/fits"),
    formulas,
    mutants,
)
