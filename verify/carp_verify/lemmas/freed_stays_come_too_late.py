"""A query whose plan is there before anything can come of freed stays returns the same plan again.

Stays of s in [earliest, latest) are taken back. From a resource expanded at the tick `ready`, the robot enters s in a
new way, or leaves s in a new way, only with a stay that holds a freed tick; what comes of it has an f of at least
max(ready, earliest - d(s)) + h(s), and nothing comes of it if latest <= ready. If that f is above the arrival of the
plan found, the search ends before it sees a difference. An exchange freed with the stays is a new way too: at its tick
the robot taken back left s for the resource expanded, and where it is not after `ready`, the robot taken back stood in
the way of waiting there, so that the resource expanded counts as freed itself.

By hand: that every difference between the two searches begins with such an entry, leave or exchange, if the goal is
free for ever from the same tick on, so that the same windows come first (`query/ties`); and that the f of what follows
from it is no less than its own, by induction over expansions, as h(r) <= d(r) + h(s) for each move. Tests compare
searches before and after stays are freed on small graphs, and notice a bound that is larger by one.
"""

from collections.abc import Iterator, Sequence

from carp_verify.lemmas.engine import Formula, Lemma
from carp_verify.lemmas.smt import Bool, Int, any_of, between, equal, greater, integers, negation


def least_f(ready: Int, earliest: Int, duration: Int, h: Int) -> Int:
    """The least f of what comes of a freed stay."""
    return greater(ready, earliest - duration) + h


def is_too_late(ready: Int, earliest: Int, latest: Int, duration: Int, h: Int, arrival: Int) -> Bool:
    """Whether nothing can come, before the arrival, of a stay freed in [earliest, latest)."""
    return any_of(latest <= ready, least_f(ready, earliest, duration, h) > arrival)


def _new_stay() -> Sequence[Bool]:
    """A stay from `enter` to `leave`, at least a duration long, that holds a tick that was freed."""
    enter, leave, ready, duration, tick, earliest, latest = integers("enter leave ready duration tick earliest latest")
    is_stay = [duration >= 1, enter >= ready, leave >= enter + duration]
    return [*is_stay, between(earliest, tick, latest), between(enter, tick, leave)]


def formulas() -> Iterator[Formula]:
    """New entries, new leaves, ticks that are over, and exchanges."""
    enter, leave, ready, duration, earliest, latest = integers("enter leave ready duration earliest latest")
    h, h_after, arrival, exchange, tick = integers("h h_after arrival exchange tick")
    shortest = h <= duration + h_after
    bound = least_f(ready, earliest, duration, h)
    entered = [*_new_stay(), equal(leave, enter + duration)]
    yield Formula("a new entry has an f of at least the bound", entered, enter + h >= bound)
    yield Formula("a new leave has an f of at least the bound", [*_new_stay(), shortest], leave + h_after >= bound)
    over = [duration >= 1, enter >= ready, latest <= ready, between(earliest, tick, latest)]
    yield Formula("a stay from ready on holds no tick freed before", over, negation(between(enter, tick, leave)))
    late = [enter + h >= bound, is_too_late(ready, earliest, latest, duration, h, arrival), latest > ready]
    yield Formula("what has an f of at least the bound is expanded after the goal", late, enter + h > arrival)
    moved = [duration >= 1, between(earliest + 1, exchange, latest + 1), exchange >= ready]
    yield Formula("a freed exchange has an f of at least the bound", moved, exchange + h >= bound)
    here, h_here, at = integers("duration_here h_here entered_here")
    waits = [here >= 1, equal(ready, at + here), equal(exchange, ready), at + h_here <= arrival]
    seen = least_f(at, exchange, here, h_here) <= arrival
    yield Formula("an exchange freed at ready is seen from the resource before", waits, seen)


def mutants() -> Iterator[Formula]:
    """Bounds that are too large."""
    enter, leave, ready, duration, earliest = integers("enter leave ready duration earliest")
    h, h_after = integers("h h_after")
    entered = [*_new_stay(), equal(leave, enter + duration)]
    too_large = greater(ready, earliest) + h
    yield Formula("the robot cannot enter before the freed stay begins", entered, enter + h >= too_large)
    bound = least_f(ready, earliest, duration, h)
    yield Formula("h is not consistent", _new_stay(), leave + h_after >= bound)
    anywhere = [duration >= 1, enter >= ready, leave >= enter + duration]
    yield Formula("the new stay holds no freed tick", anywhere, enter + h >= bound)


LEMMA = Lemma(
    "Freed stays that come too late change no plan",
    __doc__,
    ("neighbourhood/replan", "query/optimal", "query/ties"),
    formulas,
    mutants,
)
