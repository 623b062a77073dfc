"""The h of A*, exact on the empty graph: from the goal along the moves backwards, one per destination.

Where all durations are alike, the resources are reached level by level; otherwise by Dijkstra's algorithm.
"""

from carp_optimized.arrays import LARGEST, NONE, TOO_FAR, UNREACHABLE, State
from carp_optimized.compiling import RoomExhausted, compiled
from carp_optimized.heap import push, replace_root


@compiled
def guide_slot(state: State, destination: int) -> int:
    """The slot that holds the guide of the destination; it is made if none exists."""
    guides = state.guides
    slot = int(guides.slot[destination])
    if slot != NONE:
        return slot
    slot = int(guides.next[0])
    guides.next[0] = (slot + 1) % guides.holds.size
    if guides.holds[slot] != NONE:
        guides.slot[guides.holds[slot]] = NONE
    guides.holds[slot] = NONE
    goal = int(guides.goal[destination])
    pace = int(guides.pace[destination])
    if state.last_alike:
        make_level_guide(state, slot, goal, pace * state.longest)
    else:
        make_guide(state, slot, goal, pace)
    guides.slot[destination] = slot
    guides.holds[slot] = destination
    return slot


@compiled
def toll_of(state: State, slot: int, resource: int) -> int:
    """The ticks to the goal times 2^32 plus the place of the resource in their order; below 0: no way."""
    ticks = int(state.guides.ticks[slot][resource])
    if ticks < 0:
        return ticks
    if state.scale > 0:
        return ticks * state.scale + resource
    return (ticks << 32) + int(state.guides.rank[slot][resource])


@compiled
def shortest_of(state: State, robot: int) -> int:
    """The ticks from the robot's start to its goal on the empty graph; below 0: no way."""
    slot = guide_slot(state, int(state.robots.destination[robot]))
    return int(state.guides.ticks[slot][state.robots.start[robot]])


@compiled
def make_level_guide(state: State, slot: int, goal: int, step: int) -> None:
    """Reach the resources level by level, each `step` ticks from the one before."""
    first = state.search.keys  # by level: the number of resources before it
    queue = state.search.nodes
    ticks = state.guides.ticks[slot]
    if min(first.size, queue.size) <= ticks.size:
        raise RoomExhausted
    for resource in range(ticks.size):
        ticks[resource] = UNREACHABLE
    ticks[goal] = 0
    queue[0] = goal
    first[0] = 0
    begin = 0
    end = 1
    level = 1
    while begin < end and level * step <= LARGEST:
        first[level] = end
        begin = end
        end = reach_sources(state, slot, int(first[level - 1]), end, level)
        level += 1
    turn_levels_to_ticks(state, slot, step)
    if reach_sources(state, slot, begin, end, TOO_FAR) > end:
        spread_too_far(state, slot)


@compiled
def reach_sources(state: State, slot: int, begin: int, end: int, level: int) -> int:
    """Put the resources that lead to those queued from `begin` to `end` behind these; where the queue ends then."""
    graph = state.graph
    queue = state.search.nodes
    ticks = state.guides.ticks[slot]
    count = end
    for k in range(begin, end):
        resource = int(queue[k])
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            if ticks[source] == UNREACHABLE:
                ticks[source] = level
                queue[count] = source
                count += 1
    return count


@compiled
def turn_levels_to_ticks(state: State, slot: int, step: int) -> None:
    """Turn the levels of a guide into ticks, and rank by level and index where ranks are kept."""
    if state.scale > 0 and step == 1:
        return
    first = state.search.keys
    ticks = state.guides.ticks[slot]
    rank = state.guides.rank[slot]
    for resource in range(ticks.size):
        level = int(ticks[resource])
        if level >= 0:
            ticks[resource] = level * step
            if state.scale == 0:
                rank[resource] = first[level]
                first[level] += 1


@compiled
def make_guide(state: State, slot: int, goal: int, pace: int) -> None:
    """Settle the resources in the order of (ticks to the goal, index), which is the order of their ranks."""
    graph = state.graph
    keys = state.search.keys
    nodes = state.search.nodes
    ticks = state.guides.ticks[slot]
    rank = state.guides.rank[slot]
    for resource in range(ticks.size):
        ticks[resource] = UNREACHABLE
    keys[0] = goal
    nodes[0] = goal
    size = 1
    settled = 0
    while size > 0:
        key = int(keys[0])
        resource = int(nodes[0])
        size -= 1
        replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        if ticks[resource] >= 0:
            continue
        ticks[resource] = key >> 32
        if state.scale == 0:
            rank[resource] = settled
        settled += 1
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            further = (key >> 32) + pace * int(graph.duration[source])
            if ticks[source] < 0:
                if further > LARGEST:
                    ticks[source] = TOO_FAR
                else:
                    push(keys, nodes, size, (further << 32) + source, source)
                    size += 1
    spread_too_far(state, slot)


@compiled
def spread_too_far(state: State, slot: int) -> None:
    """Mark the resources that lead to the goal only through those that are too far."""
    graph = state.graph
    ticks = state.guides.ticks[slot]
    queue = state.search.nodes
    if queue.size < ticks.size:
        raise RoomExhausted
    count = 0
    for resource in range(ticks.size):
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
