"""The end of a search whose goal, or what leads there, is free late: found without the windows of a smaller f.

A robot that parks ends its plan in the last window of its goal. Where that opens late, A* first expands all windows of
a smaller f, and a robot that waits on its way has such windows all over the map. Hardly any of them matters.

Let F be the f of the entry of the queue that is next. All windows of a smaller f have been expanded. A window q
that has not is entered at `max(start(q), F - h(q))` or later, and its f is at least that with h(q). What it gives to
another window counts only if that is earlier than the entry the other has, or the same and by a parent expanded before,
as parents of equal entries are kept. Let G be a set of windows not expanded yet, with the goal's last one, and expand
the windows of G by the rule alone, until the goal is entered at its first tick. G is *closed* if no window outside
could, by these bounds, be expanded by then and give one of G an entry that counts.

The windows of a closed set have the entries and parents that they have in the whole search. Otherwise look at the first
window outside from which the whole search enters one of G earlier, or as early from an earlier parent: by then all of G
have had what they have here, so that window is one that the bounds allow. The others only take turns with G in the
queue. So the plan is that of the whole search.

G is made in turns. Windows that could give one of G an entry that counts are put into it; one that is not entered yet
is taken to be entered as early as it can, as such guesses need few windows. Then G is expanded from where the search
stood, and looked at again with the entries that it now has, until nothing is missing. If there are too many windows, or
the goal is not entered at its first tick, all is undone and the search goes on.
"""

from carp_optimized.jit.compiling import compiled
from carp_optimized.queries.guides import toll_of
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.queries.windows import is_exchange, skip_below
from carp_optimized.state.arrays import FURTHER, MOST_GATHERED, NEVER, NONE, State

GOING_ON, ENDED = range(2)


@compiled
def end_from(
    state: State, robot: int, slot: int, goal_window: int, own: int, next_f: int, latest: int, budget: int
) -> int:
    """`ENDED` if the goal's last window is entered at its first tick: it and its ancestors have their parents then.

    `own` is the window in which the robot stands, and `next_f` the f of the entry of the queue that is next. As many
    windows are looked at as the budget allows. It is `FURTHER` where one that the guide does not reach might be among
    them.
    """
    opens = int(state.windows.start[goal_window])
    if opens <= next_f or opens > latest:
        return GOING_ON
    limit = opens
    played = 0
    most = min(MOST_GATHERED, 16 + budget // 4)
    count = put_in(state, 0, goal_window)
    while budget > 0:
        before = count
        count = gather(state, robot, slot, goal_window, own, next_f, limit, count, most)
        if count == FURTHER:
            undo(state, before)
            return FURTHER
        if count == played:
            if entry_of(state, goal_window) == opens:
                return ENDED
            break
        if count >= most:
            break
        undo(state, before)
        limit = expand_gathered(state, robot, slot, goal_window, count)
        played = count
        budget -= count
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
    ending.is_guessed[count] = 0
    return count + 1


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
def f_of(state: State, slot: int, window: int) -> int:
    """The f of a window that is entered."""
    return entry_of(state, window) + (toll_of(state, slot, int(state.windows.resource[window])) >> 32)


@compiled
def is_gathered(state: State, count: int, window: int) -> bool:
    """Whether a window is among those gathered."""
    ending = state.search.ending
    place = int(ending.place[window])
    return place < count and ending.gathered[place] == window


@compiled
def gather(
    state: State, robot: int, slot: int, goal_window: int, own: int, next_f: int, limit: int, count: int, most: int
) -> int:
    """Gather the windows missing, with an f of up to the limit; how many there are then, or `FURTHER`.

    There are never more than `MOST_GATHERED`.
    """
    ending = state.search.ending
    windows = state.windows
    done = 0
    while 0 <= done < count < most:
        window = int(ending.gathered[done])
        resource = int(windows.resource[window])
        to_goal = toll_of(state, slot, resource) >> 32
        need = int(state.robots.pace[robot]) * int(state.graph.duration[resource])
        last = min(int(windows.end[window]) - need, limit - to_goal)
        if window == goal_window:
            last = int(windows.start[window])
        before = count
        if entry_of(state, window) == NEVER:
            first = min(last, max(int(windows.start[window]), next_f - to_goal))
            least = limit
            if ending.is_guessed[done] == 0:
                ending.is_guessed[done] = 1
                least = look_before(state, robot, slot, window, own, next_f, first, limit, count, False)
                if least == FURTHER:
                    return FURTHER
            count = look_before(state, robot, slot, window, own, next_f, first, least, count, True)
        if count == before:
            count = look_before(state, robot, slot, window, own, next_f, last, limit, count, True)
        done += 1
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
    limit: int,
    count: int,
    puts: bool,
) -> int:
    """Gather the windows missing that could give this one an entry that counts; how many there are then, or `FURTHER`.

    If nothing is to be put: the least f that one of them can have.
    """
    graph = state.graph
    windows = state.windows
    pace = int(state.robots.pace[robot])
    resource = int(windows.resource[window])
    opens = int(windows.start[window])
    known = entry_of(state, window)
    parents_f = NONE  # of a parent whose entry might have to give way to an equal one
    if known != NEVER and is_gathered(state, count, int(state.search.parent[window])):
        parents_f = f_of(state, slot, int(state.search.parent[window]))
    last_entry = min(last_entry, known if parents_f != NONE else known - 1)
    least = limit
    if last_entry >= opens:
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            toll = toll_of(state, slot, source)
            if toll == FURTHER:
                return FURTHER
            to_goal = toll >> 32
            need = pace * int(graph.duration[source])
            row_end = int(windows.offset[source]) + int(windows.size[source])
            before = skip_below(windows.end, int(windows.offset[source]), row_end, opens)
            while before < row_end:
                entry = max(int(windows.start[before]), next_f - to_goal)
                if toll < 0 or entry + need > last_entry or entry + to_goal > limit:
                    break
                is_known = max(entry + need, opens) == known and entry + to_goal > parents_f
                if (
                    entry + need <= windows.end[before]
                    and not is_known
                    and before != own
                    and f_of(state, slot, before) >= next_f
                ):
                    least = min(least, entry + to_goal)
                    if puts and not is_gathered(state, count, before):
                        count = put_in(state, count, before)
                        if count == MOST_GATHERED:
                            return count
                before += 1
    return count if puts else least


@compiled
def expand_gathered(state: State, robot: int, slot: int, goal_window: int, count: int) -> int:
    """Expand the windows gathered in the order of `query/ties`, until the goal is entered at its first tick.

    Returns the largest f of a window expanded then.
    """
    ending = state.search.ending
    windows = state.windows
    latest = int(windows.start[goal_window])
    size = 0
    for k in range(count):
        window = int(ending.gathered[k])
        entry = entry_of(state, window)
        if entry != NEVER:
            push(
                ending.keys,
                ending.nodes,
                size,
                (entry << 32) + toll_of(state, slot, int(windows.resource[window])),
                window,
            )
            size += 1
    while size > 0:
        key = int(ending.keys[0])
        window = int(ending.nodes[0])
        size -= 1
        replace_root(ending.keys, ending.nodes, size, int(ending.keys[size]), int(ending.nodes[size]))
        if key == (entry_of(state, window) << 32) + toll_of(state, slot, int(windows.resource[window])):
            size = expand_one(state, robot, slot, window, count, size, latest)
            if entry_of(state, goal_window) == latest:
                return key >> 32
    return latest


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
