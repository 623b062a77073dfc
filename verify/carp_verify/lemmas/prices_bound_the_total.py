"""Weak duality: with prices on resources, cheapest priced plans bound the total cost of all plan sets from below.

This is Lagrangian relaxation. Each pair of a resource and a tick has a price of at least 0, and so has each exchange of
a resource r with another one at a tick. The price of an exchange is paid by the robots that make one of the two
opposite moves then, and by those that are in r before and at the tick; together they are no more than the capacity of
r. Let m(i) be the least of cost plus prices over all plans of robot i alone. Then every set of plans that keeps the
rules costs at least the sum of all m(i), minus the sum of price times capacity over all pairs. A cut is a group of
robots whose costs are known to add up to a least total; a part of their costs is counted in m(i) and the other part by
the cut.

By hand: the inductions over robots, pairs and cuts, which add inequalities of these kinds; and that m(i), being the
least, is at most what robot i costs and pays in any plan set. Tests check that the verifier lets robots pay by these
formulas, and compare the least costs that it finds with all plans of small instances.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, any_of, between, choose, counted, equal, integers, truth

FEW = 5


def paid(occupies: Bool, price: Int) -> Int:
    """The payment of one robot for one pair of resource and tick."""
    return choose(occupies, price, 0)


def at_most_paid(price: Int, capacity: Int) -> Int:
    """The most that all robots together pay for one pair."""
    return price * capacity


def in_exchange(leaving: Int, coming: Int, staying: Int) -> Int:
    """The number of robots that pay for an exchange of r with s: those that make a move, and those that stay in r."""
    return leaving + coming + staying


def _exchange() -> Sequence[Bool]:
    """Numbers of robots that keep the capacity of r just before the tick and at it."""
    leaving, coming, staying, capacity = integers("leaving coming staying capacity")
    counts = [leaving >= 0, coming >= 0, staying >= 0]
    return [*counts, leaving + staying <= capacity, coming + staying <= capacity]


def _pair() -> Sequence[Bool]:
    """The payment for one pair that keeps its capacity: price times occupants."""
    price, occupants, capacity, payments = integers("price occupants capacity payments")
    return [occupants >= 0, occupants <= capacity, equal(payments, price * occupants)]


def _sums() -> Sequence[Bool]:
    """The costs and payments of all robots, the sum of their least priced costs, and the most that can be paid."""
    costs, payments, least, most = integers("costs payments least most")
    return [costs + payments >= least, payments <= most]


def formulas() -> Iterator[Formula]:
    """Payments counted by pairs and by robots, the bound of each, and the two together."""
    price, occupants, capacity, payments = integers("price occupants capacity payments")
    occupies = truth("occupies")
    more = equal(payments + paid(occupies, price), price * (occupants + counted(occupies)))
    yield Formula("a robot more pays as much as an occupant more is worth", [equal(payments, price * occupants)], more)
    pair = [*_pair(), price >= 0]
    yield Formula(
        "for a pair no more is paid than price times capacity", pair, payments <= at_most_paid(price, capacity)
    )
    leaving, coming, staying = integers("leaving coming staying")
    one_way = any_of(equal(leaving, 0), equal(coming, 0))
    few = in_exchange(leaving, coming, staying) <= capacity
    yield Formula("an exchange is paid by no more robots than the capacity", [*_exchange(), one_way], few)
    together, total, multiplier, scale = integers("together total multiplier scale")
    cut = [together >= total, multiplier >= 0, multiplier <= scale]
    split = (scale - multiplier) * together + multiplier * total <= scale * together
    yield Formula("a cut counts no more than the part of the costs that it stands for", cut, split)
    costs, least, most = integers("costs least most")
    yield Formula("the total is at least the bound", _sums(), costs >= least - most)


def mutants() -> Iterator[Formula]:
    """Prices and capacities that bound nothing; where there are products, in a small instance."""
    price, occupants, capacity, payments = integers("price occupants capacity payments")
    bounded = payments <= at_most_paid(price, capacity)
    small = [between(1, capacity, FEW), occupants < FEW]
    negative = [*_pair(), *small, between(1 - FEW, price, 0)]
    yield Formula("a price is negative (numbers below 5)", negative, bounded)
    full = [occupants >= 0, equal(payments, price * occupants), *small, between(0, price, FEW)]
    yield Formula("the capacity is not kept (numbers below 5)", full, bounded)
    leaving, coming, staying = integers("leaving coming staying")
    few = in_exchange(leaving, coming, staying) <= capacity
    yield Formula("robots make both moves of an exchange", _exchange(), few)
    together, total, multiplier, scale = integers("together total multiplier scale")
    cut = [between(0, together, FEW), between(0, total, FEW), together >= total, between(-FEW, multiplier, 0)]
    split = (scale - multiplier) * together + multiplier * total <= scale * together
    yield Formula("a multiplier is negative (numbers below 5)", [*cut, equal(scale, 1)], split)
    costs, least, most = integers("costs least most")
    yield Formula("the worth of the capacities is added", _sums(), costs >= least + most)


LEMMA = Lemma(
    "Prices of resources bound the total cost",
    __doc__,
    ("cost/total", "joint/capacity", "joint/exchange"),
    formulas,
    mutants,
)
