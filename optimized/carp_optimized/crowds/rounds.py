"""Rounds of large neighbourhood search over a crowd (MAPF-LNS, Li et al. 2021): one compiled call plays many.

A round takes a few robots out, plans them one after the other by `carp_optimized.crowds.sipp`, and keeps the new paths
if the sum of their arrivals is not above the sum before by more than a raise that is drawn (simulated annealing). The
best paths seen are kept apart. A path is looked for only up to the arrival at which the sum could still be kept. Other
rounds eject whoever is in a robot's way (`carp_optimized.crowds.ejecting`).

There are kinds of rounds, and queries of more or less greed. Each is chosen by the share of its weight, which
follows what its rounds gained for the work that they took (adaptive large neighbourhood search, Ropke and Pisinger
2006).
"""

from carp_optimized.crowds.ejecting import eject
from carp_optimized.crowds.neighbourhoods import add_drawn, draw_crossing, draw_in_way, draw_turns
from carp_optimized.crowds.sipp import EXPANDED, GREED, TURN, WHOLE, find_path
from carp_optimized.crowds.state import (
    CHANCE,
    MISSED,
    MOST_MEMBERS,
    ROUNDS,
    SIZE,
    TOTAL,
    WORK,
    Rounds,
    add_member,
    begin_round,
    draw_turn,
    end_round,
    expanded,
    latest_of,
    put_in,
    rounds_at,
    take_out,
)
from carp_optimized.crowds.stays import put
from carp_optimized.draws import choice, draw_raise, shuffle
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NEVER, NONE

IN_WAY, CROSSING, TURNS, DRAWN, EJECTING = range(5)  # the kinds
KINDS = 5
GREEDY = WHOLE // 2
DEGREES = 3  # of greed: none, `GREEDY`, and four times that
LEAST_WEIGHTS = (KINDS - 1) * (1 << 14,) + (1 << 12,) + DEGREES * (1 << 4,)
FIRST_WEIGHTS = KINDS * (1 << 22,) + (1 << 10, 1 << 12, 1 << 12)
"""Of the kinds, and of the degrees: a round that ejects, and queries without greed, may take much longer."""
GAIN = 1 << 36
"""A gain of one tick adds this to a weight, if it took one unit of work: four times the work, a 16th of it.

What takes longer is to be chosen more rarely, too.
"""
MEMORY = 64  # rounds over which a weight is about the mean
FULL = NONE


@entry
def play(native: Native[Rounds], rounds: int, work: int) -> int:
    """Play rounds until that many are played or that much work is done; how many, or `FULL` after an unfinished one."""
    state = rounds_at(native)
    until = int(state.counts[WORK]) + work
    for played in range(rounds):
        if state.counts[WORK] >= until:
            return played
        if not play_round(state):
            return FULL
        state.counts[ROUNDS] += 1
    return rounds


@entry
def plan_each(native: Native[Rounds], order: Ints, begin: int, work: int) -> int:
    """Plan robots again, one by one, that have paths, from `order[begin]` on, until that many labels are expanded.

    Returns the number of the next one, with all bits inverted if a row is too full for it.
    """
    state = rounds_at(native)
    until = int(state.query.counts[EXPANDED]) + work
    for k in range(begin, order.size):
        if state.query.counts[EXPANDED] >= until:
            return k
        state.counts[CHANCE] = 0
        begin_round(state)
        add_member(state, int(order[k]))
        if not replan(state):
            return ~k
    return int(order.size)


@entry
def plan_first(native: Native[Rounds], order: Ints, begin: int, work: int) -> int:
    """Plan robots, one by one, that have no paths yet; those without any get none. As `plan_each`."""
    state = rounds_at(native)
    until = int(state.query.counts[EXPANDED]) + work
    for k in range(begin, order.size):
        if state.query.counts[EXPANDED] >= until:
            return k
        robot = int(order[k])
        state.paths.size[robot] = 0
        if not find_path(state.crowd, state.stays, state.query, robot, NEVER - 1, state.paths, robot):
            state.counts[MISSED] += 1
        elif not put(state.crowd, state.stays, state.paths, robot, robot):
            state.paths.size[robot] = 0
            return ~k
    return int(order.size)


@entry
def put_all(native: Native[Rounds], begin: int, end: int) -> int:
    """Add the stays of the paths from one on up to another; the first that is not added, as a row is full."""
    state = rounds_at(native)
    for robot in range(begin, end):
        if not put(state.crowd, state.stays, state.paths, robot, robot):
            return robot
    return end


@compiled
def play_round(state: Rounds) -> bool:
    """Take out a neighbourhood and replan it; `False` if a row of stays is full."""
    kind = choose_kind(state)
    degree = choose_by_weight(state, KINDS, DEGREES)
    greed = GREEDY * (degree - KINDS) ** 2
    state.query.counts[GREED] = greed
    state.soft.labels.counts[GREED] = greed
    before = int(state.counts[TOTAL])
    begun = expanded(state)
    begin_round(state)
    if kind == EJECTING:
        has_room = eject(state)
    else:
        draw(state, kind)
        has_room = replan(state)
    if not has_room:
        return False
    work = 100 * int(state.counts[SIZE]) + expanded(state) - begun
    state.counts[WORK] += work
    gain = max(before - int(state.counts[TOTAL]), 0) * GAIN // work // work
    update_weight(state, kind, gain)
    update_weight(state, degree, gain)
    return True


@compiled
def draw(state: Rounds, kind: int) -> None:
    """Draw the members of a round of that kind."""
    size = 2 + choice(state.stream, 9)
    if kind == IN_WAY:
        draw_in_way(state, size)
    elif kind == CROSSING:
        draw_crossing(state, size)
    elif kind == TURNS:
        draw_crossing(state, 4 + choice(state.stream, MOST_MEMBERS - 3))
        draw_turns(state)
    else:
        add_drawn(state, size)
    if kind in (IN_WAY, CROSSING):  # half of the time the first stays first
        shuffle(state.stream, state.members, choice(state.stream, 2), int(state.counts[SIZE]))


@compiled
def update_weight(state: Rounds, which: int, gain: int) -> None:
    """Let a weight follow what a round gained."""
    after = int(state.weight[which]) + (gain - int(state.weight[which])) // MEMORY
    state.weight[which] = max(after, LEAST_WEIGHTS[which])


@compiled
def choose_kind(state: Rounds) -> int:
    """Choose a kind: in one round of four any of those that take about as long, else by the weights."""
    if choice(state.stream, 4) == 0:
        return choice(state.stream, EJECTING)
    return choose_by_weight(state, 0, KINDS)


@compiled
def choose_by_weight(state: Rounds, first: int, among: int) -> int:
    """Choose one of that many, from the first on, by the share of its weight."""
    total = 0
    for which in range(first, first + among):
        total += int(state.weight[which])
    left = choice(state.stream, total)
    for which in range(first, first + among):
        left -= int(state.weight[which])
        if left < 0:
            return which
    return first


@compiled
def replan(state: Rounds) -> bool:
    """Plan the members in their order, and keep their new paths or go back; `False` if a row of stays is full."""
    size = int(state.counts[SIZE])
    for member in range(size):
        take_out(state, member)
    raised = draw_raise(state.stream, int(state.counts[CHANCE]))
    is_kept = True
    has_room = True
    member = 0
    while member < size and is_kept:
        robot = int(state.members[member])
        state.query.counts[TURN] = draw_turn(state)
        latest = latest_of(state, member, raised)
        if find_path(state.crowd, state.stays, state.query, robot, latest, state.tried, member):
            has_room = put_in(state, member)
            is_kept = has_room
        else:
            is_kept = False
        member += 1
    end_round(state, is_kept)
    return has_room
