"""A stay that fits into a free window keeps the capacity of its resource, together with the committed plans.

The window holds only free ticks; a stay that keeps `window/fits` lies in its window; so at no tick of it is the
resource full already. With that the plan of a query keeps `joint/capacity`, which is part of `query/sound`.

By hand: the step from one stay to all stays of a plan. It needs that a plan is in one resource at a time, as
`plan/contiguous` says, so that no tick of a resource gets two stays of the plan. z3 checks a single tick.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, counted, implies, integer, integers
from carp_verify.vocabulary import holds, interval, is_interval, stay_fits


def _premises() -> Sequence[Bool]:
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity = integers("tick occupancy capacity")
    free = implies(holds(window, tick), occupancy < capacity)
    return [is_interval(window), is_interval(stay), capacity >= 1, occupancy >= 0, occupancy <= capacity, free]


def formulas() -> Iterator[Formula]:
    """The occupancy with the stay, at any tick."""
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity, duration = integers("tick occupancy capacity duration")
    kept = occupancy + counted(holds(stay, tick)) <= capacity
    yield Formula("no tick gets too full", [*_premises(), stay_fits(window, stay, duration)], kept)


def mutants() -> Iterator[Formula]:
    """Stays that do not fit, and windows with room for nobody."""
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity = integers("tick occupancy capacity")
    kept = occupancy + counted(holds(stay, tick)) <= capacity
    yield Formula("only the beginning of the stay lies in the window", [*_premises(), holds(window, stay.start)], kept)
    *rest, _ = _premises()
    fits = stay_fits(window, stay, integer("duration"))
    yield Formula("a tick of the window may be full", [*rest, fits], kept)


LEMMA = Lemma(
    "A stay that fits keeps the capacity", __doc__, ("window/fits", "joint/capacity", "query/sound"), formulas, mutants
)
