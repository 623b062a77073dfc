"""Weak duality: with prices on resources, cheapest priced plans bound the total cost of all plan sets from below.

Let each pair of a resource and a tick (and each pair of opposite moves at a tick, with capacity 1) have a price of at
least 0, and let m(i) be the least of cost plus prices over all plans of robot i alone. Then every set of plans that
keeps the capacities costs at least the sum of all m(i), minus the sum of price times capacity over all pairs.
For any number of robots and of pairs, by induction: over robots for the two ways of counting what they pay, over
pairs for what is paid at most.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, Int, between, choose, counted, equal, integers, truth

FEW = 5


def paid(occupies: Bool, price: Int) -> Int:
    """What one robot pays for one pair of resource and tick."""
    return choose(occupies, price, 0)


def at_most_paid(price: Int, capacity: Int) -> Int:
    """What all robots together pay at most for one pair."""
    return price * capacity


def _pair() -> Sequence[Bool]:
    """What is paid for one pair that keeps its capacity: price times occupants."""
    price, occupants, capacity, payments = integers("price occupants capacity payments")
    return [occupants >= 0, occupants <= capacity, equal(payments, price * occupants)]


def _sums() -> Sequence[Bool]:
    """The costs and payments of all robots, the sum of their least priced costs, and what can be paid at most."""
    costs, payments, least, most = integers("costs payments least most")
    return [costs + payments >= least, payments <= most]


def lemmas() -> Iterator[Lemma]:
    """Payments counted by pairs and by robots, the bound of each, and the two together."""
    price, occupants, capacity, payments = integers("price occupants capacity payments")
    occupies = truth("occupies")
    more = equal(payments + paid(occupies, price), price * (occupants + counted(occupies)))
    yield Lemma("a robot more pays as much as an occupant more is worth", [equal(payments, price * occupants)], more)
    pair = [*_pair(), price >= 0]
    yield Lemma("for a pair no more is paid than price times capacity", pair, payments <= at_most_paid(price, capacity))
    costs, least, most, cost, own, priced, worth = integers("costs least most cost own priced worth")
    robot = [costs + payments >= least, cost + own >= priced]
    claim = (costs + cost) + (payments + own) >= least + priced
    yield Lemma("a robot more keeps costs and payments above the least ones", robot, claim)
    pairs = [payments <= most, own <= worth]
    yield Lemma("a pair more keeps payments below the most", pairs, payments + own <= most + worth)
    yield Lemma("the total is at least the bound", _sums(), costs >= least - most)


def mutants() -> Iterator[Lemma]:
    """Prices and capacities that bound nothing; where there are products, in a small instance."""
    price, occupants, capacity, payments = integers("price occupants capacity payments")
    bounded = payments <= at_most_paid(price, capacity)
    small = [between(1, capacity, FEW), occupants < FEW]
    negative = [*_pair(), *small, between(1 - FEW, price, 0)]
    yield Lemma("a price is negative (numbers below 5)", negative, bounded)
    full = [occupants >= 0, equal(payments, price * occupants), *small, between(0, price, FEW)]
    yield Lemma("the capacity is not kept (numbers below 5)", full, bounded)
    costs, least, most = integers("costs least most")
    yield Lemma("the worth of the capacities is added", _sums(), costs >= least + most)


THEOREM = Theorem(
    "Prices of resources bound the total cost",
    __doc__,
    ("cost/total", "joint/capacity", "joint/exchange"),
    lemmas,
    mutants,
)
