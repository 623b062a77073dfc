"""The h of A*, exact on the empty graph: from the goal along the moves backwards, one per destination.

Where all durations are alike, the resources are reached level by level; otherwise by Dijkstra's algorithm. Both end a
detour behind the start of the robot that asks: what is further from the goal lies on no plan, unless robots in the way
cost more than the detour. A query that might have looked further than its guide has it made to its end, and asks again.
"""

from carp_optimized.jit.compiling import RoomExhausted, compiled
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.state.arrays import FURTHER, LARGEST, NONE, TOO_FAR, UNREACHABLE, State


@compiled
def guide_slot(state: State, robot: int, resource: int) -> int:
    """The slot that holds the guide of the robot's destination, made as far as the resource at least."""
    guides = state.guides
    destination = int(state.robots.destination[robot])
    slot = int(guides.slot[destination])
    if slot == NONE:
        slot = int(guides.next[0])
        guides.next[0] = (slot + 1) % guides.holds.size
        if guides.holds[slot] != NONE:
            guides.slot[guides.holds[slot]] = NONE
        reach(state, slot, destination, int(state.robots.start[robot]), guides.detour)
    if guides.ticks[slot][resource] == FURTHER:
        reach_all(state, slot)
    return slot


@compiled
def guide_of(state: State, destination: int) -> int:
    """The slot that holds the guide of a destination of stops, made as far as moves lead."""
    guides = state.guides
    if guides.slot[destination] == NONE:
        slot = int(guides.next[0])
        guides.next[0] = (slot + 1) % guides.holds.size
        if guides.holds[slot] != NONE:
            guides.slot[guides.holds[slot]] = NONE
        reach(state, slot, destination, int(guides.goal[destination]), LARGEST)
    return int(guides.slot[destination])


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
    goal = int(guides.goal[destination])
    step = int(guides.pace[destination]) * state.longest
    if state.last_alike:
        make_level_guide(state, slot, goal, step, start, detour)
    else:
        make_guide(state, slot, destination, start, detour * step)
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


@compiled
def make_level_guide(state: State, slot: int, goal: int, step: int, start: int, detour: int) -> None:
    """Reach the resources level by level, each `step` ticks from the one before."""
    first = state.search.keys  # by level: the number of resources before it
    queue = state.search.nodes
    ticks = state.guides.ticks[slot]
    if min(first.size, queue.size) <= ticks.size:
        raise RoomExhausted
    for resource in range(ticks.size):
        ticks[resource] = FURTHER
    ticks[goal] = 0
    queue[0] = goal
    first[0] = 0
    begin = 0
    end = 1
    level = 1
    largest = LARGEST // step
    last = min(largest, detour) if start == goal else largest
    while begin < end and level <= last:
        first[level] = end
        begin = end
        end = reach_sources(state, slot, int(first[level - 1]), end, level)
        if ticks[start] == level:
            last = min(largest, level + detour)
        level += 1
    turn_levels_to_ticks(state, slot, step)
    if begin == end or last == largest:
        close_guide(state, slot)


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
            if ticks[source] == FURTHER:
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
def make_guide(state: State, slot: int, destination: int, start: int, detour: int) -> None:
    """Settle the resources in the order of (ticks to the goal, index), which is the order of their ranks."""
    graph = state.graph
    keys = state.search.keys
    nodes = state.search.nodes
    ticks = state.guides.ticks[slot]
    rank = state.guides.rank[slot]
    pace = int(state.guides.pace[destination])
    for resource in range(ticks.size):
        ticks[resource] = FURTHER
    keys[0] = state.guides.goal[destination]
    nodes[0] = state.guides.goal[destination]
    size = 1
    settled = 0
    last = LARGEST
    while size > 0 and keys[0] >> 32 <= last:
        to_goal = int(keys[0]) >> 32
        resource = int(nodes[0])
        size -= 1
        replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        if ticks[resource] != FURTHER:
            continue
        ticks[resource] = to_goal
        if state.scale == 0:
            rank[resource] = settled
        settled += 1
        if resource == start:
            last = min(last, to_goal + detour)
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            further = to_goal + pace * int(graph.duration[source])
            if ticks[source] == FURTHER and further <= LARGEST:
                push(keys, nodes, size, (further << 32) + source, source)
                size += 1
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
