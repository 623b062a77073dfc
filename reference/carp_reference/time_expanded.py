"""The naive twin of the CARP query: A* tick by tick on a table of occupied ticks (the paper's [spatioTempA*]).

It shares no code with the query over windows, which is tested against it: both find a plan that arrives at the same
tick, or both find none. Where several plans arrive as early, the two may differ.
"""

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise

from carp_spec import Instance, Plan, Refusal, ResourceId, RobotId, Visit, has_ended
from carp_spec.planners import LARGEST_TABLE, ticks_are_held


@dataclass(frozen=True, slots=True)
class Table:
    """The committed plans tick by tick; nothing changes from the tick `still` on."""

    instance: Instance
    occupied: Counter[tuple[ResourceId, int]]
    moves: frozenset[tuple[ResourceId, ResourceId, int]]
    still: int

    def is_free(self, resource: ResourceId, tick: int) -> bool:
        """Whether one more robot may occupy the resource at the tick."""
        return self.occupied[resource, min(tick, self.still)] < self.instance.graph.resource[resource].capacity

    def is_free_during(self, resource: ResourceId, enter: int, leave: int | None) -> bool:
        """Whether one more robot may occupy the resource in [enter, leave), and a tick longer without following."""
        last = max(enter, self.still) + 1 if leave is None else leave + self.instance.gap
        return all(self.is_free(resource, tick) for tick in range(enter, last))

    def allows(self, visits: Sequence[Visit]) -> bool:
        """Whether one more robot could make these visits."""
        stays = all(self.is_free_during(visit.resource, visit.enter, visit.leave) for visit in visits)
        return stays and not any((to.resource, at.resource, to.enter) in self.moves for at, to in pairwise(visits))


@dataclass(frozen=True, slots=True)
class Moment:
    """The robot is in the resource at the tick, and must stay `rest` ticks more; `arrived`: its plan ends here."""

    resource: ResourceId
    tick: int
    rest: int
    arrived: bool
    before: "Moment | None"


def table_of(instance: Instance, committed: Sequence[Plan]) -> Table:
    """Write the committed plans into a table; raises `Refusal` by `limit/ticks`."""
    ticks = [tick for plan in committed for visit in plan.visits for tick in (visit.enter, visit.leave or 0)]
    still = max(ticks, default=0) + instance.gap
    size = sum((still + 1 if v.leave is None else v.leave) - v.enter for plan in committed for v in plan.visits)
    _refuse_too_many("the committed plans occupy", size)
    occupied: Counter[tuple[ResourceId, int]] = Counter()
    for plan in committed:
        for visit in plan.visits:
            leave = still + 1 if visit.leave is None else visit.leave + instance.gap
            occupied.update((visit.resource, tick) for tick in range(visit.enter, leave))
    moves = frozenset(
        (visit.resource, following.resource, following.enter)
        for plan in committed
        for visit, following in pairwise(plan.visits)
    )
    return Table(instance, occupied, moves, still)


def _refuse_too_many(what: str, ticks: int) -> None:
    if not ticks_are_held(ticks, LARGEST_TABLE):
        message = f"{what} {ticks} ticks, and the time-expanded planner holds {LARGEST_TABLE}"
        raise Refusal("limit", "$", ticks_are_held.id, message)


def find_plan_by_ticks(
    instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0, before: Plan | None = None
) -> Plan | None:
    """A plan with the earliest arrival, as `carp_reference.query` finds it, or `None`.

    Raises `Refusal` by `limit/ticks`.
    """
    table = table_of(instance, committed)
    if before is not None and has_ended(before, now):
        return before if table.allows(before.visits) else None
    request = instance.robot[robot]
    entered = [] if before is None else [visit for visit in before.visits if visit.enter <= now]
    *past, current = entered or [Visit(request.start, request.release, None)]
    still = max(table.still, now, current.enter)
    longest_way = sum(instance.duration(robot, resource.id) for resource in instance.graph.resources)
    _refuse_too_many(f"robot {robot} may be under way for", still - current.enter + longest_way)
    duration = instance.duration(robot, current.resource)
    ready = max(current.enter + duration, now)
    if not table.allows([*past, Visit(current.resource, current.enter, ready)]):
        return None
    ends = ready == current.enter + duration and _may_end(table, robot, current.resource, current.enter)
    if instance.after_goal == "park":
        ends = _may_end(table, robot, current.resource, current.enter)
    start = Moment(current.resource, current.enter, ready - current.enter - 1, ends, None)
    last = _search(table, robot, start)
    return None if last is None else Plan(robot, (*past, *_visits(instance, robot, last)))


def _may_end(table: Table, robot: RobotId, resource: ResourceId, enter: int) -> bool:
    """Whether a robot that enters the resource at the tick may end its plan there."""
    if resource != table.instance.robot[robot].goal:
        return False
    parks = table.instance.after_goal == "park"
    leave = None if parks else enter + table.instance.duration(robot, resource)
    return table.is_free_during(resource, enter, leave)


def _search(table: Table, robot: RobotId, start: Moment) -> Moment | None:
    hops = _hops_to_goal(table.instance, robot)
    queue: list[tuple[int, int, Moment]] = []
    seen: set[tuple[ResourceId, int, int]] = set()
    pushes = 0

    def push(moment: Moment) -> None:
        nonlocal pushes
        if moment.resource in hops:
            pushes += 1
            heappush(queue, (moment.tick + (0 if moment.arrived else hops[moment.resource]), pushes, moment))

    push(start)
    while queue:
        _, _, moment = heappop(queue)
        state = (moment.resource, min(moment.tick, table.still), moment.rest)
        if moment.arrived:
            return moment
        if state not in seen:
            seen.add(state)
            for following in _next_moments(table, robot, moment):
                push(following)
    return None


def _next_moments(table: Table, robot: RobotId, moment: Moment) -> Iterator[Moment]:
    tick = moment.tick + 1
    if table.is_free(moment.resource, tick):
        yield Moment(moment.resource, tick, max(moment.rest - 1, 0), False, moment)
    if moment.rest == 0 and (table.instance.following == "allowed" or table.is_free(moment.resource, tick)):
        for target in table.instance.graph.successors[moment.resource]:
            if table.is_free(target, tick) and (target, moment.resource, tick) not in table.moves:
                rest = table.instance.duration(robot, target) - 1
                yield Moment(target, tick, rest, _may_end(table, robot, target, tick), moment)


def _hops_to_goal(instance: Instance, robot: RobotId) -> dict[ResourceId, int]:
    """The least number of moves from each resource to the goal: no plan needs fewer ticks."""
    predecessors: dict[ResourceId, list[ResourceId]] = defaultdict(list)
    for source, targets in instance.graph.successors.items():
        for target in targets:
            predecessors[target].append(source)
    goal = instance.robot[robot].goal
    hops = {goal: 0}
    reached = [goal]
    for resource in reached:
        for predecessor in predecessors[resource]:
            if predecessor not in hops:
                hops[predecessor] = hops[resource] + 1
                reached.append(predecessor)
    return hops


def _visits(instance: Instance, robot: RobotId, last: Moment) -> tuple[Visit, ...]:
    """Join the moments in one resource into visits."""
    moments = [last]
    while moments[-1].before is not None:
        moments.append(moments[-1].before)
    moments.reverse()
    entries = [moments[0], *(later for earlier, later in pairwise(moments) if earlier.resource != later.resource)]
    leave = None if instance.after_goal == "park" else last.tick + instance.duration(robot, last.resource)
    ticks = [*(moment.tick for moment in entries), leave]
    stays = zip(entries, ticks, ticks[1:], strict=False)
    return tuple(Visit(moment.resource, enter, leave) for moment, enter, leave in stays if enter is not None)


def time_expanded(instance: Instance) -> tuple[Plan, ...]:
    """Plan the robots in the order given."""
    plans: list[Plan] = []
    for robot in instance.robots:
        plan = find_plan_by_ticks(instance, plans, robot.id)
        if plan is not None:
            plans.append(plan)
    return tuple(plans)
