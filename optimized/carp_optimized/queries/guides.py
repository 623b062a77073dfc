"""The h of A*, exact on the empty graph: from the goal along the moves backwards, one per destination.

A robot that leaves a resource has stayed there for its duration, wherever it goes. So a resource gets its ticks from
the first one reached to which it leads. Resources are reached level by level, or where durations are long, in the order
of a heap. Both end a detour behind the start of the robot that asks: what is further from the goal lies on no plan,
unless robots in the way cost more than the detour. A query that might have looked further than its guide has it made to
its end, and asks again.
"""

from carp_optimized.jit.compiling import RoomExhausted, compiled, inlined
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.state.arrays import (
    FIRST,
    FURTHER,
    LARGEST,
    LOW,
    NEVER,
    NONE,
    SOON,
    TICK_BITS,
    TOO_FAR,
    UNREACHABLE,
    Guides,
    State,
)

GREED = 2  # of a greedy query: its h counts so many times more
EFFORT, LEAST_EFFORT = 16, 1024  # of a query for what is found soon: expansions for each tick to the goal, and besides
MOST_LEVELS = 256  # the longest duration, where guides are made level by level


@compiled
def guide_slot(state: State, robot: int, resource: int) -> int:
    """The slot that holds the guide of the robot's destination, made as far as the resource at least."""
    guides = state.guides
    destination = int(state.robots.destination[robot])
    slot = int(guides.slot[destination])
    if slot == NONE:
        slot = next_slot(guides)
        reach(state, slot, destination, int(state.robots.start[robot]), guides.detour)
    if guides.ticks[slot][resource] == FURTHER:
        reach_all(state, slot)
    return slot


@compiled
def guide_of(state: State, destination: int) -> int:
    """The slot that holds the guide of a destination of stops, made as far as moves lead."""
    guides = state.guides
    if guides.slot[destination] == NONE:
        reach(state, next_slot(guides), destination, int(guides.goal[destination]), LARGEST)
    return int(guides.slot[destination])


@compiled
def next_slot(guides: Guides) -> int:
    """The slot to be given away, whose guide is lost."""
    slot = int(guides.next[0])
    guides.next[0] = (slot + 1) % guides.holds.size
    if guides.holds[slot] != NONE:
        guides.slot[guides.holds[slot]] = NONE
    return slot


@compiled
def reach_all(state: State, slot: int) -> None:
    """Make a guide again, as far as moves lead."""
    destination = int(state.guides.holds[slot])
    state.guides.slot[destination] = NONE
    reach(state, slot, destination, int(state.guides.goal[destination]), LARGEST)


@compiled
def reach(state: State, slot: int, destination: int, start: int, detour: int) -> None:
    """Make a guide as far as the start, and further by as many of the longest durations as a detour has."""
    guides = state.guides
    guides.holds[slot] = NONE
    if state.longest <= MOST_LEVELS:
        make_level_guide(state, slot, destination, start, detour)
    else:
        make_guide(state, slot, destination, start, detour)
    guides.slot[destination] = slot
    guides.holds[slot] = destination


@compiled
def toll_of(state: State, slot: int, resource: int) -> int:
    """The ticks to the goal times 2^32 plus the place of the resource in their order; below 0: a mark of the guide."""
    ticks = int(state.guides.ticks[slot][resource])
    if ticks < 0:
        return ticks
    if state.scale > 0:
        return ticks * state.scale + resource
    return (ticks << 32) + int(state.guides.rank[slot][resource])


@inlined
def key_of(entry: int, toll: int, opens: int) -> int:
    """The key of `query/ties` of a window entered at that tick: windows of an f up to `opens` come first.

    f fills the upper half and the rest of the toll, which is the order of (h, index), the lower. Of the windows that
    come first, that order fills the upper part and the tick the lower, and their keys are below 0.
    """
    key = (entry << 32) + toll
    if key >> 32 > opens:
        return key
    return ((toll & LOW) << TICK_BITS) + entry + FIRST


@inlined
def greedy_f(entry: int, to_goal: int, opens: int, greed: int) -> int:
    """The f of a greedy query: h counts more, and all ways to the goal take until it `opens`."""
    return max(entry + to_goal, opens) + min(to_goal * greed, LARGEST)


@inlined
def effort_of(asked: int, to_goal: int) -> int:
    """The expansions after which a query ends without a plan; `NEVER` but for `SOON` and `GREEDY`."""
    return EFFORT * to_goal + LEAST_EFFORT if asked >= SOON else NEVER


@compiled
def make_level_guide(  # noqa: C901 - one loop
    state: State, slot: int, destination: int, start: int, detour: int
) -> None:
    """Reach the resources level by level, where a level is the duration of all, or a tick for a robot of pace 1.

    `head` has the resources of the levels to come, in a ring, each with the next one in `behind`.
    """
    graph = state.graph
    ticks = state.guides.ticks[slot]
    behind = state.search.nodes
    head = state.search.back.nodes
    widest = 1 if state.last_alike else state.longest
    step = int(state.guides.pace[destination]) * (state.longest if state.last_alike else 1)
    if min(behind.size, head.size) <= max(ticks.size, widest):
        raise RoomExhausted
    for resource in range(ticks.size):
        ticks[resource] = FURTHER
    for level in range(widest + 1):
        head[level] = NONE
    goal = int(state.guides.goal[destination])
    ticks[goal] = 0
    behind[goal] = NONE
    head[0] = goal
    left = 1
    level = 0
    here = 0
    largest = LARGEST // step
    last = largest
    while left > 0 and level <= last:
        resource = int(head[here])
        head[here] = NONE
        while resource != NONE:
            left -= 1
            if resource == start:
                last = min(largest, level + detour * widest)
            for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
                source = int(graph.source[edge])
                if ticks[source] == FURTHER:
                    more = 1 if widest == 1 else int(graph.duration[source])
                    left += 1
                    if level + more <= last:
                        ticks[source] = (level + more) * step
                        there = here + more if here + more <= widest else here + more - widest - 1
                        behind[source] = head[there]
                        head[there] = source
            resource = int(behind[resource])
        level += 1
        here = here + 1 if here < widest else 0
    if state.scale == 0:
        rank_by_levels(state, slot, step, level + widest)
    if left == 0 or level > last == largest:
        close_guide(state, slot)


@compiled
def rank_by_levels(state: State, slot: int, step: int, levels: int) -> None:
    """Rank the resources, which are on so many levels, by level and index."""
    first = state.search.keys
    ticks = state.guides.ticks[slot]
    rank = state.guides.rank[slot]
    if first.size <= levels:
        raise RoomExhausted
    for level in range(levels + 1):
        first[level] = 0
    for resource in range(ticks.size):
        if ticks[resource] >= 0:
            first[int(ticks[resource]) // step + 1] += 1
    for level in range(levels):
        first[level + 1] += first[level]
    for resource in range(ticks.size):
        if ticks[resource] >= 0:
            level = int(ticks[resource]) // step
            rank[resource] = first[level]
            first[level] += 1


@compiled
def make_guide(state: State, slot: int, destination: int, start: int, detour: int) -> None:
    """Reach the resources in the order of (ticks to the goal, index), which is the order of their ranks."""
    graph = state.graph
    keys = state.search.keys
    nodes = state.search.nodes
    ticks = state.guides.ticks[slot]
    pace = int(state.guides.pace[destination])
    goal = int(state.guides.goal[destination])
    for resource in range(ticks.size):
        ticks[resource] = FURTHER
    ticks[goal] = 0
    keys[0] = goal
    nodes[0] = goal
    size = 1
    reached = 0
    last = LARGEST
    while size > 0 and keys[0] >> 32 <= last:
        resource = int(nodes[0])
        size -= 1
        replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        to_goal = int(ticks[resource])
        if state.scale == 0:
            state.guides.rank[slot][resource] = reached
        reached += 1
        if resource == start:
            last = min(last, to_goal + detour * pace * state.longest)
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            further = to_goal + pace * int(graph.duration[source])
            if ticks[source] == FURTHER and further <= LARGEST:
                ticks[source] = further
                push(keys, nodes, size, (further << 32) + source, source)
                size += 1
    for k in range(size):
        ticks[nodes[k]] = FURTHER
    if size == 0:
        close_guide(state, slot)


@compiled
def close_guide(state: State, slot: int) -> None:
    """Tell what leads to the goal in too many ticks from what does not lead there: no other resource is left."""
    graph = state.graph
    ticks = state.guides.ticks[slot]
    queue = state.search.nodes
    if queue.size < ticks.size:
        raise RoomExhausted
    count = 0
    for resource in range(ticks.size):
        if ticks[resource] == FURTHER:
            ticks[resource] = UNREACHABLE
            for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
                if ticks[graph.target[edge]] >= 0:
                    ticks[resource] = TOO_FAR
            if ticks[resource] == TOO_FAR:
                queue[count] = resource
                count += 1
    done = 0
    while done < count:
        resource = int(queue[done])
        done += 1
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            if ticks[source] == UNREACHABLE:
                ticks[source] = TOO_FAR
                queue[count] = source
                count += 1
