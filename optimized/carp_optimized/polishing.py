"""A fleet polished, round by round, until a clock or a number of rounds ends it."""

from collections.abc import Callable
from itertools import takewhile

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.jit.references import Native
from carp_optimized.neighbourhood.polishing import play_rounds
from carp_optimized.state import limits, room
from carp_optimized.state.arrays import FORGOTTEN, NONE, NOW, QUEUED, TURN, UNASKED, Polish

ROUNDS = 50  # in one compiled call, if there are not so many
VISITS = 20_000  # in all plans together
PART = 32  # robots between two looks at a clock


def polish_fleet(
    fleet: PlannedFleet,
    goes_on: Callable[[], bool],
    last: int | None,
    seed: int,
    now: int,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> None:
    """Polish the plans of a fleet as long as it goes on, up to the last round, if there is one.

    Robots keep what they have done by the tick `now`. `advance` gets rounds, unplanned robots and total.
    """
    polishing = to_polish(fleet, seed, now, goes_on)
    played = play(fleet, polishing, 0)
    most = rounds_between_looks(fleet)
    while played != last and goes_on():
        rounds = most if last is None else min(most, last - played)
        batch = play(fleet, polishing, rounds)
        played += batch
        advance(played, *fleet.worth)
        if batch < rounds:
            break


def rounds_between_looks(fleet: PlannedFleet) -> int:
    """How many rounds of a polish are played between two looks at a clock: fewer where each takes long."""
    return max(ROUNDS * VISITS // max(fleet.visits, VISITS), 1)


def to_polish(
    fleet: PlannedFleet, seed: int, now: int = 0, goes_on: Callable[[], bool] = lambda: True
) -> Native[Polish]:
    """The arrays for polishing this fleet at a tick, from the plans that it has.

    Robots whose costs alone are not found while it goes on begin no round.
    """
    limits.refuse_tick("$.now", now)
    able = fleet.robots if now == 0 else np.sort(fleet.planned)
    followed = fleet.held if now > 0 else np.full(fleet.held.size, NONE, np.int32)
    costs = np.full(fleet.held.size, NONE, np.int64)
    for some in takewhile(lambda _: goes_on(), np.split(able, range(PART, able.size, PART))):
        fleet.call(lambda some=some: passes.cost_each_alone(fleet.empty, some, followed, now, costs))  # type: ignore[misc]
    past = np.zeros(fleet.held.size, np.int32)
    for robot in fleet.planned if now > 0 else ():
        past[robot] = sum(enter <= now for enter in fleet.columns(int(fleet.held[robot])).enters)
    polish = room.no_polish(costs, past, fleet.state.graph.duration.size)
    polish.stream[0] = seed
    polish.counts[NOW] = now
    polish.counts[FORGOTTEN] = fleet.forgotten
    return Native(polish)


def play(fleet: PlannedFleet, polishing: Native[Polish], rounds: int) -> int:
    """Play rounds of `polish/...`; returns how many were played before nothing was left to do."""
    fleet.forget_old_records()
    work = polishing.fields
    size, turn, stream = fleet.planned.size, int(work.counts[TURN]), int(work.stream[0])
    if work.counts[FORGOTTEN] != fleet.forgotten:
        work.alone[work.alone != NONE] = UNASKED
        work.counts[FORGOTTEN] = fleet.forgotten
    alone = work.alone.copy()

    def attempt() -> int:
        work.alone[:] = alone
        work.queue[:size] = fleet.planned
        work.plans[:] = fleet.held
        work.counts[QUEUED], work.counts[TURN], work.stream[0] = size, turn, stream
        return play_rounds(fleet.native, polishing, fleet.empty, rounds)

    played = fleet.call(attempt)
    order = work.queue[: work.counts[QUEUED]].copy()
    fleet.hold(order, work.plans[order])
    fleet.ask_again()
    return played
