"""Records of plans: writing what a search found, and comparing."""

from carp_optimized.jit.compiling import RecordsExhausted, compiled, entry
from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import FIRST, NEVER, NONE, UNKNOWN, Records, State
from carp_optimized.state.groups import meet, share_group
from carp_optimized.state.natives import state_at


@compiled
def start_record(state: State, robot: int, first: int, history: int) -> int:
    """Begin a record with the first `history` visits from `first` on of the plan that the robot has followed."""
    records = state.records
    record = int(records.used[0])
    at = int(records.used[1])
    if record == records.robot.size or at + history > records.resource.size:
        raise RecordsExhausted
    records.robot[record] = robot
    records.visits_at[record] = at
    records.visits[record] = history
    for k in range(history):
        records.resource[at + k] = records.resource[first + k]
        records.enter[at + k] = records.enter[first + k]
    return record


@compiled
def first_visits(state: State, record: int, count: int) -> int:
    """A record of so many first visits of a plan, or its own if it has no more; nobody leaves the last of them."""
    records = state.records
    if records.visits[record] <= count:
        return record
    begun = start_record(state, int(records.robot[record]), int(records.visits_at[record]), count)
    records.leave[begun] = NEVER
    records.expansions[begun] = UNKNOWN
    close_record(state, begun)
    return begun


@compiled
def write_record(state: State, record: int, expansions: int, is_noted: bool) -> None:
    """Finish a record with the path to the last expansion and, if that is noted, with all expansions."""
    records = state.records
    search = state.search
    length = 0
    expansion = expansions - 1
    while expansion != NONE:
        length += 1
        expansion = int(search.came[expansion])
    end = int(records.visits_at[record]) + int(records.visits[record]) + length
    if end > records.resource.size or (is_noted and int(records.used[2]) + expansions > records.expanded.size):
        raise RecordsExhausted
    expansion = expansions - 1
    for k in range(end - 1, end - 1 - length, -1):
        records.resource[k] = search.expanded[expansion]
        records.enter[k] = search.entered[expansion]
        expansion = int(search.came[expansion])
    goal = int(search.expanded[expansions - 1])
    robot = int(records.robot[record])
    records.leave[record] = (
        NEVER
        if state.parks
        else int(records.enter[end - 1]) + int(state.robots.pace[robot]) * int(state.graph.duration[goal])
    )
    records.visits[record] += length
    close_record(state, record)
    note_opening(state, record)
    if is_noted:
        write_expansions(state, record, expansions)
    else:
        records.expansions[record] = UNKNOWN


@compiled
def note_opening(state: State, record: int) -> None:
    """Note from when on the goal was free for ever to the query, and the least f of what it has expanded."""
    state.records.opens[record] = state.search.opens[0]
    state.records.least[record] = state.search.least[0]


@compiled
def write_expansions(state: State, record: int, expansions: int) -> None:
    """Note what the query has read, clipped to what could matter (`carp_optimized.neighbourhood.replanning`).

    Leaving r at t costs f >= t + h(r) - d(r), as h is consistent, and more than the plan's f does not matter.
    """
    records = state.records
    search = state.search
    robot = int(records.robot[record])
    pace = int(state.robots.pace[robot])
    ticks = state.guides.ticks[state.guides.slot[state.robots.destination[robot]]]
    f = int(records.arrival[record])
    first = int(records.used[2])
    records.expansions_at[record] = first
    records.expansions[record] = expansions
    records.used[2] = first + expansions
    largest = FIRST
    regions = 0
    for k in range(expansions - 1, -1, -1):
        resource = int(search.expanded[k])
        regions |= int(state.graph.region[resource])
        records.expanded[first + k] = resource
        records.ready[first + k] = search.ready[k]
        records.until[first + k] = f - int(ticks[resource]) + pace * int(state.graph.duration[resource])
        records.largest[first + k] = largest
        largest = max(largest, int(search.popped[k]))
    records.regions[record] = regions


@compiled
def close_record(state: State, record: int) -> None:
    """Sum the positions of a record and count it in."""
    records = state.records
    graph = state.graph
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    sum_x = 0
    sum_y = 0
    for k in range(first, last):
        ticks = int(records.enter[k + 1]) - int(records.enter[k])
        sum_x += ticks * int(graph.x[records.resource[k]])
        sum_y += ticks * int(graph.y[records.resource[k]])
    records.arrival[record] = records.enter[last]
    spots = records.spots[record]
    start = int(records.resource[first])
    goal = int(records.resource[last])
    spots[0] = records.enter[first]
    spots[1] = records.enter[last]
    spots[2] = sum_x + int(graph.x[start]) * int(spots[0]) - int(graph.x[goal]) * int(spots[1])
    spots[3] = sum_y + int(graph.y[start]) * int(spots[0]) - int(graph.y[goal]) * int(spots[1])
    spots[4] = graph.x[start]
    spots[5] = graph.y[start]
    spots[6] = graph.x[goal]
    spots[7] = graph.y[goal]
    records.used[0] = record + 1
    records.used[1] = last + 1


@compiled
def cost_of(state: State, record: int) -> int:
    """The cost of a plan."""
    return int(state.records.arrival[record]) - int(state.robots.release[state.records.robot[record]])


@compiled
def same_plan(records: Records, one: int, other: int) -> bool:
    """Whether two records hold the same visits."""
    if one == other:
        return True
    if records.visits[one] != records.visits[other] or records.leave[one] != records.leave[other]:
        return False
    here = int(records.visits_at[one])
    there = int(records.visits_at[other])
    for k in range(int(records.visits[one])):
        if (
            records.resource[here + k] != records.resource[there + k]
            or records.enter[here + k] != records.enter[there + k]
        ):
            return False
    return True


@compiled
def clash(state: State, one: int, other: int) -> bool:
    """Whether two plans are ever in one resource or group at a tick, or exchange two; capacities are ignored.

    With a `gap` they must not follow each other either.
    """
    graph = state.graph
    records = state.records
    gap = state.gap
    has_groups = graph.group.size > 0
    i = int(records.visits_at[one])
    j = int(records.visits_at[other])
    i_last = i + int(records.visits[one]) - 1
    j_last = j + int(records.visits[other]) - 1
    while True:
        i_leave = int(records.enter[i + 1]) if i < i_last else int(records.leave[one])
        j_leave = int(records.enter[j + 1]) if j < j_last else int(records.leave[other])
        if (
            (
                records.resource[i] == records.resource[j]
                or (has_groups and share_group(graph, int(records.resource[i]), int(records.resource[j]), NEVER))
            )
            and records.enter[i] < j_leave + gap
            and records.enter[j] < i_leave + gap
        ):
            return True
        if i_leave == j_leave and i < i_last and j < j_last:
            meetings = int(records.resource[i] == records.resource[j + 1])
            meetings += int(records.resource[j] == records.resource[i + 1])
            if has_groups:
                meetings = int(meet(graph, int(records.resource[i]), int(records.resource[j + 1])))
                meetings += int(meet(graph, int(records.resource[j]), int(records.resource[i + 1])))
            if meetings > 1 - gap:
                return True
            i += 1
            j += 1
        elif i < i_last and (j == j_last or i_leave <= j_leave):
            i += 1
        elif j < j_last:
            j += 1
        else:
            return False


@compiled
def has_order(records: Records, record: int, opens: int) -> bool:
    """Whether a query gives windows the keys that it gave them, now that the last one of its goal opens at that tick.

    It does too if no f is smaller: those of the least f come first in any case, in the same order.
    """
    before = int(records.opens[record])
    return opens == before or max(opens, before) <= records.least[record]


@compiled
def delays_parking(state: State, record: int, other: int) -> bool:
    """Whether, beside another plan, the goal of a plan is free so late that its query would expand in another order."""
    if not state.parks:
        return False
    records = state.records
    opens = int(records.opens[record])
    goal = int(state.robots.goal[records.robot[record]])
    first = int(records.visits_at[other])
    last = first + int(records.visits[other]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        leave = (int(records.enter[k + 1]) if k < last else int(records.leave[other])) + state.gap
        if meet(state.graph, resource, goal) and not has_order(records, record, max(opens, leave)):
            return True
    return False


@entry
def keep_records(native: Native[State], kept: Ints) -> None:
    """Forget all records but those kept, which are reserved; they are numbered again, in their order.

    `kept` is in order, so each record moves to a place that is its own or that of one forgotten.
    """
    state = state_at(native)
    records = state.records
    visits = 0
    expansions = 0
    for number in range(kept.size):
        record = int(kept[number])
        records.robot[number] = records.robot[record]
        records.leave[number] = records.leave[record]
        records.arrival[number] = records.arrival[record]
        for k in range(8):
            records.spots[number][k] = records.spots[record][k]
        records.visits[number] = records.visits[record]
        first = int(records.visits_at[record])
        records.visits_at[number] = visits
        for k in range(first, first + int(records.visits[record])):
            records.resource[visits] = records.resource[k]
            records.enter[visits] = records.enter[k]
            visits += 1
        records.expansions[number] = records.expansions[record]
        records.regions[number] = records.regions[record]
        records.opens[number] = records.opens[record]
        records.least[number] = records.least[record]
        first = int(records.expansions_at[record])
        records.expansions_at[number] = expansions
        for k in range(first, first + int(records.expansions[record])):
            records.expanded[expansions] = records.expanded[k]
            records.ready[expansions] = records.ready[k]
            records.until[expansions] = records.until[k]
            records.largest[expansions] = records.largest[k]
            expansions += 1
        state.reserved[records.robot[number]] = number
    records.used[0] = kept.size
    records.used[1] = visits
    records.used[2] = expansions
