"""What windows allow a robot: a stay, a move, a whole plan, and staying for ever."""

from carp_optimized.jit.compiling import compiled
from carp_optimized.state.arrays import NEVER, NONE, Records, State
from carp_optimized.state.groups import are_close
from carp_optimized.state.records import has_order
from carp_optimized.windows.rows import last_by

STANDING = 0  # the slot of no row: a copy of the window in which the robot is when it sets out


@compiled
def is_exchange(state: State, slot: int, tick: int, target: int) -> bool:
    """Whether leaving the window at the tick for `target` meets a committed robot that comes from there, or close.

    In a resource of capacity 1 in no group that robot is the one that ends the window, so the tick is the window's end;
    where following is forbidden, none exists. Into a group of capacity 1 that holds the resource of the window, no
    robot moves from within, as it would be in the way.
    """
    graph = state.graph
    resource = int(state.windows.resource[slot])
    if graph.capacity[resource] == 1:
        return bool(state.windows.end[slot] == tick and are_close(graph, int(state.windows.source[slot]), target))
    if comes_from(state, resource, tick, target):
        return True
    for k in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
        constraint = graph.capacity.size + int(graph.group[k])
        if graph.room[constraint] == 1 and comes_from(state, constraint, tick, target):
            return True
    return False


@compiled
def comes_from(state: State, constraint: int, tick: int, target: int) -> bool:
    """Whether a committed robot enters at the tick what the constraint is on, from the target or close to it."""
    stays = state.stays
    first = int(stays.offset[constraint])
    stay = last_by(stays, constraint, tick)
    while stay >= first and stays.start[stay] == tick:
        if are_close(state.graph, int(stays.source[stay]), target):
            return True
        stay -= 1
    return False


@compiled
def end_of_run(state: State, slot: int, behind: int) -> int:
    """The last of the windows that are one to a robot planned behind that rank: only later robots are between them."""
    while state.windows.rank[slot] > behind:
        slot += 1
    return slot


@compiled
def start_of_run(state: State, slot: int, behind: int) -> int:
    """The first of the windows that are one to a robot planned behind that rank."""
    windows = state.windows
    first = int(windows.offset[windows.resource[slot]])
    while slot > first and windows.rank[slot - 1] > behind:
        slot -= 1
    return slot


@compiled
def opens_at(state: State, resource: int, behind: int) -> int:
    """The tick from which on the resource is free for ever to a robot planned behind that rank; `NEVER`: from none."""
    windows = state.windows
    size = int(windows.size[resource])
    last = int(windows.offset[resource]) + size - 1
    if size == 0 or windows.end[last] < NEVER:
        return NEVER
    return int(windows.start[start_of_run(state, last, behind)])


@compiled
def has_same_order(state: State, record: int, behind: int) -> bool:
    """Whether the query of the plan, asked again behind that rank, would give windows the same keys of `query/ties`."""
    if not state.parks:
        return True
    goal = int(state.robots.goal[state.records.robot[record]])
    return has_order(state.records, record, opens_at(state, goal, behind))


@compiled
def still_found(state: State, record: int) -> bool:
    """Whether the plan found by a query against fewer plans fits the windows, and is found again."""
    return has_same_order(state, record, NEVER) and plan_fits(state, record)


@compiled
def stand(state: State, resource: int, enter: int, behind: int) -> int:
    """Copy the window around the tick into the slot `STANDING`; return its own slot."""
    windows = state.windows
    slot = last_by(windows, resource, enter)
    last = end_of_run(state, slot, behind)
    windows.resource[STANDING] = resource
    windows.end[STANDING] = windows.end[last]
    windows.source[STANDING] = windows.source[last]
    return start_of_run(state, slot, behind)


@compiled
def fits(state: State, resource: int, enter: int, leave: int, target: int, behind: int) -> bool:
    """Whether a robot can stay in the resource in [enter, leave) and then move to `target` (`NONE`: not move)."""
    slot = last_by(state.windows, resource, enter)
    if slot == NONE:
        return False
    slot = end_of_run(state, slot, behind)
    if leave > state.windows.end[slot]:
        return False
    return target == NONE or not is_exchange(state, slot, leave, target)


@compiled
def plan_fits(state: State, record: int) -> bool:
    """Whether all of the plan fits the windows."""
    records: Records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last):
        leave = int(records.enter[k + 1])
        target = int(records.resource[k + 1])
        if not fits(state, int(records.resource[k]), int(records.enter[k]), leave, target, NEVER):
            return False
    return fits(state, int(records.resource[last]), int(records.enter[last]), int(records.leave[record]), NONE, NEVER)
