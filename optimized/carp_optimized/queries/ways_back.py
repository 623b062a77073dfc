"""Whether windows lead back from the goal to where a query has come: where none do, it has no plan to find.

A* that finds no plan expands all windows to which it can come, which may be those of the whole map. Mostly a few robots
that park cut off the goal, so that few windows lead there. They are looked at backwards, from the goal's last one.

Each has an `until`, by which it must be entered: so early that the robot can go on by the `until` of another of them,
whatever they forbid besides. The latest `until` comes first, so each window is looked at once. All windows of a plan
are among them and entered by their `until`, beginning with the last. The first is the one in which the robot stands,
which the query has entered. So if none of them is entered by its `until`, there is no plan.

Windows are left out that come too late. Let F be the least f in the queue, where it is known. Whatever the query
enters from now on has no smaller f, so it enters a window q at F - h(q) or later. If it has not entered q by its
`until`, and that is later, q is in no plan.

The look ends at a window that is entered by then, for the goal is likely to be reached from there.
"""

from carp_optimized.jit.compiling import compiled
from carp_optimized.queries.guides import toll_of
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.state.arrays import NEVER, NONE, State
from carp_optimized.windows.rows import skip_below

CUT_OFF = 0
FEWEST = 64  # windows that any look may take


@compiled
def entry_of(state: State, window: int) -> int:
    """The tick at which the query enters a window until now; `NEVER` if it does not."""
    entry = (int(state.search.generation[0]) << 32) - int(state.search.reached[window])
    return min(entry, NEVER)


@compiled
def look_back(state: State, robot: int, slot: int, next_f: int, latest: int, expansions: int) -> int:
    """The expansions of a query until the next look; `CUT_OFF` if no windows lead back to one that it has entered.

    All robots count, and a plan is to enter the last window of the goal, which is free for ever, by the tick `latest`.
    No entry of the query's queue has an f below `next_f`, with the h of the guide in the slot; the slot is `NONE` if h
    is not that of a guide. A look takes at most `FEWEST` windows and a quarter of those that the query has expanded.
    """
    graph = state.graph
    windows = state.windows
    back = state.search.back
    goal = int(state.robots.goal[robot])
    goal_window = int(windows.offset[goal]) + int(windows.size[goal]) - 1
    pace = int(state.robots.pace[robot])
    latest = min(latest, NEVER - 1)
    left = FEWEST + expansions // 4
    back.looks[0] += 1
    look = int(back.looks[0]) << 32
    back.until[goal_window] = look + latest
    back.keys[0] = -latest
    back.nodes[0] = goal_window
    size = 1
    while size > 0:
        until = -int(back.keys[0])
        window = int(back.nodes[0])
        size -= 1
        replace_root(back.keys, back.nodes, size, int(back.keys[size]), int(back.nodes[size]))
        if back.until[window] != look + until:
            continue  # it has a later one since this entry was made
        if entry_of(state, window) <= until:
            return NEVER
        left -= 1
        if left == 0:
            return 4 * expansions
        resource = int(windows.resource[window])
        opens = int(windows.start[window])
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            need = pace * int(graph.duration[source])
            toll = toll_of(state, slot, source) if slot != NONE else NONE
            from_now_on = next_f - (toll >> 32) if toll >= 0 else 0
            row_end = int(windows.offset[source]) + int(windows.size[source])
            before = skip_below(windows.end, int(windows.offset[source]), row_end, opens)
            while before < row_end and windows.start[before] + need <= until:
                last = min(until, int(windows.end[before]))
                entry = min(entry_of(state, before), max(int(windows.start[before]), from_now_on))
                is_long = last >= max(opens, entry + need)
                if is_long and back.until[before] < look + last - need:
                    back.until[before] = look + last - need
                    push(back.keys, back.nodes, size, need - last, before)
                    size += 1
                before += 1
    return CUT_OFF
