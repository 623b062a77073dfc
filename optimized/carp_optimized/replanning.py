"""Replanning the robots behind the one taken out (`neighbourhood/replan`), asking only what can have changed.

A query need not be repeated if the windows it would see differ from those it saw as follows.

- Stays were taken back that it could not use. It saw a window of s only from a resource r that it expanded, at ticks
  from `ready` on. A stay taken back in [earliest, latest) lets it enter s no earlier than max(ready, earliest - d(s)),
  or leave s, d(s) or more ticks later than that, in a way that it could not before. All that comes of it has
  f >= max(ready, earliest - d(s)) + h(s), as h is consistent; where that is above f of the plan found, the search
  pops the goal first and never sees a difference. Nor does it where latest <= ready.
- Stays were added that leave room for the plan found. Then it is found again: each window on its path is still
  entered at the same tick from the same parent, because any other way to a window was a way before, no later, and
  was refused then; and two entries of the queue are popped in the same order as before, because each is in it as
  early as its own ancestors are popped, which by induction are popped in the same order. What the query now reads
  it would have read before too, so that the first case still applies later on.

A plan made earlier and now under way is the same query with fewer ways to begin, so the second case holds for it.
"""

from carp_optimized.arrays import KEPT, NONE, UNCHANGED, UNKNOWN, Freed, Options, State, Work
from carp_optimized.compiling import compiled
from carp_optimized.guides import guide_slot
from carp_optimized.records import arrival, same_plan
from carp_optimized.search import find_plan
from carp_optimized.windows import evict, plan_fits, reserve, withdraw


@compiled
def forget_freed(freed: Freed) -> None:
    """Set a new mark: nothing has been taken back since."""
    freed.now[0] += 1


@compiled
def note_freed(state: State, record: int) -> None:
    """Note the stays of a plan that has been taken back."""
    freed = state.freed
    graph = state.graph
    records = state.records
    mark = int(freed.now[0])
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        enter = int(records.enter[k])
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        if freed.mark[resource] == mark:
            freed.earliest[resource] = min(int(freed.earliest[resource]), enter)
            freed.latest[resource] = max(int(freed.latest[resource]), leave)
            continue
        freed.mark[resource] = mark
        freed.earliest[resource] = enter
        freed.latest[resource] = leave
        for edge in range(int(graph.backward_first[resource]), int(graph.backward_first[resource + 1])):
            freed.near[graph.source[edge]] = mark


@compiled
def could_use_freed(state: State, record: int) -> bool:
    """Whether the query that found the plan could find another now; of a plan that no query found, always."""
    freed = state.freed
    graph = state.graph
    records = state.records
    if records.expansions[record] == UNKNOWN:
        return True
    mark = int(freed.now[0])
    robot = int(records.robot[record])
    pace = int(state.robots.pace[robot])
    f = arrival(records, record)
    first = int(records.expansions_at[record])
    start = int(records.expanded[first])
    guide = state.guides.table[guide_slot(state, int(state.robots.destination[robot]))]
    if freed.mark[start] == mark:
        entered = int(freed.earliest[start]) - pace * int(graph.duration[start])
        if entered + (int(guide[start]) >> 32) <= f:
            return True
    for k in range(first, first + int(records.expansions[record])):
        resource = int(records.expanded[k])
        if freed.near[resource] != mark:
            continue
        ready = int(records.ready[k])
        for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
            target = int(graph.target[edge])
            if freed.mark[target] == mark and freed.latest[target] > ready and guide[target] >= 0:
                entered = max(ready, int(freed.earliest[target]) - pace * int(graph.duration[target]))
                if entered + (int(guide[target]) >> 32) <= f:
                    return True
    return False


@compiled
def lift(state: State, work: Work, first: int, size: int) -> None:
    """Withdraw the plans from the position `first` on, but for those that have ended."""
    for position in range(first, size):
        robot = int(work.outside[position])
        if not work.ended[robot] and state.reserved[robot] != NONE:
            withdraw(state, int(state.reserved[robot]))


@compiled
def replan(  # noqa: C901 - the cases of one robot
    state: State, work: Work, size: int, first: int, now: int, options: Options
) -> int:
    """Replan the robots outside from the position `first` on and reserve their plans; how many robots have one.

    A query takes no account of the robots behind its own, whose plans stay reserved until they change or are run
    into; only where resources have room for several, whose windows do not tell robots apart, are they lifted first.
    Robots before the position keep their plans; where `kept` is off they are planned anew too, to the same effect, if
    their plans came from queries.
    """
    several = state.stays.start.size > 1
    lifted = False
    for position in range(size):
        robot = int(work.outside[position])
        state.rank[robot + 1] = NONE if work.ended[robot] else position
    for position in range(first if options.kept else 0, size):
        robot = int(work.outside[position])
        if work.ended[robot]:
            continue
        record = int(work.held[robot])
        if record != NONE and stands(state, record, position < first, lifted, options.unchanged):
            if lifted:
                reserve(state, record)
            continue
        if several and not lifted:
            lift(state, work, position, size)
            lifted = True
        elif state.reserved[robot] != NONE:
            withdraw(state, int(state.reserved[robot]))
        plan = find_plan(state, robot, int(work.before[robot]), now, position)
        if plan == NONE:
            lift(state, work, position, size)
            leave_without_plan(work, position, size)
            return position
        if record != NONE and not same_plan(state.records, record, plan):
            note_freed(state, record)
        work.held[robot] = plan
        if not lifted:
            evict(state, plan)
        reserve(state, plan)
    if options.kept:
        state.counters[KEPT] += min(first, size)
    return size


@compiled
def stands(state: State, record: int, is_before: bool, lifted: bool, skip_unchanged: bool) -> bool:
    """Whether the plan need not be asked for again; if none is `lifted`, one that is reserved still fits."""
    if is_before and state.records.expansions[record] == UNKNOWN:
        return True
    still_fits = plan_fits(state, record) if lifted else state.reserved[state.records.robot[record]] == record
    if skip_unchanged and still_fits and not could_use_freed(state, record):
        state.counters[UNCHANGED] += 1
        return True
    return False


@compiled
def leave_without_plan(work: Work, position: int, size: int) -> None:
    """The robot at the position and those behind it have no plan, but for those that have ended."""
    for k in range(position, size):
        if not work.ended[work.outside[k]]:
            work.held[work.outside[k]] = NONE
