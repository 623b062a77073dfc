"""The words of the lemmas as terms, derived from the functions of carp_spec."""

from dataclasses import dataclass

from carp_spec import Plan, Visit, neighbourhood_rules, plan_rules, windows
from carp_verify.lemmas.derivation import Way, derived
from carp_verify.lemmas.smt import Bool, Int, all_of, any_of, integer, truth


@dataclass(frozen=True, slots=True)
class Interval:
    """The ticks [start, end), or from start on if it is for ever: an occupation or a window."""

    start: Int
    end: Int
    for_ever: Bool

    def ticks(self, way: Way) -> tuple[int, int | None]:
        """Its start and its end as arguments of a function."""
        return way.number(self.start), way.number_unless(self.for_ever, self.end)


def interval(name: str) -> Interval:
    """An interval about which nothing is known."""
    return Interval(integer(f"{name}.start"), integer(f"{name}.end"), truth(f"{name}.for_ever"))


def is_interval(interval: Interval) -> Bool:
    """Whether the interval has a tick and none before 0."""
    return all_of(interval.start >= 0, any_of(interval.for_ever, interval.start < interval.end))


def holds(interval: Interval, tick: Int) -> Bool:
    """Whether the tick is in the interval: `carp_spec.windows.occupancy` of one occupation."""
    return derived(lambda way: windows.occupancy([interval.ticks(way)], way.number(tick)))


def stay_fits(window: Interval, stay: Interval, duration: Int) -> Bool:
    """Whether the stay keeps `window/fits`: `carp_spec.windows.stay_fits`."""

    def fits(way: Way) -> bool:
        return windows.stay_fits(windows.Window(*window.ticks(way)), *stay.ticks(way), way.number(duration))

    return derived(fits)


def has_ended(last: Interval, now: Int) -> Bool:
    """Whether a plan with this last visit has ended: `carp_spec.plan_rules.has_ended`."""

    def ended(way: Way) -> bool:
        return plan_rules.has_ended(Plan("robot", (Visit("goal", *last.ticks(way)),)), way.number(now))

    return derived(ended)


def replaces_best(cost: Int, best: Int) -> Bool:
    """Whether a candidate of that cost replaces the best: the predicate of `neighbourhood/best`."""
    return derived(lambda way: neighbourhood_rules.replaces_best(way.number(cost), way.number(best)))
