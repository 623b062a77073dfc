"""A polish that may raise the total for a while: simulated annealing (Kirkpatrick et al. 1983) of `polish/...`.

A polish ends where no small change helps any more. So each round draws by how many ticks it may raise the total: on
average a share of the mean delay of a robot, which falls to 0 as the cube of the time left in the cycle. As long as
rounds may raise it, every second one takes turns (`carp_optimized.neighbourhood.polishing`). One long cycle ends in a
bad place as often as a short one does. So there are several, each from the best plans seen, which are the result.
Nothing here is trusted: the law judges the plans.

Where robots wait much, as on a tree, results vary widely between cycles. Then there are more of them, and some begin
again with the plans given: each begins where the one before began if that gained, and at the other place if not.
"""

from collections.abc import Callable
from contextlib import suppress
from time import perf_counter

import carp_optimized
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.cycles import ENOUGH, HEAT, PARTS, REHEAT, chance
from carp_optimized.improve.planning import improve_crowd
from carp_optimized.improve.repair import repair
from carp_optimized.polishing import play, rounds_between_looks, to_polish
from carp_optimized.settling import settle
from carp_optimized.state.arrays import CHANCE
from carp_spec import Instance, Refusal, Solution
from carp_spec.inputs.options import require_polish_options
from carp_spec.requests import require_tick, sound_solution

CYCLES, CYCLES_IF_DELAYED = 8, 16
MUCH = 2
"""Robots wait much where the delays, times this, are more than the shortest paths: results then vary between cycles."""
COOLER = 4
"""There raises are smaller shares of the delays by this."""
ENDING, LEAST_ENDING, MOST_ENDING = 4, 32, 8
"""At the end, plans are settled, which takes up to about as long as so many rounds for each robot.

At least one of so many parts of the time is left for it, and at most another.
"""
REPAIR = 2
"""A repair takes at most one of this many parts of the time."""
BRIEF = 0.01
"""The seconds of a search if what comes before took the time."""


def polish_or_anneal(
    instance: Instance,
    solution: Solution,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    now: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """Improve a solution by large neighbourhood search; `advance` gets rounds, unplanned robots and total.

    With `seconds`, robots without a plan are planned first, in at most half of the time, and rounds may raise the total
    for a while (simulated annealing); the best plans seen are the result. Otherwise `iterations` rounds of `polish/...`
    are played, 10,000 unless given. They never raise the total, and equal iterations and seed give an equal solution.
    Robots keep what they have done by the tick `now`; after tick 0, those without a plan get none. Raises `Refusal` for
    wrong options, for a solution that breaks a rule, and for numbers that are too large.
    """
    require_polish_options(iterations, seconds, seed)
    require_tick(now)
    if seconds is None:
        return carp_optimized.polish(instance, solution, iterations=iterations, seed=seed, now=now, advance=advance)
    started = perf_counter()
    whole = sound_solution(instance, solution)

    def left() -> float:
        return max(seconds - (perf_counter() - started), BRIEF)

    found = improve_crowd(instance, whole, left(), seed=seed, advance=advance) if now == 0 else None
    if found is not None:
        return found
    return anneal(instance, solution, left(), seed=seed, now=now, advance=advance, repairs=now == 0)


def anneal(
    instance: Instance,
    solution: Solution,
    seconds: float,
    *,
    seed: int = 0,
    now: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
    repairs: bool = True,
) -> Solution:
    """Improve a solution for that many seconds, the repair of robots left out included, if it `repairs` them first.

    `advance` gets the rounds and the best so far. Raises what `polish` raises.
    """
    started = clock()
    if repairs and len(solution.plans) < len(instance.robots):
        with suppress(Refusal):
            solution = repair(instance, solution, lambda: REPAIR * (clock() - started) < seconds)
    whole = sound_solution(instance, solution)
    fleet = PlannedFleet(instance)
    fleet.commit_solution(whole)
    polishing = to_polish(fleet, seed, now, lambda: clock() - started < seconds)
    least = int(polishing.fields.least.sum())
    played = play(fleet, polishing, 0)
    given = plans = fleet.plans
    best = before = own = fleet.worth
    is_delayed = (best[1] - least) * MUCH > least
    cycles = CYCLES_IF_DELAYED if is_delayed else CYCLES
    current = 0
    from_given = True
    rounds = rounds_between_looks(fleet)
    seconds = max(seconds - (clock() - started), BRIEF)
    ending = seconds / LEAST_ENDING
    started = clock()
    while (spent := int(PARTS * (clock() - started) / (seconds - ending))) < PARTS:
        cycle, gone = divmod(cycles * spent, PARTS)
        if cycle > current:
            from_given = is_delayed and played >= ENOUGH * len(instance.robots) and from_given == (best < before)
            if from_given or fleet.worth > best:
                fleet.clear()
                fleet.commit(given if from_given else plans)
            current, before, own = cycle, best, fleet.worth
        expected = PARTS * played // max(spent, 1)
        heated = (HEAT if from_given else REHEAT) * max(own[1] - least, 0) // (COOLER if is_delayed else 1)
        polishing.fields.counts[CHANCE] = chance(heated, len(instance.robots), expected, PARTS - gone, power=1)
        batch = play(fleet, polishing, rounds)
        played += batch
        settling = ENDING * len(instance.robots) * (clock() - started) / max(played, 1)
        ending = min(max(settling, ending), seconds / MOST_ENDING)
        own = min(own, fleet.worth)
        if own < best:
            best, plans = own, fleet.plans
        advance(played, *best)
        if batch < rounds:
            break
    if fleet.worth > best:
        fleet.clear()
        fleet.commit(plans)
    if settle(fleet, lambda: clock() - started < seconds, now):
        advance(played, *fleet.worth)
    return Solution.of(instance, fleet.plans)
