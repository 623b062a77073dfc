"""Finds a good lower bound on the total cost, with a certificate that `carp_verify.bound.verify` checks.

This is Lagrangian relaxation. Where robots are few or their ways are short, a linear programme gives the best prices
(`carp_optimum.lagrangian.column_generation`). Elsewhere prices rise step by step where the robots' cheapest ways exceed
a capacity, and fall where they use less than it (`carp_optimum.lagrangian.price_steps`). When that gains nothing more,
deadlines are added (`carp_optimum.claims.pair_search`, `carp_optimum.claims.deadline_search`). The steps aim a little
above the best bound known, and closer to it after each failure. Source: the target level method of Goffin and Kiwiel
1999, over the Lagrangian relaxation of all rules of plans together.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from time import monotonic_ns
from typing import TYPE_CHECKING, NamedTuple

from carp_optimum.deadline import Deadline, TimeOver
from carp_spec import Instance
from carp_spec.documents.bounds import BOUND_FORMAT, BoundDocument, DeadlinesDocument
from carp_spec.documents.instances import digest
from carp_spec.inputs.options import BOUND_SECONDS, require_limits
from carp_spec.inputs.values import require_instance
from carp_spec.limits import goals_stand_alone

if TYPE_CHECKING:
    from carp_optimum.claims.deadline_search import DeadlineSearch
    from carp_optimum.claims.pair_search import SightSearch
    from carp_optimum.lagrangian.column_generation import ColumnGeneration
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
STEP_PARTS, PROGRAMME_PARTS, PARTS = (2, 26, 30), (6, 29, 31), 32
"""Parts of the time: prices climb alone, claims are searched for, the last ones are proved, prices alone are refined.

The first are those of steps, the second those of a linear programme, which is given up if it is not solved in its first
part. On a spanning tree prices alone still climb by steps after a quarter of a minute, but with claims faster.
"""
MOST_TICKS = 15_000
"""Robots times the ticks of prices, beyond which it is not tried to solve a linear programme."""
LEAST_GAIN = SCALE >> 1
"""Where a round's claims raise the bound by less, groups of robots and claims about more ticks are looked at too."""
IDLE_GAIN, IDLE_ROUNDS = SCALE >> 4, 6  # rounds that gain less, one after the other, end the search for claims
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
    enough: int | None = None,
) -> BoundDocument:
    """Search for this many seconds or steps, whichever is over first, or until nothing is gained any more.

    No claims are searched for once the bound is `enough`.
    Without a limit the search takes 10 seconds.
    With steps alone, the same instance gives the same certificate on one kind of processor. `on_step` is called after
    each step, and now and then while claims are searched for; `clock` gives nanoseconds. Over stops, cuts alone are
    searched for. Robots that there is no time for count as 0. Raises `Refusal` for numbers that are too large.
    """
    require_instance(instance)
    require_limits(seconds=seconds, steps=steps)
    seconds = BOUND_SECONDS if seconds is None and steps is None else seconds
    if goals_stand_alone(instance):
        return _by_prices(instance, seconds, steps, on_step, clock, enough)
    from carp_optimum.claims.disjoint_cuts import bound_by_cuts  # noqa: PLC0415 - it loads a solver

    whole, check = (_limit(seconds, each, PARTS, clock) for each in (None, steps))
    return bound_by_cuts(instance, lambda: whole(0), check, lambda count, bound: on_step(Progress(count, bound)))


def _by_prices(
    instance: Instance,
    seconds: float | None,
    steps: int | None,
    on_step: Callable[[Progress], None],
    clock: Callable[[], int],
    enough: int | None,
) -> BoundDocument:
    """The bound of robots with goals alone."""
    from carp_optimum.claims.deadline_search import DeadlineSearch  # noqa: PLC0415 - numba is slow to load
    from carp_optimum.claims.pair_search import SightSearch  # noqa: PLC0415
    from carp_optimum.lagrangian.price_search import PriceSearch  # noqa: PLC0415

    def report() -> None:
        on_step(Progress(search.count, -(-search.best // SCALE)))

    def looking(check: Callable[[int], None]) -> Callable[[], None]:
        def look() -> None:
            report()
            check(search.count)

        return look

    def limits(parts: tuple[int, int, int]) -> _Limits:
        first, look = (looking(_limit(seconds, steps, each, clock)) for each in parts[:2])

        def rough() -> None:
            look()
            if enough is not None and search.best > (enough - 1) * SCALE:
                raise TimeOver

        return _Limits(first, rough, looking(_limit(seconds, None, parts[2], clock)), looking(end))

    end = _limit(seconds, steps, PARTS, clock, lambda: WAYS_AT_END * search.longest)
    by_programme, by_steps = limits(PROGRAMME_PARTS), limits(STEP_PARTS)
    whole = _limit(seconds, None, PARTS, clock)
    search = PriceSearch(instance, SCALE, clock, lambda: whole(0))
    report()
    if not search.begun:
        return _certificate(search)
    search.within = lambda: end(0)
    sights = SightSearch(search)
    with suppress(TimeOver):
        claims = DeadlineSearch(search), sights
        is_small = len(instance.robots) * search.horizon <= MOST_TICKS
        if not (is_small and _by_programme(*claims, by_programme)):
            _by_steps(*claims, by_steps)
    report()
    return _certificate(search)


class _Limits(NamedTuple):
    """Checks that raise `TimeOver` at the ends of the parts of the time."""

    first: Callable[[], None]
    rough: Callable[[], None]
    proved: Callable[[], None]
    end: Callable[[], None]


def _prove(sights: "SightSearch", check: Callable[[], None]) -> None:
    """Prove the claims that have a price, and drop the others."""
    with suppress(TimeOver):
        sights.prove(check)


def _by_steps(deadlines: "DeadlineSearch", sights: "SightSearch", limits: _Limits) -> None:
    """Climb and add claims in turns; raises `TimeOver` at the end of the time."""
    search = deadlines.search
    rough = limits.rough

    def last_aim() -> int:
        return max(ROUGH_AIM, search.best // LARGE)

    def gain_of_sights() -> int:
        rough()
        return min(sights.round(rough), search.best // NEXT_AIM)

    def watch() -> None:
        sights.watch(rough)

    with suppress(TimeOver):
        gain = min(search.best // FIRST_AIM, max(search.best // LARGE_FIRST, LARGE_AIM))
        with suppress(TimeOver):
            search.climb(gain, last_aim(), limits.first)
        by_sights = gain_of_sights()
        while gain > 0:
            before = search.best
            if by_sights > 0:
                search.roam(by_sights // 4, last_aim(), rough, watch)
            search.climb(by_sights or gain, last_aim(), rough)
            _prove(sights, limits.proved)
            fruitless = by_sights > 0 and (search.best - before) * LEAST_RISE < search.best
            by_sights = 0 if fruitless else gain_of_sights()
            gain = by_sights or min(deadlines.round(rough), search.best // NEXT_AIM)
    _prove(sights, limits.proved)
    search.climb(max(ROUGH_AIM, search.best // FINAL_AIM), FINE_AIM, limits.end)


def _by_programme(deadlines: "DeadlineSearch", sights: "SightSearch", limits: _Limits) -> bool:
    """Solve linear programmes and add claims in turns; raises `TimeOver` at the end of the time.

    Returns whether the first programme was solved in its part of the time; otherwise nothing more is done.
    """
    from carp_optimum.lagrangian.column_generation import ColumnGeneration  # noqa: PLC0415 - HiGHS is slow to load

    columns = ColumnGeneration(deadlines.search)
    try:
        columns.climb(limits.first)
    except TimeOver:
        limits.rough()
        return False
    with suppress(TimeOver):
        _add_claims(columns, sights, deadlines, limits.rough)
    _prove(sights, limits.proved)
    columns.keep_deadlines()
    columns.climb(limits.end)
    return True


def _add_claims(
    columns: "ColumnGeneration", sights: "SightSearch", deadlines: "DeadlineSearch", look: Callable[[], None]
) -> None:
    """Add claims that the best shares of ways break, round by round, until these gain little; `look` may end it."""
    from carp_optimum.claims.deadline_search import STEPS  # noqa: PLC0415 - numba is slow to load

    before = idle = 0
    is_new = True
    while is_new and idle < IDLE_ROUNDS:
        known = len(columns.search.deadlines)
        columns.climb(look)
        gained = columns.best - before
        before = columns.best
        idle = idle + 1 if gained < IDLE_GAIN else 0
        delays, places = columns.ways(STEPS)
        try:
            if sights.is_small:
                sights.is_slow = gained < LEAST_GAIN
                sights.add([*zip(delays, places, strict=True)], look)
            if gained < LEAST_GAIN and deadlines.is_possible:
                deadlines.add(delays, look)
        finally:
            columns.add_deadlines()
        is_new = gained >= LEAST_GAIN or len(columns.search.deadlines) > known


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
    """What the best prices prove in the steps that the checker takes; the sum of shortest ways where that is more."""
    from carp_optimum.lagrangian.price_search import PriceLists  # noqa: PLC0415 - numba is slow to load

    prices, robots = PriceLists((), (), ()), search.shortest_costs()
    priced: tuple[DeadlinesDocument, ...] = ()
    parts = sum(least or 0 for _, least in robots)
    if search.best > search.shortest:
        search.restore()
        costs, fees = search.least_costs(), search.priced_deadlines()
        proved = sum(least or 0 for _, least in costs) - int(search.dual.prices.worth[0])
        proved -= sum(each.price * (len(each.robots) - 1) for each in fees)
        if proved >= parts:
            prices, priced, robots, parts = search.prices(), fees, costs, proved
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
