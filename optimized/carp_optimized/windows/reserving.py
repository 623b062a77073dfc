"""Reserving a plan and withdrawing it, which are exact inverses."""

from carp_optimized.jit.compiling import compiled, inlined
from carp_optimized.jit.kinds import Ints
from carp_optimized.state.arrays import GROUPED, NEVER, NONE, Rows, State
from carp_optimized.state.groups import is_within
from carp_optimized.windows.fitting import fits
from carp_optimized.windows.rows import copy, last_by, make_room
from carp_optimized.windows.sweeps import add_stay, drop_stay, sweep_plan, sweep_windows


@compiled
def reserve(state: State, record: int) -> None:
    """Take the stays of the plan out of the windows; the plan must fit."""
    reserve_but(state, record, 0, 0)


@compiled
def reserve_but(state: State, record: int, head: int, tail: int) -> None:
    """Reserve the plan where its first `head` and last `tail` stays are reserved."""
    book(state, record, head, tail, True)
    sweep(state, record)


@compiled
def withdraw(state: State, record: int) -> None:
    """Undo `reserve`."""
    withdraw_but(state, record, 0, 0)


@compiled
def withdraw_but(state: State, record: int, head: int, tail: int) -> None:
    """Undo `reserve_but`."""
    book(state, record, head, tail, False)
    sweep(state, record)


@compiled
def book_all(state: State, plans: Ints, is_added: bool) -> None:
    """Reserve plans, which must fit, or withdraw them; windows in groups are made again once for all of them.

    Stays in groups are put in and taken out without a look at windows, so that these may be old until the end.
    """
    for plan in plans:
        book(state, int(plan), 0, 0, is_added)
    if state.graph.group.size > 0:
        state.sweep.now[0] += 1
        for plan in plans:
            sweep_plan(state, int(plan))


@inlined
def sweep(state: State, record: int) -> None:
    """Make windows in groups again after a change of the plan."""
    if state.graph.group.size > 0:
        state.sweep.now[0] += 1
        sweep_plan(state, record)


@compiled
def book(state: State, record: int, head: int, tail: int, is_added: bool) -> None:
    """Add or drop the stays of the plan, but for its first `head` and last `tail`; not the windows in groups."""
    records = state.records
    robot = int(records.robot[record])
    state.reserved[robot] = record if is_added else NONE
    rank = int(state.rank[robot])
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    source = int(records.resource[first + head - 1]) if head > 0 else NONE
    for k in range(first + head, last + 1 - tail):
        resource = int(records.resource[k])
        enter = int(records.enter[k])
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        if state.graph.capacity[resource] == 1:
            if is_added:
                met_from = source if state.gap == 0 else NONE
                split_window(state.windows, resource, enter, leave, state.gap, met_from, robot, rank)
            else:
                join_windows(state.windows, resource, enter)
        else:
            if is_added:
                add_stay(state.stays, resource, enter, min(leave + state.gap, NEVER), source)
            else:
                drop_stay(state.stays, resource, enter, min(leave + state.gap, NEVER), source)
            if state.graph.capacity[resource] == GROUPED:
                book_groups(state, record, k, source, is_added)
            else:
                sweep_windows(state.windows, state.stays, resource, int(state.graph.capacity[resource]), state.gap)
        source = resource


@compiled
def book_groups(state: State, record: int, visit: int, source: int, is_added: bool) -> None:
    """Add or drop the stays in the groups that the visit enters: each lasts until the plan leaves the group."""
    graph = state.graph
    records = state.records
    last = int(records.visits_at[record]) + int(records.visits[record]) - 1
    resource = int(records.resource[visit])
    for k in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
        group = int(graph.group[k])
        if not is_within(graph, group, source):
            end = visit
            while end < last and is_within(graph, group, int(records.resource[end + 1])):
                end += 1
            leave = int(records.enter[end + 1]) if end < last else int(records.leave[record])
            leave = min(leave + state.gap, NEVER)
            constraint = graph.capacity.size + group
            if is_added:
                add_stay(state.stays, constraint, int(records.enter[visit]), leave, source)
            else:
                drop_stay(state.stays, constraint, int(records.enter[visit]), leave, source)


@inlined
def split_window(
    windows: Rows, resource: int, enter: int, leave: int, gap: int, source: int, robot: int, rank: int
) -> None:
    """Take [enter, leave), and the gap on both sides, out of the window that holds the stay, for the robot.

    It comes from `source`.
    """
    make_room(windows, resource)
    slot = last_by(windows, resource, enter)
    for k in range(int(windows.offset[resource]) + int(windows.size[resource]), slot, -1):
        copy(windows, k - 1, k)
    windows.end[slot] = enter - gap
    windows.robot[slot] = robot
    windows.rank[slot] = rank
    windows.source[slot] = source
    windows.start[slot + 1] = min(leave + gap, NEVER)
    windows.size[resource] += 1


@inlined
def join_windows(windows: Rows, resource: int, enter: int) -> None:
    """Give the stay that begins at `enter` back to the windows on both its sides."""
    slot = last_by(windows, resource, enter)
    windows.size[resource] -= 1
    last = int(windows.offset[resource]) + int(windows.size[resource])
    start = windows.start[slot]
    for k in range(slot, last):
        copy(windows, k + 1, k)
    windows.start[slot] = start
    windows.start[last] = NEVER
    windows.end[last] = NEVER


@compiled
def evict(state: State, record: int, head: int, tail: int) -> None:
    """Withdraw the plans that the plan, found without account of them, runs into; resources have capacity 1.

    Its first `head` and last `tail` stays are reserved, and so are the moves between them.
    """
    records = state.records
    windows = state.windows
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first + head, last + 1 - tail):
        resource = int(records.resource[k])
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        target = int(records.resource[k + 1]) if k < last else NONE
        while not fits(state, resource, int(records.enter[k]), leave, target, NEVER):
            slot = last_by(windows, resource, int(records.enter[k]))
            withdraw(state, int(state.reserved[windows.robot[slot]]))


@compiled
def give_rank(state: State, robot: int, rank: int) -> None:
    """Give a robot a rank, in the windows too if its plan is reserved: those that end where one of its stays begins."""
    state.rank[robot] = rank
    record = int(state.reserved[robot])
    if record == NONE:
        return
    first = int(state.records.visits_at[record])
    for k in range(first, first + int(state.records.visits[record])):
        resource = int(state.records.resource[k])
        if state.graph.capacity[resource] == 1:
            state.windows.rank[last_by(state.windows, resource, int(state.records.enter[k]))] = rank
