"""Windows made again from stays, where a resource has a capacity above 1 or is in groups.

A window is where each constraint on the resource has room.
"""

from carp_optimized.jit.compiling import compiled, inlined
from carp_optimized.state.arrays import NEVER, NONE, Graph, Rows, State
from carp_optimized.windows.rows import clear_row, make_room


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
def sweep_plan(state: State, record: int) -> None:
    """Make the windows again of all resources in the groups of those that the plan visits, as `sweep_group` does."""
    graph = state.graph
    records = state.records
    first = int(records.visits_at[record])
    for visit in range(first, first + int(records.visits[record])):
        resource = int(records.resource[visit])
        for k in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
            sweep_group(state, int(graph.group[k]))
