"""The CARP query, a relative of SIPP: A* over free windows in the order of `query/ties`."""

from carp_optimized.jit.blocks import BLOCK, below, lowest, width
from carp_optimized.jit.compiling import RoomExhausted, TicksExhausted, compiled, inlined
from carp_optimized.queries.guides import GREED, effort_of, greedy_f, guide_of, guide_slot, key_of, reach_all, toll_of
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.queries.over_stops import find_over_stops, has_goal_alone_left, has_stops
from carp_optimized.queries.ways_back import CUT_OFF, FEWEST, look_back
from carp_optimized.state.arrays import (
    ALONE,
    ASKED,
    FURTHER,
    GREEDY,
    LARGEST,
    LOW,
    NEVER,
    NO_LIMIT,
    NONE,
    NOTED,
    TOO_FAR,
    UNKNOWN,
    WHOLE,
    State,
)
from carp_optimized.state.groups import is_grouped
from carp_optimized.state.records import cost_of, start_record, write_record
from carp_optimized.windows.fitting import (
    STANDING,
    end_of_run,
    fits,
    is_exchange,
    opens_at,
    plan_fits,
    stand,
    start_of_run,
)
from carp_optimized.windows.rows import skip_below

EVERY = (1 << BLOCK) - 1
NO_KEY = (NEVER << 32) + LOW  # above those of all windows


@compiled
def find_plan_by(state: State, robot: int, before: int, now: int, behind: int, latest: int) -> int:
    """The record of the robot's plan that arrives by `latest`, with what the query has read: see `find_any_plan`."""
    return find_any_plan(state, robot, before, now, behind, latest, NOTED)


@compiled
def find_plan_only(state: State, robot: int, before: int, now: int, latest: int) -> int:
    """The same against all reservations; its record does not note what the query has read, so that may be less."""
    return find_any_plan(state, robot, before, now, NEVER, latest, ALONE)


@compiled
def find_any_plan(state: State, robot: int, before: int, now: int, behind: int, latest: int, asked: int) -> int:
    """The record of the robot's plan against the reservations, or `NONE`; `before` is the plan followed until now.

    A plan that is to be found must arrive by the tick `latest`. `NOTED` asks for the plan of `query/ties` with what the
    query has read, `ALONE` for the plan, and `WHOLE` for any of the same arrival, once all windows have been expanded
    from which the goal might be reached before. `SOON` asks for the plan if it is found soon, and `GREEDY`
    for any plan that is.

    Only robots of a rank up to `behind` count. A plan that has ended stays as it is. Otherwise the visits entered by
    now are kept, and must fit the windows; a robot without a plan stands at its start since its release.
    """
    state.counters[ASKED] += 1
    records = state.records
    if has_ended(state, before, now):
        return before if plan_fits(state, before) else NONE
    first, past, resource, enter = under_way(state, robot, before, now)
    for k in range(first, first + past):
        leave = int(records.enter[k + 1])
        target = int(records.resource[k + 1])
        if not fits(state, int(records.resource[k]), int(records.enter[k]), leave, target, behind):
            return NONE
    ready = max(enter + int(state.robots.pace[robot]) * int(state.graph.duration[resource]), now)
    if not fits(state, resource, enter, ready, NONE, behind):
        return NONE
    if has_stops(state, robot):
        if asked == WHOLE or not has_goal_alone_left(state, robot, first, past):
            return find_over_stops(state, robot, first, past, resource, enter, ready, now, behind, latest, asked)
        asked = max(asked, ALONE)
        slot = guide_of(state, int(state.robots.destination[robot]))
    else:
        slot = guide_slot(state, robot, resource)
    expansions = search(state, robot, slot, resource, enter, ready, behind, latest, asked)
    if expansions == FURTHER:
        reach_all(state, slot)
        expansions = search(state, robot, slot, resource, enter, ready, behind, latest, asked)
    if expansions == 0:
        return NONE
    record = start_record(state, robot, first, past)
    write_record(state, record, expansions, asked == NOTED)
    return record


@compiled
def has_ended(state: State, before: int, now: int) -> bool:
    """Whether the robot has left by now, by the plan that it has followed, if there is one."""
    return before != NONE and bool(state.records.leave[before] <= now)


@compiled
def under_way(state: State, robot: int, before: int, now: int) -> tuple[int, int, int, int]:
    """Where the visits of its plan begin, how many are over by now, in which resource the robot is, and since when."""
    records = state.records
    if before != NONE:
        first = int(records.visits_at[before])
        entered = 0
        while entered < records.visits[before] and records.enter[first + entered] <= now:
            entered += 1
        if entered > 0:
            here = first + entered - 1
            return first, entered - 1, int(records.resource[here]), int(records.enter[here])
    return 0, 0, int(state.robots.start[robot]), int(state.robots.release[robot])


@compiled
def cost_alone(empty: State, robot: int, before: int, now: int) -> int:
    """The cost of the robot's plan where nothing is reserved, or `NONE`; `before` is the plan followed until now.

    With a goal alone left, h tells it: there it is exact. A robot in a goal in which it does not park is left to the
    search, as it may have left, or may have to leave; and so is one that is too far from its goal.
    """
    first, past, resource, enter = under_way(empty, robot, before, now)
    over_stops = has_stops(empty, robot)
    if not over_stops or has_goal_alone_left(empty, robot, first, past):
        if empty.parks and resource == empty.robots.goal[robot]:
            return enter - int(empty.robots.release[robot])
        destination = int(empty.robots.destination[robot])
        slot = guide_of(empty, destination) if over_stops else guide_slot(empty, robot, resource)
        ticks = int(empty.guides.ticks[slot][resource])
        need = int(empty.robots.pace[robot]) * int(empty.graph.duration[resource])
        arrival = max(enter, now - need) + ticks
        if ticks > 0 and arrival <= LARGEST:
            return arrival - int(empty.robots.release[robot])
    record = find_plan_only(empty, robot, before, now, NEVER)
    return NONE if record == NONE else cost_of(empty, record)


@compiled
def find_plan_alone(empty: State, robot: int, followed: int, now: int) -> int:
    """The record of the robot's plan where nothing is reserved, or `NONE`, as `find_plan_by` makes it.

    There A* expands just the path. As h is exact, each resource leads to one of the same f and a smaller h. Of these,
    entered at one tick, the one of the smallest toll has the smallest key. Entries made before have no smaller f, and
    where it is the same, no smaller h than the resource of the path that was expanded in their place, so a larger one
    than what follows. A robot that has `followed` a plan, starts at its goal, or is too far from it, is left to the
    search.
    """
    if followed != NONE or has_stops(empty, robot):
        return find_plan_by(empty, robot, followed, now, NEVER, NEVER)
    graph = empty.graph
    search = empty.search
    resource = int(empty.robots.start[robot])
    goal = int(empty.robots.goal[robot])
    pace = int(empty.robots.pace[robot])
    enter = int(empty.robots.release[robot])
    slot = guide_slot(empty, robot, resource)
    toll = toll_of(empty, slot, resource)
    ready = max(enter + pace * int(graph.duration[resource]), now)
    if resource == goal or toll < 0 or ready + (toll >> 32) > LARGEST:
        return find_plan_by(empty, robot, NONE, now, NEVER, NEVER)
    empty.counters[ASKED] += 1
    search.generation[0] += 1
    label = int(search.generation[0]) << 32
    search.opens[0] = 0
    search.least[0] = enter + (toll >> 32)
    expansions = 0
    while True:
        search.reached[int(empty.windows.offset[resource])] = label - enter
        expansions = note_expansion(empty, expansions, resource, enter, ready, expansions - 1, (enter << 32) + toll)
        if resource == goal:
            break
        toll = NO_LIMIT
        for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
            target = int(graph.target[edge])
            if 0 <= toll_of(empty, slot, target) < toll:
                toll = toll_of(empty, slot, target)
                resource = target
        enter = ready
        ready = enter + pace * int(graph.duration[resource])
    search.expansions[0] = expansions
    record = start_record(empty, robot, 0, 0)
    write_record(empty, record, expansions, True)
    return record


@inlined
def note_expansion(state: State, expansions: int, resource: int, enter: int, ready: int, came: int, key: int) -> int:
    """Note the next expansion of a search, which came from the expansion `came`; how many there are then."""
    search = state.search
    if expansions == search.expanded.size:
        raise RoomExhausted
    search.expanded[expansions] = resource
    search.entered[expansions] = enter
    search.ready[expansions] = ready
    search.came[expansions] = came
    search.popped[expansions] = key
    return expansions + 1


@inlined
def key_by(entry: int, toll: int, opens: int, greed: int) -> int:
    """The key of a window, also in a greedy query."""
    if greed == 0:
        return key_of(entry, toll, opens)
    return (greedy_f(entry, toll >> 32, opens, greed) << 32) + (toll & LOW)


@compiled
def search(  # noqa: C901, PLR0911, PLR0912, PLR0915 - one hot loop
    state: State,
    robot: int,
    slot: int,
    resource: int,
    enter: int,
    ready: int,
    behind: int,
    latest: int,
    asked: int,
) -> int:
    """A* from the resource, entered at `enter` and left from `ready` on; the number of expansions, 0: no plan.

    The last of them is the window in which the plan ends.

    It is `FURTHER` where a window that the guide does not reach might be expanded next. The guide reaches all that is
    as near to the goal as the resource from which it is entered, so the key of that window is no less than if that were
    all that is left to go. With a key above those that are expanded, it would have waited in the queue. So would it
    while windows of an f up to `opens` are left, as its h is larger than theirs.

    A window of a larger f than `latest` is in no plan that arrives by then, nor is one expanded before the goal of such
    a plan is: no window of that kind is put into the queue, and the windows expanded stay the same.
    The window in which the robot stands can be entered again if it has stayed at its goal for too long to end there;
    otherwise entering it again leads nowhere new.

    A robot that parks ends its plan in the last window of its goal. Windows of an f up to the tick at which that opens
    come first, whatever their f. One of them may be entered earlier once it has been expanded; then it is expanded
    again. A plan is a chain of expansions, so what the first led to keeps its way. The last window of the goal, entered
    as it opens, has the smallest key of all but earlier windows of the goal, which do not lead to it any earlier: the
    search ends at once. Where no window of an f up to that tick is left, each has its smallest g, and A* goes on as
    ever.

    `carp_optimized.queries.ways_back` looks now and then whether there is a plan at all; where it finds that there is
    none, `expansions[0]` is `UNKNOWN`, as not all is known that this depends on. A noted query for plans by a tick is
    asked why there is none, so it does not look. Where the goal is not free for ever by `latest`, nothing is expanded.

    The best of the windows reached last waits outside the heap, for it is often the next. Windows between which there
    are only robots behind are one: from `window`, by which it is known, to `tail`.
    """
    graph = state.graph
    windows = state.windows
    reached = state.search.reached
    parent = state.search.parent
    keys = state.search.keys
    nodes = state.search.nodes
    goal = int(state.robots.goal[robot])
    pace = int(state.robots.pace[robot])
    parks = state.parks
    counts_all = behind == NEVER
    several = state.stays.start.size > BLOCK
    alike = pace * state.longest if state.last_alike else 0
    is_bounded = latest <= LARGEST
    largest_key = (latest << 32) + LOW
    state.search.expansions[0] = 0
    opens = opens_at(state, goal, behind) if parks else 0
    state.search.opens[0] = opens
    if asked == WHOLE:
        opens = 0
    elif opens > latest or opens == NEVER:
        return 0
    toll = toll_of(state, slot, resource)
    if toll < 0:
        if toll == TOO_FAR:
            raise TicksExhausted
        return 0
    state.search.least[0] = enter + (toll >> 32)
    last_goal = goal if opens > 0 else NONE
    greed = GREED if asked == GREEDY else 0
    effort = effort_of(asked, toll >> 32)
    may_look = parks and counts_all and asked != WHOLE and (asked != NOTED or not is_bounded)
    next_look = FEWEST // 2 if may_look else NEVER
    generation = int(state.search.generation[0]) + 1
    state.search.generation[0] = generation
    label = generation << 32
    own_slot = stand(state, resource, enter, behind)
    overstayed = resource == goal and not parks and ready > enter + pace * int(graph.duration[resource])
    if not overstayed:
        reached[own_slot] = label - enter
    reached[STANDING] = label - enter
    parent[STANDING] = NONE
    best = STANDING
    best_key = key_by(enter, toll, opens, greed)
    if best_key > largest_key:
        return 0
    size = 0
    expansions = 0
    unseen = NO_KEY
    beyond = False
    while True:
        if size > 0 and keys[0] < best_key:
            key = int(keys[0])
            node = int(nodes[0])
            if best == NONE:
                size -= 1
                best_key = int(keys[size])
                best = int(nodes[size])
            replace_root(keys, nodes, size, best_key, best)
        elif best == NONE:
            break
        else:
            key = best_key
            node = best
        best = NONE
        best_key = NO_LIMIT
        resource = int(windows.resource[node])
        enter = label - int(reached[node])
        toll = toll_of(state, slot, resource)
        if key != key_by(enter, toll, opens, greed):
            continue  # entered earlier since this entry was made
        if key >= unseen:
            return FURTHER
        if expansions >= effort:
            state.search.expansions[0] = UNKNOWN
            return 0
        if expansions >= next_look:
            next_f = max(key >> 32, 0) if greed == 0 else 0
            next_look = look_back(state, robot, slot, next_f, latest, expansions)
            if next_look == CUT_OFF:
                state.search.expansions[0] = UNKNOWN
                return 0
        last = node if counts_all else end_of_run(state, node, behind)
        end = int(windows.end[last])
        if expansions > 0:
            ready = enter + (alike if alike > 0 else pace * int(graph.duration[resource]))
        this = expansions
        expansions = note_expansion(state, this, resource, enter, ready, int(parent[node]), key)
        if resource == goal and (end == NEVER if parks else not (overstayed and node == STANDING)):
            state.search.expansions[0] = expansions
            return expansions
        source = int(windows.source[last])
        exchanges = several and (graph.capacity[resource] != 1 or is_grouped(graph, source))
        to_go = toll & ~LOW
        for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
            target = int(graph.target[edge])
            toll = toll_of(state, slot, target)
            if toll < 0:
                if toll == FURTHER:
                    unseen = min(unseen, max(key_by(ready, to_go, opens, greed), 0))
                beyond |= toll == TOO_FAR
                continue
            if is_bounded and (ready << 32) + toll > largest_key:
                continue
            need = alike if alike > 0 else pace * int(graph.duration[target])
            first = int(windows.offset[target])
            row_end = first + int(windows.size[target])
            is_block = row_end <= first + BLOCK
            ends = EVERY
            usable = 0
            if is_block:
                if not counts_all:
                    ends = below(windows.rank, first, behind + 1)
                late = EVERY - below(windows.end, first, min(ready + need, NEVER))
                usable = late & ends & ((1 << (row_end - first)) - 1)
                tail = first + lowest(usable) if usable > 0 else row_end
            else:
                tail = skip_below(windows.end, first, row_end, ready + need)
                tail = tail if counts_all or tail == row_end else end_of_run(state, tail, behind)
            while tail < row_end:
                if counts_all:
                    window = tail
                elif is_block:
                    window = first + width(ends & ((1 << (tail - first)) - 1))
                else:
                    window = start_of_run(state, tail, behind)
                entry = max(ready, int(windows.start[window]))
                if entry > end:
                    break
                until = int(windows.end[tail])
                if is_block:
                    usable &= usable - 1
                    tail = first + lowest(usable) if usable > 0 else row_end
                else:
                    tail += 1
                    tail = tail if counts_all or tail == row_end else end_of_run(state, tail, behind)
                if entry + need > until or label - entry <= reached[window]:
                    continue
                if exchanges or (entry == end and source == target):
                    while entry <= end and is_exchange(state, last, entry, target):
                        entry += 1
                    if entry > end or entry + need > until or label - entry <= reached[window]:
                        continue
                if entry > LARGEST or entry + (toll >> 32) > LARGEST:
                    beyond = True
                    continue
                key = key_by(entry, toll, opens, greed)
                if key > largest_key:
                    break
                reached[window] = label - entry
                parent[window] = this
                if until == NEVER and target == last_goal and entry == opens:
                    expansions = note_expansion(state, expansions, target, entry, entry + need, this, key)
                    state.search.expansions[0] = expansions
                    return expansions
                if key < best_key:
                    if best != NONE:
                        push(keys, nodes, size, best_key, best)
                        size += 1
                    best = window
                    best_key = key
                else:
                    push(keys, nodes, size, key, window)
                    size += 1
    if unseen <= largest_key and unseen < NO_KEY:
        return FURTHER
    if beyond and not is_bounded:
        raise TicksExhausted
    state.search.expansions[0] = expansions
    return 0
