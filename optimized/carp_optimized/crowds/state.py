"""The state of a search that plays rounds over a crowd: its paths, the best ones seen, and the members of a round.

A round takes its members out, finds other paths for them, and keeps these or goes back.
"""

from typing import NamedTuple

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.crowds.sipp import EXPANDED, Query
from carp_optimized.crowds.soft_sipp import SoftQuery
from carp_optimized.crowds.stays import Paths, Stays, arrival, copy_path, drop, put
from carp_optimized.draws import SURE, choice
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, Longs, Numbers
from carp_optimized.jit.references import dereference

TOTAL, BEST, CHANCE, DIRTY, MARK, SIZE, WORK, ROUNDS, MISSED, TURNING, BEFORE, AFTER, REST = range(13)  # the counts
COUNTS = REST + 1
MOST_MEMBERS = 16


class Rounds(NamedTuple):
    """The state of a search: paths and their stays, the best paths, those tried in a round, and its members.

    `changed[:counts[DIRTY]]` are the robots whose paths may differ from the best, and `is_changed` says so of each.
    A member that `waits` has no stays; that of another is in its row of the paths tried. Of the members' arrivals,
    `counts[BEFORE]` is the sum before the round, and `counts[AFTER]` of those tried; `counts[REST]` is the least that
    those who wait can have.
    """

    crowd: Crowd
    stays: Stays
    query: Query
    soft: SoftQuery
    paths: Paths
    best: Paths
    tried: Paths
    least: Ints
    members: Ints
    waits: Ints
    key: Longs
    mark: Ints
    changed: Ints
    is_changed: Ints
    weight: Longs
    counts: Longs
    stream: Numbers


rounds_at = dereference(Rounds)


@compiled
def expanded(state: Rounds) -> int:
    """The labels that all queries have expanded."""
    return int(state.query.counts[EXPANDED]) + int(state.soft.labels.counts[EXPANDED])


@compiled
def begin_round(state: Rounds) -> None:
    """Begin a round without members."""
    state.counts[MARK] += 1
    state.counts[SIZE] = 0
    state.counts[BEFORE] = 0
    state.counts[AFTER] = 0
    state.counts[REST] = 0


@compiled
def add_member(state: Rounds, robot: int) -> None:
    """Make the robot a member, if it is none yet."""
    if state.mark[robot] != state.counts[MARK]:
        state.mark[robot] = state.counts[MARK]
        state.members[int(state.counts[SIZE])] = robot
        state.counts[SIZE] += 1


@compiled
def take_out(state: Rounds, member: int) -> None:
    """Let a member wait for another path."""
    robot = int(state.members[member])
    drop(state.stays, state.paths, robot, int(state.paths.size[robot]))
    state.waits[member] = 1
    state.counts[BEFORE] += arrival(state.paths, robot)
    state.counts[REST] += state.least[robot]


@compiled
def take_out_again(state: Rounds, member: int) -> None:
    """Let a member wait for yet another path than the one tried."""
    drop(state.stays, state.tried, member, int(state.tried.size[member]))
    state.waits[member] = 1
    state.counts[AFTER] -= arrival(state.tried, member)
    state.counts[REST] += state.least[int(state.members[member])]


@compiled
def put_in(state: Rounds, member: int) -> bool:
    """Let a member that waits take the path tried; `False` if a row of stays is full."""
    robot = int(state.members[member])
    if not put(state.crowd, state.stays, state.tried, member, robot):
        return False
    state.waits[member] = 0
    state.counts[AFTER] += arrival(state.tried, member)
    state.counts[REST] -= state.least[robot]
    return True


@compiled
def latest_of(state: Rounds, member: int, raised: int) -> int:
    """The tick by which a member that waits must arrive if the sum is to grow by no more than that."""
    counts = state.counts
    others = counts[REST] - state.least[int(state.members[member])]
    return int(counts[BEFORE] + raised - counts[AFTER] - others)


@compiled
def end_round(state: Rounds, is_kept: bool) -> None:
    """Keep the paths tried, or go back to those before."""
    if is_kept:
        keep(state)
        return
    size = int(state.counts[SIZE])
    for member in range(size):
        if state.waits[member] == 0:
            drop(state.stays, state.tried, member, int(state.tried.size[member]))
    for member in range(size):
        robot = int(state.members[member])
        put(state.crowd, state.stays, state.paths, robot, robot)


@compiled
def keep(state: Rounds) -> None:
    """Make the paths tried those of the members, and note whether they are the best."""
    counts = state.counts
    for k in range(int(counts[SIZE])):
        robot = int(state.members[k])
        copy_path(state.tried, k, state.paths, robot)
        if state.is_changed[robot] == 0:
            state.is_changed[robot] = 1
            state.changed[int(counts[DIRTY])] = robot
            counts[DIRTY] += 1
    counts[TOTAL] += counts[AFTER] - counts[BEFORE]
    if counts[TOTAL] < counts[BEST]:
        counts[BEST] = counts[TOTAL]
        for k in range(int(counts[DIRTY])):
            robot = int(state.changed[k])
            state.is_changed[robot] = 0
            copy_path(state.paths, robot, state.best, robot)
        counts[DIRTY] = 0


@compiled
def draw_turn(state: Rounds) -> int:
    """A turn of the order of edges, or none."""
    return 1 + choice(state.stream, SURE) if state.counts[TURNING] else 0


@compiled
def delay_of(state: Rounds, robot: int) -> int:
    """The ticks by which the robot arrives later than it could alone."""
    return arrival(state.paths, robot) - int(state.least[robot])


@compiled
def delayed(state: Rounds) -> int:
    """A robot, drawn by the share of its delay; any if none is late."""
    robots = int(state.least.size)
    total = 0
    for robot in range(robots):
        total += delay_of(state, robot)
    if total == 0:
        return choice(state.stream, robots)
    left = choice(state.stream, total)
    robot = 0
    while True:
        left -= delay_of(state, robot)
        if left < 0:
            return robot
        robot += 1
