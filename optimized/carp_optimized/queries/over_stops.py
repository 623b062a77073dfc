"""The CARP query of a robot with several stops, or with service: A* over windows and numbers of stops served.

It goes as `carp_reference.query` does, label by label. Of the shortcuts of `search` it has two: it ends where the goal
is not free for ever in time, or no windows lead back from it. A label is a window and a number of stops served, `window
* stride + served`. What it has read is not noted, so its plans are not reused.
"""

from carp_optimized.jit.compiling import RecordsExhausted, RoomExhausted, TicksExhausted, compiled, inlined
from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.queries.guides import GREED, effort_of, greedy_f, guide_of, guide_slot
from carp_optimized.queries.ways_back import CUT_OFF, FEWEST, look_back
from carp_optimized.state.arrays import (
    FIRST,
    GREEDY,
    LARGEST,
    NEVER,
    NONE,
    TOO_FAR,
    UNKNOWN,
    UNREACHABLE,
    WHOLE,
    State,
    Stops,
)
from carp_optimized.state.records import close_record, note_opening, start_record
from carp_optimized.windows.fitting import STANDING, end_of_run, is_exchange, opens_at, stand, start_of_run
from carp_optimized.windows.rows import skip_below


@compiled
def has_stops(state: State, robot: int) -> bool:
    """Whether the robot has more than a goal alone."""
    return bool(state.stops.first[robot] < state.stops.first[robot + 1])


@compiled
def served_by(state: State, robot: int, first: int, count: int) -> int:
    """How many stops but the last the visits of a record have served, each left as the next one begins."""
    records = state.records
    stops = state.stops
    stop = int(stops.first[robot])
    last = int(stops.first[robot + 1]) - 1
    for k in range(first, first + count):
        stay = int(records.enter[k + 1]) - int(records.enter[k])
        if stop < last and records.resource[k] == stops.place[stop] and stay >= stops.service[stop]:
            stop += 1
    return stop - int(stops.first[robot])


@compiled
def has_goal_alone_left(state: State, robot: int, first: int, count: int) -> bool:
    """Whether those visits have served all stops but the last, where the robot stays no longer than anywhere.

    Then all labels have the same number of stops served, and the query is that of a robot with a goal alone.
    """
    stops = state.stops
    last = int(stops.first[robot + 1]) - 1
    passing = int(state.robots.pace[robot]) * int(state.graph.duration[stops.place[last]])
    is_short = state.parks or stops.stay[robot] == passing
    return bool(is_short and served_by(state, robot, first, count) == last - int(stops.first[robot]))


@compiled
def ticks_to_goal(state: State, robot: int, resource: int, served: int) -> int:
    """The h of `query/ties`, over the stops left; below 0: a mark of a guide. Fills the scratch `slot` and `rest`."""
    stops = state.stops
    first = int(stops.first[robot])
    count = int(stops.first[robot + 1]) - first
    is_made = True
    while is_made:  # making one guide may give away another
        is_made = False
        for k in range(served, count):
            is_made |= state.guides.slot[stops.destination[first + k]] == NONE
            stops.slot[k] = guide_of(state, int(stops.destination[first + k]))
    stops.rest[count - 1] = 0
    for k in range(count - 2, served - 1, -1):
        place = int(stops.place[first + k])
        ticks = int(state.guides.ticks[stops.slot[k + 1]][place])
        if ticks < 0:
            return ticks
        need = int(state.robots.pace[robot]) * int(state.graph.duration[place])
        stops.rest[k] = max(int(stops.service[first + k]) - need, 0) + ticks + int(stops.rest[k + 1])
    ticks = int(state.guides.ticks[stops.slot[served]][resource])
    return ticks if ticks < 0 else min(ticks + int(stops.rest[served]), LARGEST + 1)


@compiled
def shortest_of(state: State, robot: int) -> int:
    """The ticks from the robot's start over its stops to its goal on the empty graph; below 0: no way."""
    start = int(state.robots.start[robot])
    if has_stops(state, robot):
        ticks = ticks_to_goal(state, robot, start, 0)
        return ticks if ticks <= LARGEST else TOO_FAR
    return int(state.guides.ticks[guide_slot(state, robot, start)][start])


@compiled
def push(
    state: State, size: int, resource: int, served: int, tick: int, to_goal: int, opens: int, greed: int, label: int
) -> None:
    """Add an entry to the heap of `size` entries, in the order of `query/ties`.

    (key, tie) is (f, h; index, served), or where f is up to `opens`, (h, index; tick, served) with a key below 0; in a
    greedy query (f, h; tick, served) with its own f and a key below 0.
    """
    over = state.stops
    stride = int(over.stride)
    if greed > 0:
        key = FIRST + (greedy_f(tick, to_goal, opens, greed) << 31) + to_goal
        tie = tick * stride + served
    elif tick + to_goal > opens:
        key = ((tick + to_goal) << 31) + to_goal
        tie = resource * stride + served
    else:
        key = FIRST + (to_goal << 31) + resource
        tie = tick * stride + served
    if size == over.keys.size:
        raise RoomExhausted
    here = size
    while here > 0:
        above = (here - 1) >> 1
        if over.keys[above] < key or (over.keys[above] == key and over.ties[above] <= tie):
            break
        move(over.keys, over.ties, over.labels, above, here)
        here = above
    over.keys[here] = key
    over.ties[here] = tie
    over.labels[here] = label


@inlined
def queued_tick(stops: Stops, key: int, tie: int) -> int:
    """The tick with which an entry of that key was added to the heap."""
    return (key >> 31) - (key & ((1 << 31) - 1)) if key >= 0 else tie // int(stops.stride)


@compiled
def drop_root(state: State, size: int) -> None:
    """Take the first entry out of the heap, which has `size` entries afterwards."""
    over = state.stops
    key = int(over.keys[size])
    tie = int(over.ties[size])
    label = int(over.labels[size])
    here = 0
    below = 1
    while below < size:
        other = below + 1
        if other < size and (
            over.keys[other] < over.keys[below]
            or (over.keys[other] == over.keys[below] and over.ties[other] < over.ties[below])
        ):
            below = other
        if key < over.keys[below] or (key == over.keys[below] and tie <= over.ties[below]):
            break
        move(over.keys, over.ties, over.labels, below, here)
        here = below
        below = 2 * here + 1
    over.keys[here] = key
    over.ties[here] = tie
    over.labels[here] = label


@compiled
def move(keys: Longs, ties: Longs, labels: Ints, source: int, target: int) -> None:
    """Copy an entry of the heap."""
    keys[target] = keys[source]
    ties[target] = ties[source]
    labels[target] = labels[source]


@compiled
def search_over_stops(  # noqa: C901, PLR0912, PLR0915 - one hot loop
    state: State,
    robot: int,
    resource: int,
    enter: int,
    ready: int,
    served: int,
    now: int,
    behind: int,
    latest: int,
    asked: int,
) -> int:
    """A* from the resource, entered at `enter` and left from `ready` on; the expansion in which it ends, or `NONE`."""
    graph = state.graph
    windows = state.windows
    stops = state.stops
    reached = stops.reached
    parent = stops.parent
    first = int(stops.first[robot])
    last_stop = int(stops.first[robot + 1]) - 1 - first
    goal = int(state.robots.goal[robot])
    pace = int(state.robots.pace[robot])
    stride = int(stops.stride)
    counts_all = behind == NEVER
    opens = opens_at(state, goal, behind) if state.parks else 0
    state.search.opens[0] = opens
    greed = GREED if asked == GREEDY else 0
    if asked == WHOLE:
        opens = 0
    elif opens > latest or opens == NEVER:
        return NONE
    to_goal = ticks_to_goal(state, robot, resource, served)
    if to_goal < 0 or to_goal > LARGEST:
        if to_goal == UNREACHABLE:
            return NONE
        raise TicksExhausted
    effort = effort_of(asked, to_goal)
    next_look = FEWEST // 2 if state.parks and counts_all and asked != WHOLE else NEVER
    state.search.generation[0] += 1
    base = int(state.search.generation[0]) << 32
    own_slot = stand(state, resource, enter, behind)
    entered = state.search.reached  # by a label of whatever number of stops served
    entered[own_slot] = base - enter
    start = STANDING * stride + served
    tick = ready - pace * int(graph.duration[resource])
    reached[start] = base - tick
    parent[start] = NONE
    state.search.least[0] = tick + to_goal
    push(state, 0, resource, served, tick, to_goal, opens, greed, start)
    size = 1
    expansions = 0
    beyond = False
    while size > 0:
        label = int(stops.labels[0])
        key = int(stops.keys[0])
        queued = queued_tick(stops, key, int(stops.ties[0]))
        size -= 1
        drop_root(state, size)
        window = label // stride
        done = label % stride
        resource = int(windows.resource[window])
        tick = base - int(reached[label])
        if tick != queued:
            continue  # reached earlier since this entry was made
        this = expansions
        expansions += 1
        if expansions >= effort:
            return NONE
        if expansions >= next_look:
            next_look = look_back(state, robot, NONE, 0, latest, expansions)
            if next_look == CUT_OFF:
                return NONE
        if this == stops.expanded.size:
            raise RoomExhausted
        stops.expanded[this] = label
        stops.entered[this] = tick
        stops.came[this] = parent[label]
        is_start = label == start
        ready = tick + pace * int(graph.duration[resource])
        entry = enter if is_start else tick
        last = window if counts_all else end_of_run(state, window, behind)
        end = int(windows.end[last])
        if done == last_stop and resource == goal:
            leave = entry + int(stops.stay[robot])
            if end == NEVER if state.parks else now <= leave <= end:
                return this
        if done < last_stop and resource == stops.place[first + done]:
            until = max(ready, entry + int(stops.service[first + done]))
            other = (own_slot if is_start else window) * stride + done + 1
            tick = until - pace * int(graph.duration[resource])
            if until <= end and base - tick > reached[other]:
                to_goal = int(state.guides.ticks[stops.slot[done + 1]][resource]) + int(stops.rest[done + 1])
                if tick + to_goal > LARGEST:
                    beyond = True
                elif tick + to_goal <= latest:
                    reached[other] = base - tick
                    parent[other] = this
                    push(state, size, resource, done + 1, tick, to_goal, opens, greed, other)
                    size += 1
        slot = int(stops.slot[done])
        for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
            target = int(graph.target[edge])
            to_goal = int(state.guides.ticks[slot][target])
            if to_goal < 0:
                beyond |= to_goal == TOO_FAR
                continue
            to_goal += int(stops.rest[done])
            need = pace * int(graph.duration[target])
            row = int(windows.offset[target])
            row_end = row + int(windows.size[target])
            tail = skip_below(windows.end, row, row_end, ready + need)
            while tail < row_end:
                tail = tail if counts_all else end_of_run(state, tail, behind)
                window = tail if counts_all else start_of_run(state, tail, behind)
                entry = max(ready, int(windows.start[window]))
                until = int(windows.end[tail])
                tail += 1
                if entry > end:
                    break
                while entry <= end and is_exchange(state, last, entry, target):
                    entry += 1
                other = window * stride + done
                if entry > end or entry + need > until or base - entry <= reached[other]:
                    continue
                if entry + to_goal > LARGEST:
                    beyond = True
                elif entry + to_goal <= latest:
                    reached[other] = base - entry
                    parent[other] = this
                    entered[window] = max(int(entered[window]), base - entry)
                    push(state, size, target, done, entry, to_goal, opens, greed, other)
                    size += 1
    if beyond and latest > LARGEST:
        raise TicksExhausted
    return NONE


@compiled
def find_over_stops(
    state: State,
    robot: int,
    first: int,
    past: int,
    resource: int,
    enter: int,
    ready: int,
    now: int,
    behind: int,
    latest: int,
    asked: int,
) -> int:
    """The record of the plan of a robot that is in the resource, after `past` visits from `first` on, or `NONE`.

    It is asked for `ALONE`, `WHOLE`, `SOON` or `GREEDY`, as in `carp_optimized.queries.search`.
    """
    served = served_by(state, robot, first, past)
    last = search_over_stops(state, robot, resource, enter, ready, served, now, behind, latest, asked)
    if last == NONE:
        return NONE
    record = start_record(state, robot, first, past)
    write_over_stops(state, record, last, enter)
    return record


@compiled
def write_over_stops(state: State, record: int, last: int, enter: int) -> None:
    """Finish a record with the path to the expansion `last`, the first of whose visits was entered at `enter`."""
    records = state.records
    stops = state.stops
    length = 0
    expansion = last
    while expansion != NONE:
        length += is_move(state, expansion)
        expansion = int(stops.came[expansion])
    end = int(records.visits_at[record]) + int(records.visits[record]) + length
    if end > records.resource.size:
        raise RecordsExhausted
    k = end
    expansion = last
    while expansion != NONE:
        before = int(stops.came[expansion])
        if is_move(state, expansion):
            k -= 1
            records.resource[k] = resource_of(state, expansion)
            records.enter[k] = enter if before == NONE else stops.entered[expansion]
        expansion = before
    stay = int(stops.stay[records.robot[record]])
    records.leave[record] = NEVER if state.parks else int(records.enter[end - 1]) + stay
    records.visits[record] += length
    records.expansions[record] = UNKNOWN
    note_opening(state, record)
    close_record(state, record)


@compiled
def is_move(state: State, expansion: int) -> bool:
    """Whether an expansion begins a visit: it is the first, or one of another resource than that before it."""
    before = int(state.stops.came[expansion])
    return before == NONE or resource_of(state, expansion) != resource_of(state, before)


@inlined
def resource_of(state: State, expansion: int) -> int:
    """The resource of an expansion."""
    return int(state.windows.resource[int(state.stops.expanded[expansion]) // int(state.stops.stride)])
