"""Records of plans: writing what a search found, and comparing."""

from carp_optimized.arrays import NEVER, NONE, Ints, Records, State
from carp_optimized.compiling import RoomExhausted, compiled, entry
from carp_optimized.natives import records_at
from carp_optimized.references import Native


@compiled
def start_record(state: State, robot: int, first: int, history: int) -> int:
    """Begin a record with the first `history` visits from `first` on of the plan that the robot has followed."""
    records = state.records
    record = int(records.used[0])
    at = int(records.used[1])
    if record == records.robot.size or at + history > records.resource.size:
        raise RoomExhausted
    records.robot[record] = robot
    records.visits_at[record] = at
    records.visits[record] = history
    for k in range(history):
        records.resource[at + k] = records.resource[first + k]
        records.enter[at + k] = records.enter[first + k]
    return record


@compiled
def write_record(state: State, record: int, last: int, expansions: int) -> None:
    """Finish a record with the path to the window `last` and with what the search has expanded."""
    records = state.records
    windows = state.windows
    search = state.search
    label = int(search.generation[0]) << 32
    length = 0
    node = last
    while node != NONE:
        length += 1
        node = int(search.parent[node])
    end = int(records.visits_at[record]) + int(records.visits[record]) + length
    read_at = int(records.used[2])
    if end > records.resource.size or read_at + expansions > records.expanded.size:
        raise RoomExhausted
    node = last
    for k in range(end - 1, end - 1 - length, -1):
        records.resource[k] = windows.resource[node]
        records.enter[k] = label - search.reached[node]
        node = int(search.parent[node])
    goal = int(windows.resource[last])
    robot = int(records.robot[record])
    records.leave[record] = (
        NEVER
        if state.parks
        else int(records.enter[end - 1]) + int(state.robots.pace[robot]) * int(state.graph.duration[goal])
    )
    records.visits[record] += length
    records.expansions_at[record] = read_at
    records.expansions[record] = expansions
    for k in range(expansions):
        records.expanded[read_at + k] = search.expanded[k]
        records.ready[read_at + k] = search.ready[k]
    records.used[2] = read_at + expansions
    close_record(state, record)


@compiled
def close_record(state: State, record: int) -> None:
    """Bound the positions of a record and count it in."""
    records = state.records
    first = int(records.visits_at[record])
    resource = int(records.resource[first])
    left = right = int(state.graph.x[resource])
    low = high = int(state.graph.y[resource])
    for k in range(first + 1, first + int(records.visits[record])):
        x = int(state.graph.x[records.resource[k]])
        y = int(state.graph.y[records.resource[k]])
        left = min(left, x)
        right = max(right, x)
        low = min(low, y)
        high = max(high, y)
    records.left[record] = left
    records.right[record] = right
    records.low[record] = low
    records.high[record] = high
    records.used[0] = record + 1
    records.used[1] = first + int(records.visits[record])


@compiled
def arrival(records: Records, record: int) -> int:
    """The tick at which the plan enters its last visit."""
    return int(records.enter[int(records.visits_at[record]) + int(records.visits[record]) - 1])


@compiled
def cost_of(state: State, record: int) -> int:
    """The cost of a plan."""
    return arrival(state.records, record) - int(state.robots.release[state.records.robot[record]])


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
def clash(records: Records, one: int, other: int) -> bool:
    """Whether two plans are ever in one resource at a tick, or exchange two; capacities are not looked at."""
    i = int(records.visits_at[one])
    j = int(records.visits_at[other])
    i_last = i + int(records.visits[one]) - 1
    j_last = j + int(records.visits[other]) - 1
    while True:
        i_leave = int(records.enter[i + 1]) if i < i_last else int(records.leave[one])
        j_leave = int(records.enter[j + 1]) if j < j_last else int(records.leave[other])
        if records.resource[i] == records.resource[j] and records.enter[i] < j_leave and records.enter[j] < i_leave:
            return True
        if i_leave == j_leave and i < i_last and j < j_last:
            if records.resource[i] == records.resource[j + 1] and records.resource[j] == records.resource[i + 1]:
                return True
            i += 1
            j += 1
        elif i < i_last and (j == j_last or i_leave <= j_leave):
            i += 1
        elif j < j_last:
            j += 1
        else:
            return False


@entry
def copy_records(source: Native[Records], destination: Native[Records], kept: Ints) -> None:
    """Fill new records with those kept of the old ones, numbered in their order."""
    old = records_at(source)
    new = records_at(destination)
    for k in range(new.used.size):
        new.used[k] = 0
    for number in range(kept.size):
        record = int(kept[number])
        new.robot[number] = old.robot[record]
        new.leave[number] = old.leave[record]
        new.left[number] = old.left[record]
        new.right[number] = old.right[record]
        new.low[number] = old.low[record]
        new.high[number] = old.high[record]
        new.visits[number] = old.visits[record]
        new.visits_at[number] = new.used[1]
        for k in range(int(old.visits[record])):
            new.resource[new.used[1]] = old.resource[old.visits_at[record] + k]
            new.enter[new.used[1]] = old.enter[old.visits_at[record] + k]
            new.used[1] += 1
        new.expansions[number] = old.expansions[record]
        new.expansions_at[number] = new.used[2]
        for k in range(int(old.expansions[record])):
            new.expanded[new.used[2]] = old.expanded[old.expansions_at[record] + k]
            new.ready[new.used[2]] = old.ready[old.expansions_at[record] + k]
            new.used[2] += 1
    new.used[0] = kept.size
