"""Which of the plans given to a query its answer depends on: the answer is the same without the others.

A query that finds a plan, or none that arrives in time, would do the same if stays were taken back that it could not
use (`carp_optimized.neighbourhood.replanning`). Several at once make no difference: a tick at which a resource can be
entered only now is one at which some stay taken back was in the way. So a plan is left out if none of its stays could
be used.

The ticks between which stays could be used are summed up by resource, which errs on the safe side: when an expansion
could lead into it, with the largest key popped afterwards, and when it could be left itself.

The tick at which the last window of the goal opens decides which windows come first, so a plan that has left the goal
no sooner counts too.
"""

from carp_optimized.jit.compiling import compiled, inlined
from carp_optimized.jit.kinds import Longs
from carp_optimized.queries.guides import key_of, toll_of
from carp_optimized.state.arrays import FIRST, FURTHER, LOW, NEVER, NONE, PLANS, Answers, State

QUERY, READY, UNTIL, LARGEST_KEY = range(4)
ENTERED, LEFT = 0, 4  # where these four begin in a row of `Answers.read`


@compiled
def reasons(state: State, answers: Answers, robot: int, record: int, latest: int, given: int) -> int:
    """Those of the plans given that the robot's last query could have done without to find another plan, or one.

    It found the record, or none that arrives by `latest`. Plans without a number count as reasons.
    """
    sum_up(state, answers, robot, record, latest)
    found = given & (1 << PLANS)
    for plan in range(int(answers.used[0])):
        if (given >> plan) & 1 == 1 and could_be_used(state, answers, robot, int(answers.record[plan])):
            found |= 1 << plan
    return found


@compiled
def sum_up(state: State, answers: Answers, robot: int, record: int, latest: int) -> None:
    """Sum up the expansions of the last query, from the last one on."""
    graph = state.graph
    search = state.search
    answers.used[2] += 1
    query = int(answers.used[2])
    ticks = state.guides.ticks[state.guides.slot[state.robots.destination[robot]]]
    pace = int(state.robots.pace[robot])
    goal = int(state.robots.goal[robot])
    f = latest if record == NONE else int(state.records.arrival[record])
    largest = (f << 32) + LOW if record == NONE else FIRST
    for k in range(int(search.expansions[0]) - 1, -1, -1):
        resource = int(search.expanded[k])
        ready = int(search.ready[k])
        until = f - int(ticks[resource]) + pace * int(graph.duration[resource])
        could_end = state.parks and resource == goal and record == NONE  # if no stay came later, at whatever tick
        note(answers.read[resource], LEFT, query, ready, NEVER if could_end else until, largest)
        for edge in range(int(graph.first[resource]), int(graph.first[resource + 1])):
            note(answers.read[graph.target[edge]], ENTERED, query, ready, until, largest)
        largest = max(largest, int(search.popped[k]))


@inlined
def note(read: Longs, kind: int, query: int, ready: int, until: int, largest: int) -> None:
    """Note that the resource of the row could be entered, or left, between two ticks, with a key up to the largest."""
    if read[kind + QUERY] != query:
        read[kind + QUERY] = query
        read[kind + READY] = ready
        read[kind + UNTIL] = until
        read[kind + LARGEST_KEY] = largest
    else:
        read[kind + READY] = min(int(read[kind + READY]), ready)
        read[kind + UNTIL] = max(int(read[kind + UNTIL]), until)
        read[kind + LARGEST_KEY] = max(int(read[kind + LARGEST_KEY]), largest)


@compiled
def could_be_used(state: State, answers: Answers, robot: int, plan: int) -> bool:
    """Whether the robot could have used what a plan keeps from it."""
    graph = state.graph
    records = state.records
    first = int(records.visits_at[plan])
    last = first + int(records.visits[plan]) - 1
    for k in range(first, last + 1):
        resource = int(records.resource[k])
        enter = int(records.enter[k]) - state.gap
        leave = int(records.enter[k + 1] if k < last else records.leave[plan]) + state.gap
        if stay_could_be_used(state, answers, robot, resource, enter, leave):
            return True
        for j in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
            group = int(graph.group[j])
            for i in range(int(graph.members_first[group]), int(graph.members_first[group + 1])):
                if stay_could_be_used(state, answers, robot, int(graph.member[i]), enter, leave):
                    return True
    return False


@inlined
def stay_could_be_used(state: State, answers: Answers, robot: int, resource: int, enter: int, leave: int) -> bool:
    """Whether the robot could have used the resource in the ticks of a stay, or would have parked there sooner."""
    read = answers.read[resource]
    query = int(answers.used[2])
    opens = int(state.search.opens[0])
    if state.parks and resource == state.robots.goal[robot] and leave >= opens:
        return True
    if read[LEFT + QUERY] == query and enter <= read[LEFT + UNTIL] and leave > read[LEFT + READY]:
        return True
    if read[ENTERED + QUERY] == query:
        pace = int(state.robots.pace[robot])
        entry = max(int(read[ENTERED + READY]), enter - pace * int(state.graph.duration[resource]) + 1)
        if entry <= read[ENTERED + UNTIL] and entry < leave:
            toll = toll_of(state, int(state.guides.slot[state.robots.destination[robot]]), resource)
            return toll == FURTHER or (toll >= 0 and key_of(entry, toll, opens) <= int(read[ENTERED + LARGEST_KEY]))
    return False
