"""The tick at which a query enters a window is the least allowed one, and if it is too late none exists.

The search begins at the later of the tick from which the robot may leave and the window's start, and continues one tick
at a time while a committed robot makes the opposite move at the tick (`joint/exchange`). Its invariant: every tick
before the one looked at is too early, or an exchange. z3 checks that it holds at the beginning, that a step keeps it,
and what it gives at the end.

By hand: the induction over exchanges, and that the search ends, as there are finitely many. The formulas are copies of
what the reference does, and a test holds the two equal on small windows.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, all_of, any_of, greater, implies, integer, integers, negation, never, predicate
from carp_verify.vocabulary import Interval, interval, is_interval, lasts_until, stay_fits

exchange = predicate("exchange")


def first_candidate(ready: Int, window: Interval) -> Int:
    """Where the search begins."""
    return greater(ready, window.start)


def may_enter(ready: Int, left: Interval, entered: Interval, duration: Int, tick: Int) -> Bool:
    """Whether a robot ready to leave one window may enter another at the tick, exchanges aside."""
    stay = Interval(tick, tick + duration, never())
    return all_of(tick >= ready, lasts_until(left, tick), stay_fits(entered, stay, duration))


def _allowed(tick: Int) -> Bool:
    ready, duration = integers("ready duration")
    entering = may_enter(ready, interval("left"), interval("entered"), duration, tick)
    return all_of(entering, negation(exchange(tick)))


def _premises() -> Sequence[Bool]:
    ready, duration = integers("ready duration")
    return [is_interval(interval("left")), is_interval(interval("entered")), duration >= 1, ready >= 0]


def _skipped(looked_at: Int, start: Int) -> Bool:
    """The invariant, said of any other tick."""
    other = integer("other")
    return implies(other < looked_at, any_of(other < start, exchange(other)))


def formulas() -> Iterator[Formula]:
    """The beginning, the step and the end of the search; `other` is any tick."""
    looked_at, other, ready = integers("looked_at other ready")
    start = first_candidate(ready, interval("entered"))
    yield Formula("at the beginning every tick before is too early", _premises(), _skipped(start, start))
    step = [*_premises(), _skipped(looked_at, start), exchange(looked_at)]
    yield Formula("a step skips nothing but an exchange", step, _skipped(looked_at + 1, start))
    end = [*_premises(), _skipped(looked_at, start), negation(exchange(looked_at)), looked_at >= start]
    yield Formula("no allowed tick is earlier", end, implies(_allowed(other), other >= looked_at))
    none = implies(negation(_allowed(looked_at)), negation(_allowed(other)))
    yield Formula("if the tick found is not allowed, none is", end, none)


def mutants() -> Iterator[Formula]:
    """Searches that skip a tick, begin late, or do not see exchanges."""
    looked_at, other, ready = integers("looked_at other ready")
    start = first_candidate(ready, interval("entered"))
    step = [*_premises(), _skipped(looked_at, start), exchange(looked_at)]
    yield Formula("a step goes two ticks", step, _skipped(looked_at + 2, start))
    late = [*_premises(), _skipped(looked_at, start + 1), negation(exchange(looked_at)), looked_at >= start + 1]
    yield Formula("the search begins a tick late", late, implies(_allowed(other), other >= looked_at))
    unseen = [*_premises(), _skipped(looked_at, start), looked_at >= start]
    none = implies(negation(_allowed(looked_at)), negation(_allowed(other)))
    yield Formula("the search stops at an exchange", unseen, none)


LEMMA = Lemma(
    "The entry into a window is the least allowed tick",
    __doc__,
    ("query/optimal", "query/complete", "joint/exchange", "window/fits"),
    formulas,
    mutants,
)
