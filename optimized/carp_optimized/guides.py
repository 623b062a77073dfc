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
def make_level_guide(state: State, slot: int, goal: int, step: int) -> None:
    """Reach the resources level by level, each `step` ticks from the one before; then rank them by level and index."""
    graph = state.graph
    first = state.search.keys  # by level: the next rank
    queue = state.search.nodes
    guide = state.guides.table[slot]
    if min(first.size, queue.size) <= guide.size:
        raise RoomExhausted
    for resource in range(guide.size):
        guide[resource] = UNREACHABLE
    guide[goal] = 0
    queue[0] = goal
    first[0] = 0
    begin = 0
    end = 1
    level = 1
    while begin < end and level * step <= LARGEST:
        first[level] = end
        count = end
        for k in range(begin, end):
            resource = int(queue[k])
            for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
                source = int(graph.source[edge])
                if guide[source] == UNREACHABLE:
                    guide[source] = level
                    queue[count] = source
                    count += 1
        begin = end
        end = count
        level += 1
    for resource in range(guide.size):
        level = int(guide[resource])
        if level >= 0:
            guide[resource] = ((level * step) << 32) + first[level]
            first[level] += 1
    if begin < end:
        for k in range(begin, end):
            resource = int(queue[k])
            for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
                source = int(graph.source[edge])
                if guide[source] == UNREACHABLE:
                    guide[source] = TOO_FAR
        spread_too_far(state, slot)


@compiled
def make_guide(state: State, slot: int, goal: int, pace: int) -> None:
    """Settle the resources in the order of (ticks to the goal, index), which is the order of their ranks."""
    graph = state.graph
    keys = state.search.keys
    nodes = state.search.nodes
    guide = state.guides.table[slot]
    for resource in range(guide.size):
        guide[resource] = UNREACHABLE
    keys[0] = goal
    nodes[0] = goal
    size = 1
    rank = 0
    while size > 0:
        key = int(keys[0])
        resource = int(nodes[0])
        size -= 1
        replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        if guide[resource] >= 0:
            continue
        ticks = key >> 32
        guide[resource] = (ticks << 32) + rank
        rank += 1
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            further = ticks + pace * int(graph.duration[source])
            if guide[source] < 0:
                if further > LARGEST:
                    guide[source] = TOO_FAR
                else:
                    push(keys, nodes, size, (further << 32) + source, source)
                    size += 1
    spread_too_far(state, slot)


@compiled
def spread_too_far(state: State, slot: int) -> None:
    """Mark the resources that lead to the goal only through those that are too far."""
    graph = state.graph
    guide = state.guides.table[slot]
    queue = state.search.nodes
    if queue.size < guide.size:
        raise RoomExhausted
    count = 0
    for resource in range(guide.size):
        if guide[resource] == TOO_FAR:
            queue[count] = resource
            count += 1
    done = 0
    while done < count:
        resource = int(queue[done])
        done += 1
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            if guide[source] == UNREACHABLE:
                guide[source] = TOO_FAR
                queue[count] = source
                count += 1
