"""A plan that has ended by the tick now occupies no resource at now or later, so it is in nobody's way.

z3 checks that a visit that ends no later than the last one holds no tick from now on, and that a visit before such a
one ends no later than the last either.

By hand: the induction over the visits of a contiguous plan, from the last one to the first.
"""

from collections.abc import Iterator, Sequence

from carp_verify.lemmas.engine import Formula, Lemma
from carp_verify.lemmas.smt import Bool, implies, integers, negation
from carp_verify.lemmas.vocabulary import has_ended, holds, interval, is_interval


def _premises() -> Sequence[Bool]:
    """A visit that ends no later than the last one."""
    visit, last = interval("visit"), interval("last")
    return [is_interval(visit), is_interval(last), negation(visit.for_ever), visit.end <= last.end]


def formulas() -> Iterator[Formula]:
    """The visits of the plan, and the step from one visit to the one before."""
    visit, last = interval("visit"), interval("last")
    now, tick, leave = integers("now tick leave")
    ended = [has_ended(last, now), tick >= now]
    yield Formula("no visit holds a tick from now on", [*_premises(), *ended], negation(holds(visit, tick)))
    step = [is_interval(visit), leave <= visit.start, visit.end <= last.end, negation(visit.for_ever)]
    yield Formula("a visit before ends no later than the last either", step, leave <= last.end)


def mutants() -> Iterator[Formula]:
    """Plans that have not ended."""
    visit, last = interval("visit"), interval("last")
    now, tick = integers("now tick")
    late = [*_premises(), last.end <= now + 1, negation(last.for_ever), tick >= now]
    yield Formula("a plan ends one tick later", late, negation(holds(visit, tick)))
    parked = implies(tick >= now, negation(holds(last, tick)))
    yield Formula("a plan that parks has ended", [is_interval(last), last.end <= now], parked)


LEMMA = Lemma("An ended plan occupies nothing", __doc__, ("fleet/history", "joint/capacity"), formulas, mutants)
