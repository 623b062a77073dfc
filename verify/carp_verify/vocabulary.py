"""The words of the lemmas as terms: each stands for a function of carp_spec, and a test holds the two equal."""

from dataclasses import dataclass

from carp_verify.smt import Bool, Int, all_of, any_of, integer, negation, truth


@dataclass(frozen=True, slots=True)
class Interval:
    """The ticks [start, end), or from start on if it is for ever: an occupation or a window."""

    start: Int
    end: Int
    for_ever: Bool


def interval(name: str) -> Interval:
    """An interval about which nothing is known."""
    return Interval(integer(f"{name}.start"), integer(f"{name}.end"), truth(f"{name}.for_ever"))


def holds(interval: Interval, tick: Int) -> Bool:
    """Whether the tick is in the interval: `carp_spec.windows.occupancy` of one occupation."""
    return all_of(interval.start <= tick, any_of(interval.for_ever, tick < interval.end))


def lasts_until(window: Interval, tick: Int) -> Bool:
    """Whether a stay may end at the tick: `carp_spec.windows.Window.lasts_until`."""
    return any_of(window.for_ever, tick <= window.end)


def is_interval(interval: Interval) -> Bool:
    """Whether the interval has a tick and none before 0."""
    return all_of(interval.start >= 0, any_of(interval.for_ever, interval.start < interval.end))


def stay_fits(window: Interval, stay: Interval, duration: Int) -> Bool:
    """Whether the stay keeps `window/fits`: `carp_spec.windows.stay_fits`."""
    long_enough = any_of(stay.for_ever, stay.end - stay.start >= duration)
    ends_inside = any_of(window.for_ever, all_of(negation(stay.for_ever), stay.end <= window.end))
    return all_of(window.start <= stay.start, long_enough, ends_inside)


def has_ended(last: Interval, now: Int) -> Bool:
    """Whether a plan with this last visit has ended: `carp_spec.has_ended`."""
    return all_of(negation(last.for_ever), last.end <= now)
