"""A robot under way that may leave its current visit from max(enter + d, now) on keeps its history and its duration.

The visit is entered at the same tick as before and left no earlier than now, as `fleet/history` wants, and it lasts at
least the duration. No earlier leave does both, so nothing is lost. This is the arithmetic of a maximum, and no more.

By hand: that the visits before the current one are kept, which a query does not touch. The formula is a copy of what
the reference does, and a test holds the two equal on small numbers.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import Bool, Int, all_of, greater, integers


def may_leave_from(enter: Int, duration: Int, now: Int) -> Int:
    """The tick from which the robot may leave the visit in which it is."""
    return greater(enter + duration, now)


def keeps_history(leave: Int, now: Int) -> Bool:
    """Whether the current visit, entered as before, keeps `fleet/history`."""
    return leave >= now


def _premises() -> Sequence[Bool]:
    enter, duration, now = integers("enter duration now")
    return [enter >= 0, duration >= 1, enter <= now]


def _both(leave: Int) -> Bool:
    enter, duration, now = integers("enter duration now")
    return all_of(keeps_history(leave, now), leave - enter >= duration)


def formulas() -> Iterator[Formula]:
    """It is enough, and no more than enough."""
    enter, duration, now, leave = integers("enter duration now leave")
    from_then_on = leave >= may_leave_from(enter, duration, now)
    yield Formula("every leave from then on keeps both rules", [*_premises(), from_then_on], _both(leave))
    yield Formula("every leave that keeps both rules is from then on", [*_premises(), _both(leave)], from_then_on)


def mutants() -> Iterator[Formula]:
    """Half of the formula."""
    enter, duration, now, leave = integers("enter duration now leave")
    yield Formula("the robot may leave in the past", [*_premises(), leave >= enter + duration], _both(leave))
    yield Formula("the robot may leave at once", [*_premises(), leave >= now], _both(leave))


LEMMA = Lemma("A robot under way keeps its history", __doc__, ("fleet/history", "plan/duration"), formulas, mutants)
