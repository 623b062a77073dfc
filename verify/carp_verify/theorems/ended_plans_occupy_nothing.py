"""A plan that has ended by the tick now occupies no resource at now or later.

The visits of a contiguous plan end no later than its last one, for any number of visits, by induction. So a robot that
is left alone because its plan has ended is in nobody's way.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, implies, integers, negation
from carp_verify.vocabulary import has_ended, holds, interval, is_interval


def _premises() -> Sequence[Bool]:
    """A visit that ends no later than the last one."""
    visit, last = interval("visit"), interval("last")
    return [is_interval(visit), is_interval(last), negation(visit.for_ever), visit.end <= last.end]


def lemmas() -> Iterator[Lemma]:
    """The visits before, and the last one."""
    visit, last = interval("visit"), interval("last")
    now, tick, leave, enter = integers("now tick leave enter")
    ended = [has_ended(last, now), tick >= now]
    yield Lemma("no visit holds a tick from now on", [*_premises(), *ended], negation(holds(visit, tick)))
    yield Lemma("the last visit holds no tick from now on", [is_interval(last), *ended], negation(holds(last, tick)))
    step = [is_interval(visit), leave <= visit.start, visit.end <= last.end, negation(visit.for_ever), enter < leave]
    yield Lemma("a visit before ends no later than the last either", step, leave <= last.end)


def mutants() -> Iterator[Lemma]:
    """Plans that have not ended."""
    visit, last = interval("visit"), interval("last")
    now, tick = integers("now tick")
    late = [*_premises(), last.end <= now + 1, negation(last.for_ever), tick >= now]
    yield Lemma("a plan ends one tick later", late, negation(holds(visit, tick)))
    parked = implies(tick >= now, negation(holds(last, tick)))
    yield Lemma("a plan that parks has ended", [is_interval(last), last.end <= now], parked)


THEOREM = Theorem("An ended plan occupies nothing", __doc__, ("fleet/history", "joint/capacity"), lemmas, mutants)
