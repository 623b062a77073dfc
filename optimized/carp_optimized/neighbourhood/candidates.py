"""The robots that are in the way of a plan, cross it, or are near it: those that a round may take out."""

from carp_optimized.jit.blocks import BLOCK
from carp_optimized.jit.compiling import compiled
from carp_optimized.neighbourhood.distances import Mean, distance_below, is_apart, is_less
from carp_optimized.state.arrays import MARKED, MARKS, MOST_MEMBERS, NEVER, NONE, Polish, State


@compiled
def mark_spans(state: State, polish: Polish, record: int) -> None:
    """Mark the resources that the plan visits, and those that a move leads to from there, with their spans."""
    polish.counts[MARKS] += 1
    polish.counts[MARKED] = 0
    records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        enter = int(records.enter[k])
        leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
        mark_span(polish, resource, enter, leave)
        for edge in range(int(state.graph.first[resource]), int(state.graph.first[resource + 1])):
            mark_span(polish, int(state.graph.target[edge]), enter, leave)


@compiled
def mark_span(polish: Polish, resource: int, enter: int, leave: int) -> None:
    """Make the span of the resource include the stay."""
    if polish.mark[resource] == polish.counts[MARKS]:
        polish.first[resource] = min(int(polish.first[resource]), enter)
        polish.last[resource] = max(int(polish.last[resource]), leave)
    else:
        polish.mark[resource] = polish.counts[MARKS]
        polish.first[resource] = enter
        polish.last[resource] = leave
        polish.marked[polish.counts[MARKED]] = resource
        polish.counts[MARKED] += 1


@compiled
def note_robots_in_spans(state: State, polish: Polish) -> bool:
    """Note as 1 in `others` the robots with a stay that meets a span, 0 for the others; whether windows tell robots.

    Those of a capacity above 1 do not. The windows hold all plans, and a stay is between two of them.
    """
    windows = state.windows
    if state.stays.start.size > BLOCK:
        return False
    for robot in range(polish.others.size):
        polish.others[robot] = 0
    for k in range(int(polish.counts[MARKED])):
        resource = int(polish.marked[k])
        slot = int(windows.offset[resource])
        last = slot + int(windows.size[resource]) - 1
        # a stay begins as the window before it ends, and ends as the window behind it begins, but for the gaps
        while slot < last and int(windows.start[slot + 1]) - state.gap < polish.first[resource]:
            slot += 1
        while slot < last and int(windows.end[slot]) + state.gap <= polish.last[resource]:
            polish.others[windows.robot[slot]] = 1
            slot += 1
    return True


@compiled
def meets_span(state: State, polish: Polish, record: int) -> bool:
    """Whether a stay of the plan meets the span of its resource."""
    records = state.records
    first = int(records.visits_at[record])
    last = first + int(records.visits[record]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        if polish.mark[resource] == polish.counts[MARKS]:
            leave = int(records.enter[k + 1]) if k < last else int(records.leave[record])
            if polish.first[resource] <= leave and records.enter[k] <= polish.last[resource]:
                return True
    return False


@compiled
def crossing(state: State, record: int, chosen: int) -> int:
    """The plan's visit to the resource of the chosen visit that begins the fewest ticks apart from it; else `NONE`."""
    records = state.records
    nearest = NONE
    least = NEVER
    first = int(records.visits_at[record])
    for visit in range(first, first + int(records.visits[record])):
        apart = abs(int(records.enter[visit]) - int(records.enter[chosen]))
        if records.resource[visit] == records.resource[chosen] and apart < least:
            nearest = visit
            least = apart
    return nearest


@compiled
def rank_crossing(state: State, polish: Polish, pivot: int, chosen: int, most: int) -> int:
    """Rank the robots that visit the resource of the chosen visit (`polish/contested`); how many there are.

    With the pivot they are at most as many as given.
    """
    records = state.records
    resource = int(records.resource[chosen])
    polish.counts[MARKS] += 1
    polish.counts[MARKED] = 0
    mark_span(polish, resource, 0, NEVER)
    is_told = note_robots_in_spans(state, polish)
    count = 0
    for robot in range(polish.plans.size):
        record = int(polish.plans[robot])
        if robot == pivot or record == NONE or (is_told and polish.others[robot] == 0):
            continue
        visit = crossing(state, record, chosen)
        if visit != NONE:
            apart = abs(int(records.enter[visit]) - int(records.enter[chosen]))
            count = insert(polish, count, robot, Mean(apart, 0, 1), most)
    return count


@compiled
def rank_near(state: State, polish: Polish, pivot: int) -> int:
    """Rank the robots by their distance from the pivot (`polish/near`); how many there are.

    Only those that can become members are ranked.
    """
    count = 0
    for robot in range(polish.plans.size):
        record = int(polish.plans[robot])
        if robot == pivot or record == NONE:
            continue
        farthest = Mean(1 << (31 + state.split), 0, 1)  # more than any term
        if count == MOST_MEMBERS - 1:
            farthest = Mean(int(polish.whole[count - 1]), int(polish.rest[count - 1]), int(polish.ticks[count - 1]))
        if is_apart(state, record, int(polish.plans[pivot]), farthest.whole):
            continue
        mean = distance_below(state, record, int(polish.plans[pivot]), farthest)
        if is_less(mean, farthest):
            count = insert(polish, count, robot, mean, MOST_MEMBERS)
    return count


@compiled
def insert(polish: Polish, count: int, robot: int, rank: Mean, most: int) -> int:
    """Insert a candidate behind those of its rank or less; with the pivot, as many as given are kept."""
    place = count
    while place > 0:
        before = Mean(int(polish.whole[place - 1]), int(polish.rest[place - 1]), int(polish.ticks[place - 1]))
        if not is_less(rank, before):
            break
        place -= 1
    count = min(count + 1, most - 1)
    for k in range(count - 1, place, -1):
        polish.candidates[k] = polish.candidates[k - 1]
        polish.whole[k] = polish.whole[k - 1]
        polish.rest[k] = polish.rest[k - 1]
        polish.ticks[k] = polish.ticks[k - 1]
    if place < count:
        polish.candidates[place] = robot
        polish.whole[place] = rank.whole
        polish.rest[place] = rank.rest
        polish.ticks[place] = rank.ticks
    return count
