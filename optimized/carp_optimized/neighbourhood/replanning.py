"""Replanning the robots behind the one taken out (`neighbourhood/replan`), asking only what can have changed.

A query need not be repeated if the last window of its goal opens at the same tick, so that the same windows come first,
or at one up to its least f, and the windows it would see differ from those it saw as follows.

- Stays were taken back that it could not use. An entry that the search does not insert into its queue again changes
  nothing. Neither does an entry with a larger key than all that are popped afterwards, up to the goal: it is never
  popped. A stay of s taken back in [earliest, latest) lets a resource r that was expanded lead into s at a tick of
  (earliest - d(s), latest), and, if it is s that was expanded, lead out of it at a tick after earliest, or at earliest
  to the resource from which the robot came, as it is not met on the way. Where no such tick is one at which r was left,
  or can be entered now, or has a key that is small enough, nothing changes. A plan that ends in a goal for ever may end
  there earlier, too.
- Stays were added that leave room for the plan found. Then the same plan is found again. Each window on its path is
  still entered at the same tick from the same parent, because any other way to a window existed before, no later, and
  was rejected. Two entries of the queue are popped in the same order as before, because each is inserted when its own
  ancestors are popped, and by induction these are popped in the same order. Of windows that come first, those entered
  later are popped no sooner, as keys grow with the tick. The query would have read everything that
  it now reads before too, at ticks no later and with keys no larger popped behind it. So the first case still applies
  later on.

A plan made earlier and now under way is the same query with fewer ways to begin, so the second case holds for it.
"""

from carp_optimized.jit.blocks import BLOCK
from carp_optimized.jit.compiling import compiled, inlined
from carp_optimized.queries.guides import guide_slot, key_of, toll_of
from carp_optimized.queries.search import find_plan_by
from carp_optimized.state.arrays import (
    KEPT,
    NEVER,
    NONE,
    SEVERAL,
    UNCHANGED,
    UNKNOWN,
    Freed,
    Options,
    State,
    Work,
)
from carp_optimized.state.groups import is_grouped
from carp_optimized.state.records import same_plan
from carp_optimized.windows.fitting import end_of_run, has_same_order, plan_fits
from carp_optimized.windows.reserving import evict, reserve, reserve_but, withdraw, withdraw_but
from carp_optimized.windows.rows import last_by


@compiled
def forget_freed(freed: Freed) -> None:
    """Set a new mark: nothing has been taken back since."""
    freed.now[0] += 1
    freed.regions[0] = 0
    for resource in range(freed.near_latest.size):
        freed.near_earliest[resource] = NEVER
        freed.near_latest[resource] = 0


@compiled
def note_freed(state: State, record: int, head: int, tail: int) -> None:
    """Note that the stays of a plan have been taken back, but for its first `head` and its last `tail`.

    A stay in a resource of a group is one in each resource of the group.
    """
    graph = state.graph
    records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    source = int(records.resource[first + head - 1]) if head > 0 else NONE
    regions = int(state.freed.regions[0])
    for k in range(first + head, last + 1 - tail):
        resource = int(records.resource[k])
        enter = int(records.enter[k]) - state.gap
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        leave = min(leave + state.gap, NEVER)
        meets_groups = is_grouped(graph, resource) or is_grouped(graph, source)
        regions |= note_stay(state, resource, enter, leave, SEVERAL if meets_groups else source)
        for j in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
            group = int(graph.group[j])
            for i in range(int(graph.members_first[group]), int(graph.members_first[group + 1])):
                regions |= note_stay(state, int(graph.member[i]), enter, leave, SEVERAL)
        source = resource
    state.freed.regions[0] = regions


@inlined
def note_stay(state: State, resource: int, enter: int, leave: int, source: int) -> int:
    """Note that a stay has been taken back of a robot that came from the source; the bits of the regions."""
    freed = state.freed
    graph = state.graph
    mark = int(freed.now[0])
    if freed.mark[resource] == mark:
        freed.earliest[resource] = min(int(freed.earliest[resource]), enter)
        freed.latest[resource] = max(int(freed.latest[resource]), leave)
        freed.source[resource] = SEVERAL
    else:
        freed.mark[resource] = mark
        freed.earliest[resource] = enter
        freed.latest[resource] = leave
        freed.source[resource] = source
    note_near(freed, resource, enter, leave)
    regions = int(graph.region[resource])
    for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
        near = int(graph.source[edge])
        note_near(freed, near, enter, leave)
        regions |= int(graph.region[near])
    return regions


@compiled
def note_near(freed: Freed, resource: int, enter: int, leave: int) -> None:
    """Note that a stay there, or one move away, has been taken back."""
    freed.near_earliest[resource] = min(int(freed.near_earliest[resource]), enter)
    freed.near_latest[resource] = max(int(freed.near_latest[resource]), leave)


@compiled
def could_use_freed(state: State, record: int, behind: int) -> bool:
    """Whether the query that found the plan could find another now; of a plan that no query found, always.

    Robots of a rank above `behind` do not count, among which is the plan's own, for its stays are free to it.
    Most plans have read nothing in a region where stays were taken back, or next to it.
    """
    freed = state.freed
    records = state.records
    if records.expansions[record] == UNKNOWN or not has_same_order(state, record, behind):
        return True
    if records.regions[record] & freed.regions[0] == 0:
        return False
    mark = int(freed.now[0])
    reach = int(state.robots.pace[records.robot[record]]) * state.longest
    first = int(records.expansions_at[record])
    last = first + int(records.expansions[record]) - 1
    for k in range(first, last + 1):
        resource = int(records.expanded[k])
        is_early = freed.near_earliest[resource] - reach < records.until[k]
        is_late = records.ready[k] < freed.near_latest[resource]
        if is_early & is_late:  # one branch for both: of a branch for each, half would be mispredicted
            if freed.mark[resource] == mark:
                if state.parks and k < last and resource == records.expanded[last]:
                    return True
                if leads_out(state, record, k, behind):
                    return True
            if leads_in(state, record, k, behind):
                return True
    return False


@inlined
def leads_out(state: State, record: int, k: int, behind: int) -> bool:
    """Whether the expansion's resource, which lost a stay, could be left again so that it matters."""
    graph = state.graph
    records = state.records
    resource = int(records.expanded[k])
    ready = int(records.ready[k])
    earliest = int(state.freed.earliest[resource])
    source = int(state.freed.source[resource])
    if state.freed.latest[resource] <= ready:
        return False
    last_use = int(records.until[k])
    for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
        target = int(graph.target[edge])
        exit = max(ready, earliest if source in (target, SEVERAL) else earliest + 1)
        if exit <= last_use and matters(state, record, k, target, exit, last_use, behind):
            return True
    return False


@inlined
def leads_in(state: State, record: int, k: int, behind: int) -> bool:
    """Whether the expansion's resource leads again into one that lost a stay, so that it matters."""
    graph = state.graph
    freed = state.freed
    records = state.records
    mark = int(freed.now[0])
    resource = int(records.expanded[k])
    ready = int(records.ready[k])
    until = int(records.until[k])
    pace = int(state.robots.pace[records.robot[record]])
    for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
        target = int(graph.target[edge])
        if freed.mark[target] == mark:
            entry = max(ready, int(freed.earliest[target]) - pace * int(graph.duration[target]) + 1)
            last_entry = min(until, int(freed.latest[target]) - 1)
            if entry <= last_entry and matters(state, record, k, target, entry, last_entry, behind):
                return True
    return False


@inlined
def matters(state: State, record: int, k: int, target: int, entry: int, last_entry: int, behind: int) -> bool:
    """Whether the target can be entered between the two ticks with a key that would be popped.

    Exchanges are allowed, and windows of resources with room for several not looked at: no harm but a query.
    """
    robot = int(state.records.robot[record])
    toll = toll_of(state, guide_slot(state, robot, target), target)
    largest = int(state.records.largest[k])
    opens = int(state.records.opens[record])
    if toll < 0 or key_of(entry, toll, opens) > largest:
        return False
    if state.graph.capacity[target] != 1:
        return True
    windows = state.windows
    need = int(state.robots.pace[robot]) * int(state.graph.duration[target])
    row_end = int(windows.offset[target]) + int(windows.size[target])
    slot = max(last_by(windows, target, entry), int(windows.offset[target]))
    while slot < row_end:
        entry = max(entry, int(windows.start[slot]))
        slot = end_of_run(state, slot, behind)
        if entry > last_entry:
            return False
        if entry + need <= windows.end[slot]:
            return key_of(entry, toll, opens) <= largest
        slot += 1
    return False


@compiled
def lift(state: State, work: Work, first: int, size: int, now: int) -> None:
    """Withdraw the plans from the position `first` on, but for those that keep no place from now on.

    Where following is forbidden, a robot that has just left does.
    """
    for position in range(first, size):
        record = int(state.reserved[work.outside[position]])
        if record != NONE and int(state.records.leave[record]) + state.gap > now:
            withdraw(state, record)


@compiled
def replan(state: State, work: Work, size: int, first: int, now: int, options: Options) -> int:
    """Replan the robots outside from the position `first` on and reserve their plans; how many robots have one.

    A query takes no account of its own robot and those behind, whose plans stay reserved until they change or are run
    into; only where resources have room for several, whose windows do not tell robots apart, are they lifted first.
    A plan that still fits can be found again, so none that arrives later is.
    A plan that has ended stays. Where following is forbidden, another may come too soon after it, and then the robot
    has none.
    Robots before the position keep their plans; where `kept` is off they are replanned too, to the same effect, if
    their plans came from queries.
    """
    several = state.stays.start.size > BLOCK
    lifted = False
    for position in range(first if options.kept else 0, size):
        robot = int(work.outside[position])
        record = int(work.held[robot])
        if work.ended[robot]:
            if state.reserved[robot] == NONE:
                if not plan_fits(state, record):
                    return leave_without_plans(state, work, position, size, now)
                reserve(state, record)
            continue
        still_fits = record != NONE and is_free(state, record, lifted)
        if record != NONE and stands(state, record, position < first, still_fits, options.unchanged):
            if lifted:
                reserve(state, record)
            continue
        if several and not lifted:
            lift(state, work, position, size, now)
            lifted = True
        latest = int(state.records.arrival[record]) if still_fits else NEVER
        plan = find_plan_by(state, robot, int(work.before[robot]), now, int(state.rank[robot]) - 1, latest)
        if plan == NONE:
            return leave_without_plans(state, work, position, size, now)
        work.held[robot] = plan
        exchange_plan(state, robot, record, plan, lifted)
    if options.kept:
        state.counters[KEPT] += min(first, size)
    return size


@compiled
def exchange_plan(state: State, robot: int, record: int, plan: int, lifted: bool) -> None:
    """Reserve the plan just found instead of that of the record, which may be none, and may be reserved still.

    Stays that both begin or end with, coming from the same place and going to the same place, are neither taken back
    nor added: to the robots behind nothing has changed there.
    """
    is_reserved = state.reserved[robot] != NONE
    head = 0
    tail = 0
    if record != NONE:
        if same_plan(state.records, record, plan):
            if is_reserved:
                state.reserved[robot] = plan
                return
        else:
            head = alike_at_start(state, record, plan)
            tail = alike_at_end(state, record, plan)
            note_freed(state, record, head, tail)
    if is_reserved:
        withdraw_but(state, record, head, tail)
    else:
        head = 0
        tail = 0
    if not lifted:
        evict(state, plan, head, tail)
    reserve_but(state, plan, head, tail)


@compiled
def alike_at_start(state: State, one: int, other: int) -> int:
    """How many first stays two plans that differ have in common, with the moves out of them; with groups, none.

    A stay in a group may have begun with one of them and end later.
    """
    if state.graph.group.size > 0:
        return 0
    records = state.records
    here = int(records.visits_at[one])
    there = int(records.visits_at[other])
    size = min(int(records.visits[one]), int(records.visits[other]))
    k = 0
    while (
        k < size
        and records.resource[here + k] == records.resource[there + k]
        and records.enter[here + k] == records.enter[there + k]
    ):
        k += 1
    return max(k - 1, 0)


@compiled
def alike_at_end(state: State, one: int, other: int) -> int:
    """How many last stays two plans that differ have in common, with the moves into them; with groups, none."""
    records = state.records
    if state.graph.group.size > 0 or records.leave[one] != records.leave[other]:
        return 0
    here = int(records.visits_at[one]) + int(records.visits[one]) - 1
    there = int(records.visits_at[other]) + int(records.visits[other]) - 1
    size = min(int(records.visits[one]), int(records.visits[other]))
    k = 0
    while (
        k < size
        and records.resource[here - k] == records.resource[there - k]
        and records.enter[here - k] == records.enter[there - k]
    ):
        k += 1
    return max(k - 1, 0)


@compiled
def is_free(state: State, record: int, lifted: bool) -> bool:
    """Whether the plan still fits; if none is `lifted`, one that is reserved does."""
    return plan_fits(state, record) if lifted else bool(state.reserved[state.records.robot[record]] == record)


@compiled
def stands(state: State, record: int, is_before: bool, still_fits: bool, skip_unchanged: bool) -> bool:
    """Whether the plan need not be asked for again."""
    if is_before and state.records.expansions[record] == UNKNOWN:
        return True
    if (
        skip_unchanged
        and still_fits
        and not could_use_freed(state, record, int(state.rank[state.records.robot[record]]) - 1)
    ):
        state.counters[UNCHANGED] += 1
        return True
    return False


@compiled
def leave_without_plans(state: State, work: Work, position: int, size: int, now: int) -> int:
    """The robot at the position and those behind it have no plan, but for those that have ended; the position."""
    lift(state, work, position, size, now)
    for k in range(position, size):
        if not work.ended[work.outside[k]]:
            work.held[work.outside[k]] = NONE
    return position
