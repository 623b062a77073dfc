"""Finds a good lower bound on the total cost, with a certificate that `carp_verify.bound.verify` checks.

This is Lagrangian relaxation. Step by step, prices rise where the robots' cheapest ways exceed a capacity, and fall
where they use less than it (`carp_optimum.lagrangian.price_steps`). When that gains nothing more, deadlines are added
(`carp_optimum.claims.pair_search`, `carp_optimum.claims.deadline_search`). The search aims a little above the best
bound known, and closer to it after each failure. Source: the target level method of Goffin and Kiwiel 1999, over the
Lagrangian relaxation of all rules of plans together.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from time import monotonic_ns
from typing import TYPE_CHECKING

from carp_optimum.sat.solver import Deadline, TimeOver
from carp_spec import Instance
from carp_spec.documents.bounds import BOUND_FORMAT, BoundDocument
from carp_spec.documents.instances import digest
from carp_spec.inputs.options import BOUND_SECONDS, require_limits
from carp_spec.inputs.values import require_instance
from carp_spec.limits import goals_stand_alone

if TYPE_CHECKING:
    from carp_optimum.lagrangian.price_search import PriceSearch

SCALE = 1 << 16
FIRST_AIM, NEXT_AIM, FINAL_AIM = 10, 50, 1024
"""Parts of the best bound: the largest aims at the beginning, after new claims, and when all claims are proved."""
LARGE_AIM, LARGE_FIRST = SCALE << 4, 100
"""A first aim above `LARGE_AIM` is one of `LARGE_FIRST` parts of the bound instead, but no less than `LARGE_AIM`."""
ROUGH_AIM = SCALE >> 4
LARGE = 16384  # parts of the best bound: the last aim before new claims, where that is more than the rough one
FINE_AIM = SCALE >> 10
LEAST_RISE = 500  # one part of the bound: what sights must raise it by to be searched for again at once
FIRST_PARTS, ROUGH_PARTS, PROVED_PARTS, PARTS = 1, 13, 15, 16
"""Parts of the time: prices climb alone, claims are searched for, the last ones are proved, prices alone are refined.

On a spanning tree prices alone still climb after a quarter of a minute, but with claims they climb faster.
"""
WAYS_AT_END = 3
"""How often the ways of all robots are still looked for when the time is over, so that it is over before."""


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of the search: steps taken, and the best bound so far, in whole ticks.

    The bound may count claims that are not proved yet, and fall if one of them has no short proof.
    """

    steps: int
    bound: int


def lower_bound(
    instance: Instance,
    seconds: float | None = None,
    steps: int | None = None,
    on_step: Callable[[Progress], None] = lambda _: None,
    clock: Callable[[], int] = monotonic_ns,
    seen: bool = True,
) -> BoundDocument:
    """Search for this many seconds or steps, whichever is over first, or until nothing is gained any more.

    Without a limit the search takes 10 seconds.
    With steps alone, the same instance gives the same certificate. `on_step` is called after each step, and now and
    then while claims are searched for; `clock` gives nanoseconds. `seen` is whether robots with deadlines may be seen
    at ticks, for which the search for an optimum has no literals. Over stops, cuts alone are searched for. Raises
    `Refusal` for numbers that are too large.
    """
    require_instance(instance)
    require_limits(seconds=seconds, steps=steps)
    seconds = BOUND_SECONDS if seconds is None and steps is None else seconds
    if goals_stand_alone(instance):
        return _by_prices(instance, seconds, steps, on_step, clock, seen=seen)
    from carp_optimum.claims.disjoint_cuts import bound_by_cuts  # noqa: PLC0415 - it loads a solver

    check = _limit(seconds, steps, PARTS, clock)
    return bound_by_cuts(instance, check, lambda count, bound: on_step(Progress(count, bound)))


def _by_prices(
    instance: Instance,
    seconds: float | None,
    steps: int | None,
    on_step: Callable[[Progress], None],
    clock: Callable[[], int],
    *,
    seen: bool,
) -> BoundDocument:
    """The bound of robots with goals alone."""
    from carp_optimum.claims.deadline_search import DeadlineSearch  # noqa: PLC0415 - numba is slow to load
    from carp_optimum.claims.pair_search import SightSearch  # noqa: PLC0415
    from carp_optimum.lagrangian.price_search import PriceSearch  # noqa: PLC0415

    first = _limit(seconds, steps, FIRST_PARTS, clock)
    rough = _limit(seconds, steps, ROUGH_PARTS, clock)
    proved = _limit(seconds, None, PROVED_PARTS, clock)
    end = _limit(seconds, steps, PARTS, clock, lambda: WAYS_AT_END * search.longest)
    search = PriceSearch(instance, SCALE, clock)
    search.within = lambda: end(0)
    deadlines = DeadlineSearch(search)
    sights = SightSearch(search)

    def report() -> None:
        on_step(Progress(search.count, -(-search.best // SCALE)))

    def look() -> None:
        report()
        rough(search.count)

    def watch() -> None:
        report()
        sights.watch(look)

    def prove() -> None:
        with suppress(TimeOver):
            sights.prove(lambda: proved(0))

    def last_aim() -> int:
        return max(ROUGH_AIM, search.best // LARGE)

    def gain_of_sights() -> int:
        return min(sights.round(look), search.best // NEXT_AIM) if seen else 0

    report()
    with suppress(TimeOver):
        gain = min(search.best // FIRST_AIM, max(search.best // LARGE_FIRST, LARGE_AIM))
        if seen:
            with suppress(TimeOver):
                search.climb(gain, last_aim(), lambda: first(search.count), report)
        by_sights = gain_of_sights()
        while gain > 0:
            before = search.best
            if by_sights > 0:
                search.roam(by_sights // 4, last_aim(), lambda: rough(search.count), watch)
            search.climb(by_sights or gain, last_aim(), lambda: rough(search.count), report)
            prove()
            fruitless = by_sights > 0 and (search.best - before) * LEAST_RISE < search.best
            by_sights = 0 if fruitless else gain_of_sights()
            gain = by_sights or min(deadlines.round(look), search.best // NEXT_AIM)
    prove()
    with suppress(TimeOver):
        search.climb(max(ROUGH_AIM, search.best // FINAL_AIM), FINE_AIM, lambda: end(search.count), report)
    search.restore()
    return _certificate(search)


def _limit(
    seconds: float | None,
    steps: int | None,
    parts: int,
    clock: Callable[[], int],
    ahead: Callable[[], int] = lambda: 0,
) -> Callable[[int], None]:
    """A function of the steps taken that raises `TimeOver` once this part of the time, or of the steps, is over.

    The time is over that many nanoseconds ahead of its end.
    """
    deadline = None if seconds is None else Deadline(seconds * parts / PARTS, clock)

    def check(count: int) -> None:
        if deadline is not None:
            deadline.check(ahead())
        if steps is not None and count >= steps * parts // PARTS:
            raise TimeOver

    return check


def _certificate(search: "PriceSearch") -> BoundDocument:
    """What the prices prove in the steps that the checker takes; the sum of shortest ways where that is more."""
    from carp_optimum.lagrangian.price_search import PriceLists  # noqa: PLC0415 - numba is slow to load

    prices, priced, robots = search.prices(), search.priced_deadlines(), search.least_costs()
    parts = sum(least or 0 for _, least in robots) - int(search.dual.prices.worth[0])
    parts -= sum(each.price * (len(each.robots) - 1) for each in priced)
    shortest = search.shortest_costs()
    sure = sum(least or 0 for _, least in shortest)
    if parts < sure:
        prices, priced, robots, parts = PriceLists((), (), ()), (), shortest, sure
    return BoundDocument(
        format=BOUND_FORMAT,
        instance=digest(search.instance),
        bound=-(-parts // SCALE),
        scale=SCALE,
        horizon=search.horizon,
        resources=prices.resources,
        exchanges=prices.exchanges,
        cuts=(),
        robots=robots,
        deadlines=priced,
        groups=prices.groups,
    )
