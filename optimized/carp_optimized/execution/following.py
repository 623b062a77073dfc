"""Executing a solution in the order of its plans, as `carp_reference.execution` does, on arrays.

The dependency graph is made by numpy, and times are propagated by compiled code: tick by tick of the plans, and within
a tick until nothing changes.
"""

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from carp_optimized.execution.trace_check import follows
from carp_optimized.jit.compiling import entry
from carp_optimized.jit.kinds import Flags, Longs
from carp_optimized.state.limits import refuse_tick, refuse_what_is_too_large
from carp_spec import Instance, Plan, RobotId, Solution, Visit
from carp_spec.execution.dependencies import stays_by_constraint
from carp_spec.execution.execution_rules import require_followed, require_lawful_ends
from carp_spec.execution.traces import Trace
from carp_spec.limits import goals_stand_alone
from carp_spec.plan_rules import least_stays
from carp_spec.requests import require_trace

FOR_EVER = 2**62
NOWHERE = -1


@entry
def propagate(ranked: Longs, enter: Longs, first: Longs, before: Longs, ticks: Longs, times: Longs) -> None:
    """Raise each time to that of its edges into it; `ranked` are the nodes in the order of the ticks `enter`.

    The edges into node n are those from `first[n]` up to, not including, `first[n + 1]`.
    """
    start = 0
    while start < ranked.size:
        end = start
        while end < ranked.size and enter[ranked[end]] == enter[ranked[start]]:
            end += 1
        has_changed = True
        while has_changed:
            has_changed = False
            for place in range(start, end):
                node = ranked[place]
                time = times[node]
                for edge in range(first[node], first[node + 1]):
                    time = max(time, times[before[edge]] + ticks[edge])
                if time > times[node]:
                    times[node] = time
                    has_changed = True
        start = end


@dataclass(frozen=True, slots=True)
class Timetable:
    """A lawful solution as arrays: its visits are numbered plan by plan, plan p from `starts[p]` on.

    `before`, `after` and `ticks` are the edges, sorted by `after`, those into visit n from `first[n]` on.
    """

    instance: Instance
    solution: Solution
    starts: Longs
    enter: Longs
    duration: Longs
    ranked: Longs
    first: Longs
    before: Longs
    after: Longs
    ticks: Longs

    def times(self, least: Longs) -> Longs:
        """When each visit is entered at the earliest, none before its least tick."""
        times = least.copy()
        propagate(self.ranked, self.enter, self.first, self.before, self.ticks, times)
        return times

    def least_after(self, now: int, entered: Mapping[RobotId, Sequence[int]]) -> Longs:
        """The least ticks of visits after now, and the ticks of those that have been entered."""
        robots = self.instance.robot
        least = np.full(self.enter.size, now + 1, np.int64)
        least[self.starts[:-1]] = [max(robots[plan.robot].release, now + 1) for plan in self.solution.plans]
        for plan, start in zip(self.solution.plans, self.starts.tolist(), strict=False):
            ticks = entered.get(plan.robot, ())
            least[start : start + len(ticks)] = ticks
        return least

    def solution_at(self, times: Longs) -> Solution:
        """The solution with its visits at these ticks."""
        ends = np.append(times[1:], 0)
        lasts = self.starts[1:] - 1
        ends[lasts] = times[lasts] + self.duration[lasts]
        begins, leaves = times.tolist(), ends.tolist()
        plans: list[Plan] = []
        has_changed = np.append(np.add.reduceat(times != self.enter, self.starts[:-1]) if times.size else [], 0)
        for number, (plan, start) in enumerate(zip(self.solution.plans, self.starts.tolist(), strict=False)):
            if not has_changed[number]:
                plans.append(plan)
                continue
            visits = [
                Visit(visit.resource, begins[place], leaves[place]) for place, visit in enumerate(plan.visits, start)
            ]
            if plan.visits[-1].leave is None:
                visits[-1] = Visit(visits[-1].resource, visits[-1].enter, None)
            plans.append(Plan(plan.robot, tuple(visits)))
        return Solution(tuple(plans), self.solution.order, self.solution.unplanned)


def retime(instance: Instance, solution: Solution, trace: Trace) -> Solution:
    """The plans for the rest of the way, as `carp_reference.retime` makes them; also refuses too large numbers."""
    require_trace(instance, solution, trace)
    if not follows(instance, solution, trace):
        require_followed(instance, solution, trace)
    refuse_tick("$.now", trace.now)
    table = timetable(instance, solution)
    entered = {plan.robot: [visit.enter for visit in plan.visits] for plan in trace.plans}
    after = table.solution_at(table.times(table.least_after(trace.now, entered)))
    require_lawful_ends(instance, after, trace)
    return after


def held_up(instance: Instance, solution: Solution, trace: Trace) -> Solution:
    """The solution with what a trace tells of some robots, and others later where they wait in the planned order.

    Raises `Refusal` for numbers that are too large.
    """
    latest = max((visit.enter for plan in trace.plans for visit in plan.visits), default=0)
    refuse_tick("$.plans", latest)
    table = timetable(instance, solution)
    told = {plan.robot: plan for plan in trace.plans}
    least = table.enter.copy()
    for plan, start in zip(solution.plans, table.starts.tolist(), strict=False):
        if plan.robot in told:
            done = [visit.enter for visit in told[plan.robot].visits][: len(plan.visits)]
            least[start : start + len(done)] = done
            rest = slice(start + len(done), start + len(plan.visits))
            least[rest] = np.maximum(least[rest], trace.now + 1)
    return table.solution_at(table.times(least))


def timetable(instance: Instance, solution: Solution) -> Timetable:
    """Make the dependency graph of a lawful solution; raises `Refusal` for numbers that are too large."""
    refuse_what_is_too_large(instance)
    refuse_tick("$.plans", max((plan.visits[-1].enter for plan in solution.plans), default=0))
    index = instance.graph.index
    visits = [visit for plan in solution.plans for visit in plan.visits]
    starts = np.array([0, *accumulate(len(plan.visits) for plan in solution.plans)], np.int64)
    resource = np.array([index[visit.resource] for visit in visits], np.int64)
    enter = np.array([visit.enter for visit in visits], np.int64)
    leave = np.array([FOR_EVER if visit.leave is None else visit.leave for visit in visits], np.int64)
    paces = np.array([instance.robot[plan.robot].pace for plan in solution.plans], np.int64)
    lengths = np.array([each.duration for each in instance.graph.resources], np.int64)
    graph = instance.graph
    capacities = [each.capacity for each in graph.resources] + [each.capacity for each in graph.groups]
    capacity = np.array([min(each, FOR_EVER) for each in capacities], np.int64)
    duration = np.repeat(paces, np.diff(starts)) * lengths[resource]
    if not goals_stand_alone(instance):
        duration = np.array([ticks for plan in solution.plans for ticks in least_stays(instance, plan)], np.int64)
    is_last = np.zeros(enter.size, np.bool_)
    is_last[starts[1:] - 1] = True
    travels = np.flatnonzero(~is_last)
    constraint, begin, end = _stays(instance, solution, resource, starts)
    first, second = _pairs(instance.gap, constraint, enter[begin], leave[end], capacity)
    one, other = end[first], begin[second]
    coming = np.concatenate([[NOWHERE], resource[:-1]])
    coming[starts[:-1]] = NOWHERE
    going = np.concatenate([resource[1:], [NOWHERE]])
    is_opposite = ~is_last[one] & (going[one] == coming[other])
    if graph.groups:
        is_opposite = ~is_last[one] & _are_close(instance, constraint[first], going[one], coming[other])
    wait = np.maximum(instance.gap, is_opposite.astype(np.int64))
    before = np.concatenate([travels, np.where(is_last[one], one, one + 1)])
    after = np.concatenate([travels + 1, other])
    ticks = np.concatenate([duration[travels], np.where(is_last[one], duration[one] + wait, wait)])
    by_after = np.argsort(after, kind="stable")
    return Timetable(
        instance=instance,
        solution=solution,
        starts=starts,
        enter=enter,
        duration=duration,
        ranked=np.argsort(enter, kind="stable"),
        first=np.searchsorted(after[by_after], np.arange(enter.size + 1)),
        before=before[by_after],
        after=after[by_after],
        ticks=ticks[by_after],
    )


def _stays(instance: Instance, solution: Solution, resource: Longs, starts: Longs) -> tuple[Longs, Longs, Longs]:
    """The stays in resources, one a visit, and in groups: constraints, first visits and last ones."""
    visits = np.arange(resource.size)
    if not instance.graph.groups:
        return resource, visits, visits
    begins = dict(zip((plan.robot for plan in solution.plans), starts.tolist(), strict=False))
    by_constraint = stays_by_constraint(instance.graph, solution.plans)
    rows = [
        (constraint, begins[stay.node[0]] + stay.node[1], begins[stay.last[0]] + stay.last[1])
        for constraint in range(len(instance.graph.resources), len(instance.graph.constraints))
        for stay in by_constraint.get(constraint, ())
    ]
    more = np.array(rows, np.int64).reshape(-1, 3)
    return (
        np.concatenate([resource, more[:, 0]]),
        np.concatenate([visits, more[:, 1]]),
        np.concatenate([visits, more[:, 2]]),
    )


def _are_close(instance: Instance, constraint: Longs, going: Longs, coming: Longs) -> Flags:
    """Of pairs of stays in an area: whether the first leads to a resource close to that from which the second comes."""
    graph = instance.graph
    names = [*graph.index]
    triples = zip(constraint.tolist(), going.tolist(), coming.tolist(), strict=True)
    close = (
        NOWHERE not in (to, away) and graph.is_area(each) and graph.are_close(names[to], names[away])
        for each, to, away in triples
    )
    return np.fromiter(close, np.bool_, constraint.size)


def _pairs(gap: int, resource: Longs, enter: Longs, leave: Longs, capacity: Longs) -> tuple[Longs, Longs]:
    """The pairs of visits to one resource, the first before the second, with none between the two."""
    by_enter = np.lexsort((enter, resource))
    follows = (resource[by_enter[1:]] == resource[by_enter[:-1]]) & (capacity[resource[by_enter[1:]]] == 1)
    wide = np.flatnonzero(capacity[resource] > 1)
    wide = wide[np.argsort(resource[wide], kind="stable")]
    parts = np.split(wide, np.flatnonzero(np.diff(resource[wide])) + 1) if wide.size else []
    found = [pair for part in parts for pair in _wide_pairs(gap, part.tolist(), enter, leave)]
    more = np.array(found, np.int64).reshape(-1, 2)
    one = np.concatenate([by_enter[:-1][follows], more[:, 0]])
    other = np.concatenate([by_enter[1:][follows], more[:, 1]])
    return one, other


def _wide_pairs(gap: int, visits: Sequence[int], enter: Longs, leave: Longs) -> Iterator[tuple[int, int]]:
    """The same for the visits to one resource with room for several."""
    left = sorted((int(leave[visit]) + gap, visit) for visit in visits)
    ends = [end for end, _ in left]
    latest = list(accumulate((int(enter[visit]) for _, visit in left), max))
    for visit in visits:
        count = bisect_right(ends, int(enter[visit]))
        if count:
            yield from ((one, visit) for _, one in left[bisect_right(ends, latest[count - 1]) : count])
