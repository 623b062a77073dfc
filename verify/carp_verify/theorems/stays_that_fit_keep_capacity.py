"""A stay that fits into a free window keeps the capacity of its resource, together with the committed plans.

The window holds only free ticks; a stay that keeps `window/fits` lies in its window; so at no tick of it is the
resource full already. With that the plan of a query keeps `joint/capacity`, which is part of `query/sound`.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, counted, implies, integers
from carp_verify.vocabulary import holds, interval, is_interval, stay_fits


def _premises() -> Sequence[Bool]:
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity = integers("tick occupancy capacity")
    free = implies(holds(window, tick), occupancy < capacity)
    return [is_interval(window), is_interval(stay), capacity >= 1, occupancy >= 0, occupancy <= capacity, free]


def lemmas() -> Iterator[Lemma]:
    """The occupancy with the stay, at any tick."""
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity, duration = integers("tick occupancy capacity duration")
    kept = occupancy + counted(holds(stay, tick)) <= capacity
    yield Lemma("no tick gets too full", [*_premises(), stay_fits(window, stay, duration)], kept)


def mutants() -> Iterator[Lemma]:
    """Stays that do not fit."""
    window, stay = interval("window"), interval("stay")
    tick, occupancy, capacity = integers("tick occupancy capacity")
    kept = occupancy + counted(holds(stay, tick)) <= capacity
    yield Lemma("only the beginning of the stay lies in the window", [*_premises(), holds(window, stay.start)], kept)


THEOREM = Theorem(
    "A stay that fits keeps the capacity", __doc__, ("window/fits", "joint/capacity", "query/sound"), lemmas, mutants
)
