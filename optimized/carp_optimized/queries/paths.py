"""The k shortest and k disjoint paths of `carp_reference.fixed_paths`: what takes time in the search for them."""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.jit.references import Native
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.state.arrays import NO_LIMIT, NONE, State
from carp_optimized.state.natives import state_at


@entry
def reach_beside(native: Native[State], goal: int, path: Ints, ticks: Longs) -> None:
    """The durations from entering each resource to entering the goal, beside a path; `NO_LIMIT` where none leads."""
    state = state_at(native)
    graph = state.graph
    keys = state.search.keys
    nodes = state.search.nodes
    for resource in range(ticks.size):
        ticks[resource] = NO_LIMIT
    for k in range(path.size):
        ticks[path[k]] = NONE
    ticks[goal] = 0
    keys[0] = 0
    nodes[0] = goal
    size = 1
    while size > 0:
        to_goal = int(keys[0])
        resource = int(nodes[0])
        size -= 1
        replace_root(keys, nodes, size, int(keys[size]), int(nodes[size]))
        if to_goal > ticks[resource]:
            continue
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            source = int(graph.source[edge])
            further = to_goal + int(graph.duration[source])
            if further < ticks[source]:
                ticks[source] = further
                push(keys, nodes, size, further, source)
                size += 1
    for k in range(path.size):
        ticks[path[k]] = NO_LIMIT


@entry
def add_disjoint(
    native: Native[State], start: int, goal: int, before: Ints, ends: Ints, cost: Longs, steps: Longs, walk: Ints
) -> bool:
    """Make one disjoint path more, at the least cost; whether there is one.

    `before` is what each resource on a path, but for the goal, is entered from, `NONE` for others; `ends` is 1 where a
    path moves to the goal. `cost` and `steps` of a resource are what is left from there to the goal, and `walk` has
    room for two entries of each resource.
    """
    state = state_at(native)
    for resource in range(cost.size):
        cost[resource] = NO_LIMIT
        steps[resource] = NO_LIMIT
    cost[goal] = 0
    steps[goal] = 0
    while lower_costs(state, start, goal, before, ends, cost, steps):
        pass
    if cost[start] == NO_LIMIT:
        return False
    change_moves(before, ends, goal, walk, walk_to(state, start, goal, before, ends, cost, steps, walk))
    return True


@compiled
def lower_costs(state: State, start: int, goal: int, before: Ints, ends: Ints, cost: Longs, steps: Longs) -> bool:
    """Lower the cost, or at equal cost the number of steps, of each resource by its next step; whether any fell."""
    graph = state.graph
    has_fallen = False
    for here in range(cost.size):
        for edge in range(int(graph.first[here]) - 1, int(graph.first[here + 1])):
            target = NONE if edge < graph.first[here] else int(graph.target[edge])
            there = step_to(before, ends, start, goal, here, target)
            if here == goal or there == NONE or cost[there] == NO_LIMIT:
                continue
            ticks = int(cost[there]) + cost_of_step(graph.duration, before, goal, here, target)
            if ticks < cost[here] or (ticks == cost[here] and steps[there] + 1 < steps[here]):
                cost[here] = ticks
                steps[here] = steps[there] + 1
                has_fallen = True
    return has_fallen


@compiled
def walk_to(
    state: State, start: int, goal: int, before: Ints, ends: Ints, cost: Longs, steps: Longs, walk: Ints
) -> int:
    """The best walk, each step to the first of equal resources: pairs of a resource and a target; their entries."""
    graph = state.graph
    count = 0
    here = start
    while here != goal:
        first = NO_LIMIT
        for edge in range(int(graph.first[here]) - 1, int(graph.first[here + 1])):
            target = NONE if edge < graph.first[here] else int(graph.target[edge])
            there = step_to(before, ends, start, goal, here, target)
            if there == NONE or there >= first or steps[there] + 1 != steps[here]:
                continue
            if cost[there] + cost_of_step(graph.duration, before, goal, here, target) == cost[here]:
                first = there
                walk[count] = here
                walk[count + 1] = target
        count += 2
        here = first
    return count


@compiled
def step_to(before: Ints, ends: Ints, start: int, goal: int, here: int, target: int) -> int:
    """Where a step leads by a move to the target, or by undoing the way here if that is `NONE`; `NONE`: nowhere."""
    if target == NONE:
        return int(before[here])
    if target == start:
        return NONE
    if target == goal:
        return NONE if ends[here] == 1 else goal
    if before[target] == here:
        return NONE
    return target if before[target] == NONE else int(before[target])


@compiled
def cost_of_step(duration: Ints, before: Ints, goal: int, here: int, target: int) -> int:
    """The ticks of the resource that a step takes in or gives up."""
    if target == NONE:
        return -int(duration[here])
    return int(duration[target]) if target != goal and before[target] == NONE else 0


@compiled
def change_moves(before: Ints, ends: Ints, goal: int, walk: Ints, count: int) -> None:
    """Make and undo the moves of a walk: pairs of a resource and the target of the move from there."""
    for k in range(0, count, 2):
        here = int(walk[k])
        target = int(walk[k + 1])
        if target == goal:
            ends[here] = 1
        elif target == NONE:
            before[here] = NONE
        else:
            before[target] = here
