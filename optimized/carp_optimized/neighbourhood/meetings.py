"""When plans first come together, by the constraints that both are on."""

from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NEVER, State
from carp_optimized.state.natives import state_at


@entry
def first_meetings(native: Native[State], plan: int, others: Ints, begins: Ints, ends: Ints, ticks: Ints) -> None:
    """The first tick at which each of the other plans is in the way of a plan, into `ticks`; `NEVER` if it is not.

    It may be where a stay of it touches the time from the first to the last stay of the plan on the same constraint.
    Constraints with room for all do not count. `begins` and `ends` are scratch, by constraint.
    """
    state = state_at(native)
    records = state.records
    begins[:] = NEVER
    ends[:] = -1
    first = int(records.visits_at[plan])
    for k in range(first, first + int(records.visits[plan])):
        leave = leave_of(state, plan, k)
        resource = int(records.resource[k])
        include(begins, ends, resource, int(records.enter[k]), leave)
        for group in range(int(state.graph.groups_first[resource]), int(state.graph.groups_first[resource + 1])):
            constraint = state.graph.capacity.size + int(state.graph.group[group])
            include(begins, ends, constraint, int(records.enter[k]), leave)
    for k in range(begins.size):
        if state.graph.room[k] > others.size:
            ends[k] = -1
    for k in range(others.size):
        ticks[k] = first_meeting(state, int(others[k]), begins, ends)


@compiled
def include(begins: Ints, ends: Ints, constraint: int, enter: int, leave: int) -> None:
    """Make the time of the constraint include a stay."""
    begins[constraint] = min(int(begins[constraint]), enter)
    ends[constraint] = max(int(ends[constraint]), leave)


@compiled
def first_meeting(state: State, other: int, begins: Ints, ends: Ints) -> int:
    """The first tick at which a plan touches one of these times; `NEVER` if it touches none."""
    records = state.records
    tick = NEVER
    k = int(records.visits_at[other])
    end = k + int(records.visits[other])
    while k < end and records.enter[k] < tick:
        enter = int(records.enter[k])
        leave = leave_of(state, other, k)
        resource = int(records.resource[k])
        tick = min(tick, touch(state, enter, leave, int(begins[resource]), int(ends[resource])))
        for group in range(int(state.graph.groups_first[resource]), int(state.graph.groups_first[resource + 1])):
            constraint = state.graph.capacity.size + int(state.graph.group[group])
            tick = min(tick, touch(state, enter, leave, int(begins[constraint]), int(ends[constraint])))
        k += 1
    return tick


@compiled
def touch(state: State, enter: int, leave: int, begin: int, end: int) -> int:
    """The first tick at which a stay, or the gap behind it, touches a time; `NEVER` if it does not."""
    return max(enter, begin) if enter <= end + state.gap and begin <= leave + state.gap else NEVER


@compiled
def leave_of(state: State, plan: int, visit: int) -> int:
    """When a visit of the plan, of this number among the visits of all records, ends."""
    records = state.records
    last = int(records.visits_at[plan]) + int(records.visits[plan]) - 1
    return int(records.enter[visit + 1]) if visit < last else int(records.leave[plan])
