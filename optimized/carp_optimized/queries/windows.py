"""Free windows under reservations (`window/free`): reserving a plan and withdrawing it are exact inverses.

The windows of a resource of capacity 1 are the gaps between its stays, those of no length included, which are too
short for any stay: a reservation splits the gap in which it falls, and its withdrawal joins the two. Where following is
forbidden, a gap is a tick shorter at both ends. The windows of other resources, and of those in groups, are made again
from the stays of all constraints on them: a window is where each has room.
"""

from carp_optimized.jit.compiling import RoomExhausted, compiled, inlined
from carp_optimized.jit.kinds import Ints
from carp_optimized.queries.blocks import below, width
from carp_optimized.state.arrays import BLOCK, GROUPED, NEVER, NONE, Graph, Records, Rows, State
from carp_optimized.state.groups import are_close, is_within
from carp_optimized.state.records import has_order

STANDING = 0  # the slot of no row: a copy of the window in which the robot is when it sets out


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
def copy(rows: Rows, slot: int, to: int) -> None:
    """Copy an interval."""
    rows.start[to] = rows.start[slot]
    rows.end[to] = rows.end[slot]
    rows.source[to] = rows.source[slot]
    rows.robot[to] = rows.robot[slot]
    rows.rank[to] = rows.rank[slot]


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
        copy(rows, old + k, new + k)
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


@inlined
def constraint_on(graph: Graph, resource: int, k: int) -> int:
    """The constraint of that number on a resource: its own capacity is the first, then come its groups."""
    return resource if k == 0 else graph.capacity.size + int(graph.group[int(graph.groups_first[resource]) + k - 1])


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
def sweep_constraints(state: State, resource: int) -> None:  # noqa: C901 - one sweep over several rows at once
    """The same for a resource of groups, from the stays in all its constraints.

    Where some constraint has no room, there is no window.
    """
    graph = state.graph
    stays = state.stays
    into = state.sweep.into
    out = state.sweep.out
    clear_row(state.windows, resource)
    count = 1 + int(graph.groups_first[resource + 1]) - int(graph.groups_first[resource])
    for k in range(count):
        into[k] = stays.offset[constraint_on(graph, resource, k)]
        out[k] = into[k]
    was_free = False
    opened = 0
    tick = 0
    while True:
        is_free = True
        following = NEVER
        for k in range(count):
            constraint = constraint_on(graph, resource, k)
            last = int(stays.offset[constraint]) + int(stays.size[constraint])
            while into[k] < last and stays.start[into[k]] <= tick:
                into[k] += 1
            while out[k] < last and stays.end[out[k]] <= tick:
                out[k] += 1
            is_free &= into[k] - out[k] < graph.room[constraint]
            if into[k] < last:
                following = min(following, int(stays.start[into[k]]))
            if out[k] < last:
                following = min(following, int(stays.end[out[k]]))
        if is_free and not was_free:
            opened = tick
        elif was_free and not is_free:
            append_window(state.windows, resource, opened, tick - state.gap)
        was_free = is_free
        if following == NEVER:
            break
        tick = following
    if was_free:
        append_window(state.windows, resource, opened, NEVER)


@compiled
def sweep_group(state: State, group: int) -> None:
    """Make the windows of the group's resources again, unless that has been done since `sweep.now` was counted up."""
    sweep = state.sweep
    for k in range(int(state.graph.members_first[group]), int(state.graph.members_first[group + 1])):
        resource = int(state.graph.member[k])
        if sweep.mark[resource] != sweep.now[0]:
            sweep.mark[resource] = sweep.now[0]
            sweep_constraints(state, resource)


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


@compiled
def sweep_plan(state: State, record: int) -> None:
    """Make the windows again of all resources in the groups of those that the plan visits."""
    graph = state.graph
    records = state.records
    state.sweep.now[0] += 1
    first = int(records.visits_at[record])
    for visit in range(first, first + int(records.visits[record])):
        resource = int(records.resource[visit])
        for k in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
            sweep_group(state, int(graph.group[k]))


@compiled
def reserve(state: State, record: int) -> None:
    """Take the stays of the plan out of the windows; the plan must fit."""
    reserve_but(state, record, 0, 0)


@compiled
def reserve_but(state: State, record: int, head: int, tail: int) -> None:
    """Reserve the plan where its first `head` and last `tail` stays are reserved."""
    state.reserved[int(state.records.robot[record])] = record
    book(state, record, head, tail, True)


@compiled
def withdraw(state: State, record: int) -> None:
    """Undo `reserve`."""
    withdraw_but(state, record, 0, 0)


@compiled
def withdraw_but(state: State, record: int, head: int, tail: int) -> None:
    """Undo `reserve_but`."""
    state.reserved[int(state.records.robot[record])] = NONE
    book(state, record, head, tail, False)


@compiled
def book(state: State, record: int, head: int, tail: int, is_added: bool) -> None:
    """Add or drop the stays of the plan, but for its first `head` and last `tail`."""
    records = state.records
    robot = int(records.robot[record])
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
    if state.graph.group.size > 0:
        sweep_plan(state, record)


@compiled
def is_exchange(state: State, slot: int, tick: int, target: int) -> bool:
    """Whether leaving the window at the tick for `target` meets a committed robot that comes from there, or close.

    In a resource of capacity 1 in no group that robot is the one that ends the window, so the tick is the window's end;
    where following is forbidden, none exists. Into a group of capacity 1 that holds the resource of the window, no
    robot moves from within, as it would be in the way.
    """
    graph = state.graph
    resource = int(state.windows.resource[slot])
    if graph.capacity[resource] == 1:
        return bool(state.windows.end[slot] == tick and are_close(graph, int(state.windows.source[slot]), target))
    if comes_from(state, resource, tick, target):
        return True
    for k in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
        constraint = graph.capacity.size + int(graph.group[k])
        if graph.room[constraint] == 1 and comes_from(state, constraint, tick, target):
            return True
    return False


@compiled
def comes_from(state: State, constraint: int, tick: int, target: int) -> bool:
    """Whether a committed robot enters at the tick what the constraint is on, from the target or close to it."""
    stays = state.stays
    first = int(stays.offset[constraint])
    stay = last_by(stays, constraint, tick)
    while stay >= first and stays.start[stay] == tick:
        if are_close(state.graph, int(stays.source[stay]), target):
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
def opens_at(state: State, resource: int, behind: int) -> int:
    """The tick from which on the resource is free for ever to a robot planned behind that rank; `NEVER`: from none."""
    windows = state.windows
    size = int(windows.size[resource])
    last = int(windows.offset[resource]) + size - 1
    if size == 0 or windows.end[last] < NEVER:
        return NEVER
    return int(windows.start[start_of_run(state, last, behind)])


@compiled
def has_same_order(state: State, record: int, behind: int) -> bool:
    """Whether the query of the plan, asked again behind that rank, would give windows the same keys of `query/ties`."""
    if not state.parks:
        return True
    goal = int(state.robots.goal[state.records.robot[record]])
    return has_order(state.records, record, opens_at(state, goal, behind))


@compiled
def still_found(state: State, record: int) -> bool:
    """Whether the plan found by a query against fewer plans fits the windows, and is found again."""
    return has_same_order(state, record, NEVER) and plan_fits(state, record)


@compiled
def stand(state: State, resource: int, enter: int, behind: int) -> int:
    """Copy the window around the tick into the slot `STANDING`; return its own slot."""
    windows = state.windows
    slot = last_by(windows, resource, enter)
    last = end_of_run(state, slot, behind)
    windows.resource[STANDING] = resource
    windows.end[STANDING] = windows.end[last]
    windows.source[STANDING] = windows.source[last]
    return start_of_run(state, slot, behind)


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
