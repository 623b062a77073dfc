"""Free windows under reservations (`window/free`): reserving a plan and withdrawing it are exact inverses.

The windows of a resource of capacity 1 are the gaps between its stays, those of no length included, which are too
short for any stay: a reservation splits the gap in which it falls, and its withdrawal joins the two. Where following is
forbidden, a gap is a tick shorter at both ends. The windows of other resources are made again from their stays.
"""

from carp_optimized.jit.compiling import RoomExhausted, compiled, inlined
from carp_optimized.jit.kinds import Ints
from carp_optimized.queries.blocks import below, width
from carp_optimized.state.arrays import BLOCK, NEVER, NONE, Records, Rows, State


@compiled
def last_by(rows: Rows, resource: int, tick: int) -> int:
    """The slot of the last interval of the resource that starts by the tick, or `NONE`."""
    first = int(rows.offset[resource])
    slot = skip_below(rows.start, first, first + int(rows.size[resource]), tick + 1)
    return slot - 1 if slot > first else NONE


@compiled
def skip_below(ticks: Ints, slot: int, row_end: int, limit: int) -> int:
    """From the first slot of a row to the first whose tick is not below the limit, or to the end of the row.

    Ticks are in order, and a block at a time is compared.
    """
    limit = min(limit, NEVER)
    while True:
        count = width(below(ticks, slot, limit))
        slot += count
        if count < BLOCK or slot >= row_end:
            return slot


@inlined
def make_room(rows: Rows, resource: int) -> None:
    """Move the row to the end of the pool if it is full."""
    count = int(rows.size[resource])
    if count < rows.room[resource]:
        return
    room = 2 * count
    old = int(rows.offset[resource])
    new = int(rows.used[0])
    if new + room > rows.start.size:
        raise RoomExhausted
    for k in range(count):
        rows.start[new + k] = rows.start[old + k]
        rows.end[new + k] = rows.end[old + k]
        rows.source[new + k] = rows.source[old + k]
        rows.robot[new + k] = rows.robot[old + k]
        rows.rank[new + k] = rows.rank[old + k]
    for k in range(room):
        rows.resource[new + k] = resource
    rows.offset[resource] = new
    rows.room[resource] = room
    rows.used[0] = new + room


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
        windows.start[k] = windows.start[k - 1]
        windows.end[k] = windows.end[k - 1]
        windows.source[k] = windows.source[k - 1]
        windows.robot[k] = windows.robot[k - 1]
        windows.rank[k] = windows.rank[k - 1]
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
    windows.end[slot] = windows.end[slot + 1]
    windows.source[slot] = windows.source[slot + 1]
    windows.robot[slot] = windows.robot[slot + 1]
    windows.rank[slot] = windows.rank[slot + 1]
    for k in range(slot + 1, last):
        windows.start[k] = windows.start[k + 1]
        windows.end[k] = windows.end[k + 1]
        windows.source[k] = windows.source[k + 1]
        windows.robot[k] = windows.robot[k + 1]
        windows.rank[k] = windows.rank[k + 1]
    windows.start[last] = NEVER
    windows.end[last] = NEVER


@compiled
def add_stay(stays: Rows, resource: int, enter: int, leave: int, source: int) -> None:
    """Insert the start with its source, and the end, each in its order."""
    make_room(stays, resource)
    first = int(stays.offset[resource])
    slot = first + int(stays.size[resource])
    while slot > first and stays.start[slot - 1] > enter:
        stays.start[slot] = stays.start[slot - 1]
        stays.source[slot] = stays.source[slot - 1]
        slot -= 1
    stays.start[slot] = enter
    stays.source[slot] = source
    slot = first + int(stays.size[resource])
    while slot > first and stays.end[slot - 1] > leave:
        stays.end[slot] = stays.end[slot - 1]
        slot -= 1
    stays.end[slot] = leave
    stays.size[resource] += 1


@compiled
def drop_stay(stays: Rows, resource: int, enter: int, leave: int, source: int) -> None:
    """Undo `add_stay`; stays that are alike are interchangeable."""
    stays.size[resource] -= 1
    first = int(stays.offset[resource])
    last = first + int(stays.size[resource])
    slot = first
    while stays.start[slot] != enter or stays.source[slot] != source:
        slot += 1
    for k in range(slot, last):
        stays.start[k] = stays.start[k + 1]
        stays.source[k] = stays.source[k + 1]
    slot = first
    while stays.end[slot] != leave:
        slot += 1
    for k in range(slot, last):
        stays.end[k] = stays.end[k + 1]
    stays.start[last] = NEVER
    stays.end[last] = NEVER


@compiled
def clear_row(rows: Rows, resource: int) -> None:
    """Drop all intervals of the resource."""
    first = int(rows.offset[resource])
    for slot in range(first, first + int(rows.size[resource])):
        rows.start[slot] = NEVER
        rows.end[slot] = NEVER
    rows.size[resource] = 0


@compiled
def append_window(windows: Rows, resource: int, start: int, end: int) -> None:
    """Append a window to the row, unless it has no length."""
    if start < end:
        make_room(windows, resource)
        slot = int(windows.offset[resource]) + int(windows.size[resource])
        windows.start[slot] = start
        windows.end[slot] = end
        windows.source[slot] = NONE
        windows.robot[slot] = NONE
        windows.rank[slot] = NONE
        windows.size[resource] += 1


@compiled
def sweep_windows(windows: Rows, stays: Rows, resource: int, capacity: int, gap: int) -> None:
    """Make the windows of the resource again from its stays, which last `gap` ticks longer than the robots stay."""
    clear_row(windows, resource)
    into = int(stays.offset[resource])
    out = into
    last = into + int(stays.size[resource])
    inside = 0
    opened = 0
    while out < last and stays.end[out] < NEVER:
        tick = int(stays.end[out])
        if into < last:
            tick = min(tick, int(stays.start[into]))
        before = inside
        while into < last and stays.start[into] == tick:
            inside += 1
            into += 1
        while out < last and stays.end[out] == tick:
            inside -= 1
            out += 1
        if before < capacity <= inside:
            append_window(windows, resource, opened, tick - gap)
        elif inside < capacity <= before:
            opened = tick
    while inside < capacity and into < last:  # what is left are stays for ever
        inside += 1
        if inside == capacity:
            append_window(windows, resource, opened, int(stays.start[into]) - gap)
        into += 1
    if inside < capacity:
        append_window(windows, resource, opened, NEVER)


@compiled
def reserve(state: State, record: int) -> None:
    """Take the stays of the plan out of the windows; the plan must fit."""
    reserve_but(state, record, 0, 0)


@compiled
def reserve_but(state: State, record: int, head: int, tail: int) -> None:
    """Reserve the plan where its first `head` and last `tail` stays are reserved."""
    records = state.records
    robot = int(records.robot[record])
    rank = int(state.rank[robot])
    state.reserved[robot] = record
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    source = int(records.resource[first + head - 1]) if head > 0 else NONE
    for k in range(first + head, last + 1 - tail):
        resource = int(records.resource[k])
        enter = int(records.enter[k])
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        if state.graph.capacity[resource] == 1:
            met_from = source if state.gap == 0 else NONE
            split_window(state.windows, resource, enter, leave, state.gap, met_from, robot, rank)
        else:
            add_stay(state.stays, resource, enter, min(leave + state.gap, NEVER), source)
            sweep_windows(state.windows, state.stays, resource, int(state.graph.capacity[resource]), state.gap)
        source = resource


@compiled
def withdraw(state: State, record: int) -> None:
    """Undo `reserve`."""
    withdraw_but(state, record, 0, 0)


@compiled
def withdraw_but(state: State, record: int, head: int, tail: int) -> None:
    """Undo `reserve_but`."""
    records = state.records
    state.reserved[records.robot[record]] = NONE
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    source = int(records.resource[first + head - 1]) if head > 0 else NONE
    for k in range(first + head, last + 1 - tail):
        resource = int(records.resource[k])
        enter = int(records.enter[k])
        if state.graph.capacity[resource] == 1:
            join_windows(state.windows, resource, enter)
        else:
            leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
            drop_stay(state.stays, resource, enter, min(leave + state.gap, NEVER), source)
            sweep_windows(state.windows, state.stays, resource, int(state.graph.capacity[resource]), state.gap)
        source = resource


@compiled
def is_exchange(state: State, slot: int, tick: int, target: int) -> bool:
    """Whether leaving the window at the tick for `target` meets a committed robot that comes from there.

    In a resource of capacity 1 that robot is the one that ends the window, so the tick is the window's end; where
    following is forbidden, none exists.
    """
    resource = int(state.windows.resource[slot])
    if state.graph.capacity[resource] == 1:
        return bool(state.windows.end[slot] == tick and state.windows.source[slot] == target)
    stays = state.stays
    first = int(stays.offset[resource])
    stay = last_by(stays, resource, tick)
    while stay >= first and stays.start[stay] == tick:
        if stays.source[stay] == target:
            return True
        stay -= 1
    return False


@compiled
def end_of_run(state: State, slot: int, behind: int) -> int:
    """The last of the windows that are one to a robot planned behind that rank: only later robots are between them."""
    while state.windows.rank[slot] > behind:
        slot += 1
    return slot


@compiled
def start_of_run(state: State, slot: int, behind: int) -> int:
    """The first of the windows that are one to a robot planned behind that rank."""
    windows = state.windows
    first = int(windows.offset[windows.resource[slot]])
    while slot > first and windows.rank[slot - 1] > behind:
        slot -= 1
    return slot


@compiled
def fits(state: State, resource: int, enter: int, leave: int, target: int, behind: int) -> bool:
    """Whether a robot can stay in the resource in [enter, leave) and then move to `target` (`NONE`: not move)."""
    slot = last_by(state.windows, resource, enter)
    if slot == NONE:
        return False
    slot = end_of_run(state, slot, behind)
    if leave > state.windows.end[slot]:
        return False
    return target == NONE or not is_exchange(state, slot, leave, target)


@compiled
def plan_fits(state: State, record: int) -> bool:
    """Whether all of the plan fits the windows."""
    records: Records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last):
        leave = int(records.enter[k + 1])
        target = int(records.resource[k + 1])
        if not fits(state, int(records.resource[k]), int(records.enter[k]), leave, target, NEVER):
            return False
    return fits(state, int(records.resource[last]), int(records.enter[last]), int(records.leave[record]), NONE, NEVER)


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
