"""The end of a search whose goal, or what leads there, is free late: found without the windows of a smaller f.

A robot that parks ends its plan in the last window of its goal. Where that opens late, A* first expands all windows of
a smaller f, and a robot that waits on its way has such windows all over the map. Hardly any of them matters.

Let F be the f of the entry of the queue that is next. All windows of a smaller f have been expanded. A window q
that has not is entered at `max(start(q), F - h(q))` or later: its *bound*. Let G be a set of windows not expanded yet,
with the goal's last one. Expand the windows of G by the rule alone, until the goal is entered at its first tick.

Each window of G has a last entry that counts, `until`: for the goal its first tick. What counts for another follows
from the windows w to which it leads. If w is entered by its `until`, an entry of w counts if it is earlier, or the same
and by a parent of no larger f, as parents of equal entries are kept. If it is not, an entry counts by its `until`. An
entry of a window counts if it leads to one that counts. G is *closed* if no window outside has, by its bound, an entry
that counts.

The windows of a closed set that are entered by their `until`, here or in the whole search, have the same entries and
parents in both. Otherwise look at the first that the whole search enters by then earlier, or as early from another
parent. That parent is outside of G, and the bounds allow it; or it is of G, with an entry that counts, so it has the
same entry here, and enters the window here as well. The others only take turns with G in the queue, up to the parent of
the goal. So the plan is that of the whole search.

G is made in turns. For a window that is not entered yet, `trace` looks for a way back by windows that are entered as
they open, those of the least f first, until one is met that is entered. Where there is none, all are put into G that
could enter the window by its `until`. Then G is expanded from where the search stood, and looked at again with the
entries that it now has, until nothing is missing. Only what could win is looked at: a window that comes too late for
those it leads to has an early `until`, by which the bounds allow little. If there are too many windows, or the goal is
not entered at its first tick, all is undone and the search goes on.
"""

from carp_optimized.jit.compiling import compiled
from carp_optimized.queries.guides import toll_of
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.queries.windows import is_exchange, skip_below
from carp_optimized.state.arrays import FURTHER, MOST_GATHERED, NEVER, NONE, State

GOING_ON, ENDED = range(2)
LEFT, TRACES = range(2)  # the counts: looks at windows that are left, and traces
MOST_TRACED = 32  # windows looked at by a trace


@compiled
def end_from(
    state: State, robot: int, slot: int, goal_window: int, own: int, next_f: int, latest: int, budget: int
) -> int:
    """`ENDED` if the goal's last window is entered at its first tick: it and its ancestors have their parents then.

    `own` is the window in which the robot stands, and `next_f` the f of the entry of the queue that is next. The budget
    allows for so many looks at windows. It is `FURTHER` where one that the guide does not reach might be among
    them.
    """
    opens = int(state.windows.start[goal_window])
    if opens <= next_f or opens > latest:
        return GOING_ON
    ending = state.search.ending
    most = min(MOST_GATHERED, 16 + budget // 4)
    ending.counts[LEFT] = budget
    count = put_in(state, 0, goal_window)
    while ending.counts[LEFT] > 0:
        before = count
        count = gather(state, robot, slot, own, next_f, opens, count, most)
        if count < 0:
            undo(state, before)
            return FURTHER if count == FURTHER else GOING_ON
        if count == before:
            if entry_of(state, goal_window) == opens:
                return ENDED
            break
        if count >= most:
            break
        undo(state, before)
        expand_gathered(state, robot, slot, goal_window, count)
        ending.counts[LEFT] -= count
    undo(state, count)
    return GOING_ON


@compiled
def put_in(state: State, count: int, window: int) -> int:
    """Put a window behind those gathered; how many there are then."""
    ending = state.search.ending
    ending.gathered[count] = window
    ending.place[window] = count
    ending.reached[count] = state.search.reached[window]
    ending.parent[count] = state.search.parent[window]
    ending.until[count] = NONE
    ending.is_due[count] = 0
    ending.trace[count] = 0
    return count + 1


@compiled
def put_for(state: State, count: int, window: int, until: int) -> int:
    """Gather a window, unless it is, for entries until that tick; how many are gathered then."""
    ending = state.search.ending
    if not is_gathered(state, count, window):
        count = put_in(state, count, window)
    place = ending.place[window]
    if until > ending.until[place]:
        ending.until[place] = until
        ending.is_due[place] = 1
    return count


@compiled
def undo(state: State, count: int) -> None:
    """Give the windows gathered the entries and parents that they had before."""
    ending = state.search.ending
    for k in range(count):
        state.search.reached[ending.gathered[k]] = ending.reached[k]
        state.search.parent[ending.gathered[k]] = ending.parent[k]


@compiled
def entry_of(state: State, window: int) -> int:
    """The tick at which the query enters a window until now; `NEVER` if it does not."""
    entry = (int(state.search.generation[0]) << 32) - int(state.search.reached[window])
    return min(entry, NEVER)


@compiled
def key_of(state: State, slot: int, window: int) -> int:
    """The key of `query/ties` of a window that is entered."""
    return (entry_of(state, window) << 32) + toll_of(state, slot, int(state.windows.resource[window]))


@compiled
def f_of(state: State, slot: int, window: int) -> int:
    """The f of a window, whether it is entered or not."""
    return entry_of(state, window) + (toll_of(state, slot, int(state.windows.resource[window])) >> 32)


@compiled
def is_gathered(state: State, count: int, window: int) -> bool:
    """Whether a window is among those gathered."""
    ending = state.search.ending
    place = int(ending.place[window])
    return place < count and ending.gathered[place] == window


@compiled
def gather(state: State, robot: int, slot: int, own: int, next_f: int, opens: int, count: int, most: int) -> int:
    """Gather the windows missing; how many there are then, never more than `MOST_GATHERED`; `FURTHER`; or `NONE`.

    It is `NONE` where that would take too long.
    """
    ending = state.search.ending
    for place in range(count):
        ending.until[place] = NONE
        ending.is_due[place] = 0
    ending.until[0] = opens
    ending.is_due[0] = 1
    place = 0
    idle = 0
    while 0 <= idle < count < most:
        idle += 1
        if ending.is_due[place] == 1:
            if ending.counts[LEFT] <= 0:
                return NONE
            ending.counts[LEFT] -= 1
            ending.is_due[place] = 0
            count = look_behind(state, robot, slot, own, next_f, place, count, most)
            idle = 0
        place = place + 1 if place + 1 < count else 0
    return count


@compiled
def look_behind(state: State, robot: int, slot: int, own: int, next_f: int, place: int, count: int, most: int) -> int:
    """Gather what is missing for the window gathered in that place; how many there are then, or `FURTHER`."""
    ending = state.search.ending
    window = int(ending.gathered[place])
    entry = entry_of(state, window)
    until = int(ending.until[place])
    if entry <= until:
        parent = int(state.search.parent[window])
        parents_f = f_of(state, slot, parent) if is_gathered(state, count, parent) else NONE
        return look_before(state, robot, slot, window, own, next_f, entry - 1, parents_f, count)
    before = count
    if entry == NEVER:
        count = trace(state, robot, slot, place, own, next_f, count, most)
    if count == before:
        count = look_before(state, robot, slot, window, own, next_f, until, NONE, count)
    return count


@compiled
def trace(  # noqa: C901 - one loop
    state: State, robot: int, slot: int, place: int, own: int, next_f: int, count: int, most: int
) -> int:
    """Gather a way back from the window gathered there, by windows that are entered as they open, to one entered.

    Returns how many are gathered then, or `FURTHER`.
    """
    graph = state.graph
    windows = state.windows
    ending = state.search.ending
    pace = int(state.robots.pace[robot])
    ending.counts[TRACES] += 1
    this = int(ending.counts[TRACES])
    ending.keys[0] = 0
    ending.nodes[0] = place
    size = 1
    left = MOST_TRACED
    while size > 0 and count < most and left > 0:
        window = int(ending.gathered[ending.nodes[0]])
        size -= 1
        replace_root(ending.keys, ending.nodes, size, int(ending.keys[size]), int(ending.nodes[size]))
        left -= 1
        ending.counts[LEFT] -= 1
        if entry_of(state, window) != NEVER:
            break
        resource = int(windows.resource[window])
        opens = int(windows.start[window])
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            toll = toll_of(state, slot, source)
            if toll == FURTHER:
                return FURTHER
            if toll < 0:
                continue
            to_goal = toll >> 32
            last = opens - pace * int(graph.duration[source])
            row_end = int(windows.offset[source]) + int(windows.size[source])
            before = skip_below(windows.end, int(windows.offset[source]), row_end, opens)
            while before < row_end and windows.start[before] <= last:
                entry = entry_of(state, before)
                if entry == NEVER:
                    entry = int(windows.start[before])
                may = next_f - to_goal <= entry <= last and before != own
                if may and not is_exchange(state, before, opens, resource):
                    if not is_gathered(state, count, before):
                        count = put_in(state, count, before)
                        if count == MOST_GATHERED:
                            return count
                    there = int(ending.place[before])
                    if ending.trace[there] != this:
                        ending.trace[there] = this
                        push(ending.keys, ending.nodes, size, entry + to_goal, there)
                        size += 1
                before += 1
    return count


@compiled
def look_before(
    state: State,
    robot: int,
    slot: int,
    window: int,
    own: int,
    next_f: int,
    last_entry: int,
    parents_f: int,
    count: int,
) -> int:
    """Gather the windows missing that could give this one an entry that counts.

    Such an entry is by `last_entry`, or the next tick if its parent has an f up to `parents_f`. Returns how many are
    gathered then, or `FURTHER`.
    """
    graph = state.graph
    windows = state.windows
    pace = int(state.robots.pace[robot])
    resource = int(windows.resource[window])
    opens = int(windows.start[window])
    tie = last_entry + 1
    for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
        source = int(graph.source[edge])
        toll = toll_of(state, slot, source)
        if toll == FURTHER:
            return FURTHER
        if toll < 0:
            continue
        to_goal = toll >> 32
        need = pace * int(graph.duration[source])
        last = last_entry - need if last_entry >= opens else NONE
        if parents_f != NONE:
            last = max(last, min(tie - need, parents_f - to_goal))
        row_end = int(windows.offset[source]) + int(windows.size[source])
        before = skip_below(windows.end, int(windows.offset[source]), row_end, opens)
        while before < row_end:
            entry = max(int(windows.start[before]), next_f - to_goal)
            if entry > last:
                break
            until = min(last, int(windows.end[before]) - need)
            if entry <= until and before != own and f_of(state, slot, before) >= next_f:
                count = put_for(state, count, before, until)
                if count == MOST_GATHERED:
                    return count
            before += 1
    return count


@compiled
def expand_gathered(state: State, robot: int, slot: int, goal_window: int, count: int) -> None:
    """Expand the windows gathered in the order of `query/ties`, until the goal is entered at its first tick."""
    ending = state.search.ending
    latest = int(state.windows.start[goal_window])
    size = 0
    for k in range(count):
        window = int(ending.gathered[k])
        if entry_of(state, window) != NEVER:
            push(ending.keys, ending.nodes, size, key_of(state, slot, window), window)
            size += 1
    while size > 0 and entry_of(state, goal_window) != latest:
        key = int(ending.keys[0])
        window = int(ending.nodes[0])
        size -= 1
        replace_root(ending.keys, ending.nodes, size, int(ending.keys[size]), int(ending.nodes[size]))
        if key == key_of(state, slot, window):
            size = expand_one(state, robot, slot, window, count, size, latest)


@compiled
def expand_one(state: State, robot: int, slot: int, node: int, count: int, size: int, latest: int) -> int:
    """Expand a window, as far as it leads to windows gathered; the size of the heap then."""
    graph = state.graph
    windows = state.windows
    ending = state.search.ending
    pace = int(state.robots.pace[robot])
    label = int(state.search.generation[0]) << 32
    resource = int(windows.resource[node])
    ready = entry_of(state, node) + pace * int(graph.duration[resource])
    end = int(windows.end[node])
    for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
        target = int(graph.target[edge])
        toll = toll_of(state, slot, target)
        if toll < 0:
            continue
        need = pace * int(graph.duration[target])
        row_end = int(windows.offset[target]) + int(windows.size[target])
        window = skip_below(windows.end, int(windows.offset[target]), row_end, ready + need)
        while window < row_end:
            entry = max(ready, int(windows.start[window]))
            if entry > end or entry + (toll >> 32) > latest:
                break
            if is_gathered(state, count, window):
                while entry <= end and is_exchange(state, node, entry, target):
                    entry += 1
                if entry <= end and entry + need <= windows.end[window] and entry < entry_of(state, window):
                    state.search.reached[window] = label - entry
                    state.search.parent[window] = node
                    push(ending.keys, ending.nodes, size, (entry << 32) + toll, window)
                    size += 1
            window += 1
    return size
