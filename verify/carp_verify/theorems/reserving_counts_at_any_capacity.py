"""At any capacity, reserving a stay takes exactly those of its ticks at which one robot more fills the resource.

The other ticks are as free as they were: a tick is free afterwards if it was free, and if it is in the stay, then room
for two was there. So free windows only shrink when a stay is reserved, and only inside the stay.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, Int, all_of, any_of, counted, implies, integer, integers, negation, same
from carp_verify.vocabulary import holds, interval, is_interval


def is_free(occupancy: Int, capacity: Int) -> Bool:
    """Whether a tick with this occupancy is in a free window: `window/free`."""
    return occupancy < capacity


def free_after(occupancy: Int, capacity: Int, in_stay: Bool) -> Bool:
    """Whether a tick is free once a stay is reserved, told from before."""
    return all_of(is_free(occupancy, capacity), any_of(negation(in_stay), is_free(occupancy + 1, capacity)))


def _premises(occupancy: Int, capacity: Int) -> Sequence[Bool]:
    return [is_interval(interval("stay")), occupancy >= 0, capacity >= 1]


def lemmas() -> Iterator[Lemma]:
    """The ticks that are free afterwards, and that windows only shrink."""
    occupancy, capacity = integers("occupancy capacity")
    in_stay = holds(interval("stay"), integer("tick"))
    after = is_free(occupancy + counted(in_stay), capacity)
    premises = _premises(occupancy, capacity)
    yield Lemma(
        "counting frees the ticks that stay free", premises, same(after, free_after(occupancy, capacity, in_stay))
    )
    unchanged = all_of(
        implies(after, is_free(occupancy, capacity)),
        implies(negation(in_stay), same(after, is_free(occupancy, capacity))),
    )
    yield Lemma("windows only shrink, and only inside the stay", premises, unchanged)


def mutants() -> Iterator[Lemma]:
    """Splitting where counting is needed."""
    occupancy, capacity = integers("occupancy capacity")
    in_stay = holds(interval("stay"), integer("tick"))
    after = is_free(occupancy + counted(in_stay), capacity)
    split = all_of(is_free(occupancy, capacity), negation(in_stay))
    premises = _premises(occupancy, capacity)
    yield Lemma("the stay is cut out at any capacity", premises, same(after, split))
    late = all_of(is_free(occupancy, capacity), any_of(negation(in_stay), is_free(occupancy, capacity)))
    yield Lemma("a resource is full only beyond its capacity", premises, same(after, late))


THEOREM = Theorem("Reserving a stay counts at any capacity", __doc__, ("window/free",), lemmas, mutants)
