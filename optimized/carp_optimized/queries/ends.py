"""The end of a search whose goal, or what leads there, is free late: found without the windows of a smaller f.

A robot that parks ends its plan in the last window of its goal. Where that opens late, A* first expands all windows of
a smaller f, and a robot that waits on its way has such windows all over the map. Hardly any of them matters.

Let F be the f of the entry of the queue that is next. All windows of a smaller f have been expanded. A window q
that has not is entered at `max(start(q), F - h(q))` or later, and its f is at least that with h(q). What it gives to
another window counts only if that is earlier than the entry the other has, as parents of equal entries are kept. So of
the windows not expanded yet, only some can have a say in when, and from where, the goal is entered at its first tick:
those that lead into it by then, and, again and again, those that lead into one of these before the entry that it has.
They are gathered backward from the goal. Expanded by the rule alone, they have the entries and parents that they have
among all others, which only take turns with them in the queue. So the plan is that of the whole search.

They are gathered in rounds, in each only those whose f may be up to a limit; then those of them with such an f are
expanded, in order. No other window has such an f and a say in these. As the entries so found cut off more and more of
what leads there, the next round, with a larger limit, gathers afresh. A window without a say in one round may have
one in the next, as it leads to a window that only then is gathered. If its f is below the limits before, it is expanded
too late. So where its entry into a window is that of a parent expanded in a round, and its f is not the larger one, or
if too many windows are gathered, all is undone and the search goes on.
"""

from carp_optimized.jit.compiling import compiled
from carp_optimized.queries.guides import toll_of
from carp_optimized.queries.windows import is_exchange, skip_below
from carp_optimized.state.arrays import FURTHER, MOST_GATHERED, NEVER, NO_LIMIT, NONE, State

EXPANDED, CHANGED, NEXT_LIMIT = range(3)  # the counts of `Ending`
GOING_ON, ENDED, UNCLEAR = range(3)


@compiled
def end_from(
    state: State, robot: int, slot: int, goal_window: int, own: int, next_f: int, latest: int, budget: int
) -> int:
    """`ENDED` if the goal's last window is entered at its first tick: it and its ancestors have their parents then.

    `own` is the window in which the robot stands, and `next_f` the f of the entry of the queue that is next. As many
    windows are gathered as the budget allows. It is `FURTHER` where one that the guide does not reach might be among
    them.
    """
    counts = state.search.ending.counts
    opens = int(state.windows.start[goal_window])
    if opens <= next_f or opens > latest:
        return GOING_ON
    counts[EXPANDED] = 0
    counts[CHANGED] = 0
    before = next_f - 1
    limit = next_f
    while budget > 0:
        expanded = int(counts[EXPANDED])
        count = gather(state, robot, slot, goal_window, own, next_f, limit)
        budget -= count
        if count == FURTHER:
            undo(state)
            return FURTHER
        if count == 0:
            break
        result = expand_gathered(state, robot, slot, count, before, limit, goal_window)
        if result == ENDED:
            return ENDED
        if result == UNCLEAR or (limit == opens and counts[EXPANDED] == expanded):
            break
        before = limit
        limit = min(opens, max(int(counts[NEXT_LIMIT]), limit + 1))
    undo(state)
    return GOING_ON


@compiled
def undo(state: State) -> None:
    """Undo all changes of entries and parents, the last one first."""
    search = state.search
    ending = search.ending
    for k in range(int(ending.counts[CHANGED]) - 1, -1, -1):
        search.reached[ending.changed[k]] = ending.reached[k]
        search.parent[ending.changed[k]] = ending.parent[k]


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
def is_among_first(state: State, count: int, window: int) -> bool:
    """Whether a window is among the first that were gathered; of these, the first were expanded."""
    ending = state.search.ending
    place = int(ending.place[window])
    return place < count and ending.gathered[place] == window


@compiled
def gather(  # noqa: C901 - four loops, one in the other
    state: State, robot: int, slot: int, goal_window: int, own: int, next_f: int, limit: int
) -> int:
    """Gather the windows, with an f that may be up to the limit, that have a say in how the goal is entered.

    They are put behind those expanded. Returns how many there are with these, 0: too many, or `FURTHER`. The least
    larger f of a window left out becomes the next limit.
    """
    graph = state.graph
    windows = state.windows
    ending = state.search.ending
    pace = int(state.robots.pace[robot])
    latest = int(windows.start[goal_window])
    expanded = int(ending.counts[EXPANDED])
    done = expanded
    if expanded == MOST_GATHERED:
        return 0
    ending.gathered[expanded] = goal_window
    ending.place[goal_window] = expanded
    count = expanded + 1
    next_limit = NEVER
    while done < count:
        window = int(ending.gathered[done])
        done += 1
        resource = int(windows.resource[window])
        opens = int(windows.start[window])
        to_goal = toll_of(state, slot, resource) >> 32
        last_entry = min(int(windows.end[window]) - pace * int(graph.duration[resource]), latest - to_goal)
        known = entry_of(state, window)
        parents_f = NONE  # of a parent whose entry might have to give way to an equal one
        if known != NEVER and is_among_first(state, expanded, int(state.search.parent[window])):
            parents_f = f_of(state, slot, int(state.search.parent[window]))
        last_entry = min(last_entry, known if parents_f != NONE else known - 1)
        if last_entry < opens:
            continue
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
                if toll < 0 or entry + need > last_entry or entry + to_goal > latest:
                    break
                is_known = max(entry + need, opens) == known and entry + to_goal > parents_f
                if entry + to_goal > limit:
                    next_limit = min(next_limit, entry + to_goal)
                    break
                if (
                    entry + need <= windows.end[before]
                    and not is_known
                    and before != own
                    and f_of(state, slot, before) >= next_f
                    and not is_among_first(state, count, before)
                ):
                    if count == MOST_GATHERED:
                        return 0
                    ending.gathered[count] = before
                    ending.place[before] = count
                    count += 1
                before += 1
    ending.counts[NEXT_LIMIT] = next_limit
    return count


@compiled
def expand_gathered(state: State, robot: int, slot: int, count: int, before: int, limit: int, goal_window: int) -> int:
    """Expand, in the order of `query/ties`, the windows gathered whose f is up to the limit; those before had `before`.

    Returns whether that ends the search.
    """
    ending = state.search.ending
    for k in range(int(ending.counts[EXPANDED]), count):
        window = int(ending.gathered[k])
        entry = entry_of(state, window)
        toll = toll_of(state, slot, int(state.windows.resource[window]))
        ending.key[k] = NO_LIMIT if entry == NEVER else (entry << 32) + toll
    while True:
        first = int(ending.counts[EXPANDED])
        least = first
        for k in range(first + 1, count):
            if ending.key[k] < ending.key[least]:
                least = k
        if first == count or ending.key[least] >> 32 > limit:
            return GOING_ON
        window = int(ending.gathered[least])
        other = int(ending.gathered[first])
        ending.gathered[least] = other
        ending.key[least] = ending.key[first]
        ending.place[other] = least
        ending.gathered[first] = window
        ending.place[window] = first
        ending.counts[EXPANDED] = first + 1
        result = expand_one(state, robot, slot, window, count, before, goal_window)
        if result != GOING_ON:
            return result


@compiled
def expand_one(  # noqa: C901 - the hot loop of a search once more
    state: State, robot: int, slot: int, node: int, count: int, before: int, goal_window: int
) -> int:
    """Expand a window; whether that ends the search."""
    graph = state.graph
    windows = state.windows
    pace = int(state.robots.pace[robot])
    expanded = int(state.search.ending.counts[EXPANDED])
    latest = int(windows.start[goal_window])
    resource = int(windows.resource[node])
    f = f_of(state, slot, node)
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
            while entry <= end and is_exchange(state, node, entry, target):
                entry += 1
            if entry > end or entry + (toll >> 32) > latest:
                break
            known = entry_of(state, window)
            if entry + need <= windows.end[window] and entry <= known:
                if entry == known:
                    parent = int(state.search.parent[window])
                    is_late = f <= before and parent != node and is_among_first(state, expanded, parent)
                    if not is_late or f > f_of(state, slot, parent):
                        window += 1
                        continue
                    return UNCLEAR
                if is_among_first(state, expanded, window) or not change(state, window, entry, node):
                    return UNCLEAR
                if window == goal_window and entry == windows.start[window]:
                    return ENDED
                if is_among_first(state, count, window):
                    state.search.ending.key[state.search.ending.place[window]] = (entry << 32) + toll
            window += 1
    return GOING_ON


@compiled
def change(state: State, window: int, entry: int, parent: int) -> bool:
    """Change the entry of a window and its parent; whether there is room to note what they were."""
    search = state.search
    ending = search.ending
    changed = int(ending.counts[CHANGED])
    if changed == ending.changed.size:
        return False
    ending.changed[changed] = window
    ending.reached[changed] = search.reached[window]
    ending.parent[changed] = search.parent[window]
    ending.counts[CHANGED] = changed + 1
    search.reached[window] = (int(search.generation[0]) << 32) - entry
    search.parent[window] = parent
    return True
