"""The naive twin of the CARP query: A* tick by tick on a table of occupied ticks (the paper's [spatioTempA*]).

It shares no code with the query over windows, which is tested against it: both find the same tick of arrival.
"""

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import count, groupby, pairwise

from carp_spec import Group, Instance, Move, Plan, Refusal, ResourceId, RobotId, Visit
from carp_spec.planners import LARGEST_TABLE, ticks_are_held


@dataclass(frozen=True, slots=True)
class Table:
    """The committed plans tick by tick, by constraint; nothing changes from the tick `still` on."""

    instance: Instance
    constraints: Sequence[Group]
    occupied: Counter[tuple[int, int]]
    moves: Mapping[int, Sequence[Move]]
    still: int

    def is_free(self, resource: ResourceId, tick: int) -> bool:
        """Whether one more robot may occupy the resource at the tick."""
        return all(
            self.occupied[each, min(tick, self.still)] < self.constraints[each].capacity
            for each in self.instance.graph.constraints_of(resource)
        )

    def is_free_during(self, resource: ResourceId, enter: int, leave: int | None) -> bool:
        """Whether one more robot may occupy the resource in [enter, leave), and a tick longer without following."""
        last = max(enter, self.still) + 1 if leave is None else leave + self.instance.gap
        return all(self.is_free(resource, tick) for tick in range(enter, last))

    def is_exchange(self, tick: int, source: ResourceId, target: ResourceId) -> bool:
        """Whether a committed robot moves at the tick from next to the target to next to the source."""
        back = self.moves.get(tick, ())
        return any(self._are_close(target, away) and self._are_close(source, to) for away, to in back)

    def _are_close(self, one: ResourceId, other: ResourceId) -> bool:
        groups = self.instance.graph.groups
        return one == other or any(each.capacity == 1 and {one, other} <= {*each.resources} for each in groups)

    def may_end(self, robot: RobotId, resource: ResourceId, enter: int) -> bool:
        """Whether a robot that enters the resource at the tick may end there."""
        parks = self.instance.after_goal == "park"
        stop = self.instance.robot[robot].stops[-1]
        leave = None if parks else enter + self.instance.stay(robot, stop)
        return resource == stop.resource and self.is_free_during(resource, enter, leave)


@dataclass(frozen=True, slots=True)
class Moment:
    """The robot is in the resource at the tick, and must stay `rest` ticks more; `arrived`: its plan ends here.

    It has `served` so many stops, with the one that it serves in these ticks.
    """

    resource: ResourceId
    tick: int
    rest: int
    served: int
    arrived: bool
    before: "Moment | None"


def table_of(instance: Instance, committed: Sequence[Plan]) -> Table:
    """Write the committed plans into a table; raises `Refusal` by `limit/ticks`."""
    visits = [visit for plan in committed for visit in plan.visits]
    still = max((tick for visit in visits for tick in (visit.enter, visit.leave or 0)), default=0) + instance.gap
    size = sum((still + 1 if visit.leave is None else visit.leave) - visit.enter for visit in visits)
    _refuse_too_many("the committed plans occupy", size)
    occupied: Counter[tuple[int, int]] = Counter()
    moves: dict[int, list[Move]] = defaultdict(list)
    for plan in committed:
        occupied.update(
            {
                (constraint, tick)
                for visit in plan.visits
                for tick in range(visit.enter, still + 1 if visit.leave is None else visit.leave + instance.gap)
                for constraint in instance.graph.constraints_of(visit.resource)
            }
        )
        for at, to in pairwise(plan.visits):
            moves[to.enter].append((at.resource, to.resource))
    return Table(instance, instance.graph.constraints, occupied, moves, still)


def _refuse_too_many(what: str, ticks: int) -> None:
    if not ticks_are_held(ticks, LARGEST_TABLE):
        message = f"{what} {ticks} ticks, and the time-expanded planner holds {LARGEST_TABLE}"
        raise Refusal("limit", "$", ticks_are_held.id, message)


def find_plan_by_ticks(instance: Instance, committed: Sequence[Plan], robot: RobotId) -> Plan | None:
    """A plan with the earliest arrival, or `None`; raises `Refusal` by `limit/ticks`."""
    table = table_of(instance, committed)
    at, release = instance.robot[robot].start, instance.robot[robot].release
    stops = instance.robot[robot].stops
    longest_way = len(stops) * sum(instance.duration(robot, resource) for resource in instance.graph.index)
    longest_way += sum(stop.service for stop in stops)
    _refuse_too_many(f"robot {robot} may be under way for", max(table.still - release, 0) + longest_way)
    if not table.is_free(at, release):
        return None
    last = search(table, robot, [*entries(table, robot, at, release, 0, None)])
    return None if last is None else Plan(robot, visits_of(instance, robot, last))


def entries(
    table: Table, robot: RobotId, resource: ResourceId, tick: int, served: int, before: Moment | None
) -> Iterator[Moment]:
    """The moments in which a robot enters the resource: it passes or ends there, or it serves its next stop."""
    *stops, _ = table.instance.robot[robot].stops
    rest = table.instance.duration(robot, resource) - 1
    ends = served == len(stops) and table.may_end(robot, resource, tick)
    yield Moment(resource, tick, rest, served, ends, before)
    if served < len(stops) and stops[served].resource == resource:
        yield Moment(resource, tick, table.instance.stay(robot, stops[served]) - 1, served + 1, False, before)


def search(table: Table, robot: RobotId, starts: Sequence[Moment]) -> Moment | None:
    """The first moment at which the plan can end, or `None`."""
    hops = _hops_to_goal(table.instance, robot)
    pushes = count()
    queue = [(start.tick, next(pushes), start) for start in starts]
    seen: set[tuple[ResourceId, int, int, int]] = set()
    while queue:
        _, _, moment = heappop(queue)
        if moment.arrived:
            return moment
        state = (moment.resource, min(moment.tick, table.still), moment.rest, moment.served)
        if state not in seen:
            seen.add(state)
            for following in _next_moments(table, robot, moment):
                if following.resource in hops:
                    f = following.tick + (0 if following.arrived else hops[following.resource])
                    heappush(queue, (f, next(pushes), following))
    return None


def _next_moments(table: Table, robot: RobotId, moment: Moment) -> Iterator[Moment]:
    tick = moment.tick + 1
    if table.is_free(moment.resource, tick):
        yield Moment(moment.resource, tick, max(moment.rest - 1, 0), moment.served, False, moment)
    if moment.rest == 0 and (table.instance.following == "allowed" or table.is_free(moment.resource, tick)):
        for target in table.instance.graph.successors[moment.resource]:
            if table.is_free(target, tick) and not table.is_exchange(tick, moment.resource, target):
                yield from entries(table, robot, target, tick, moment.served, moment)


def _hops_to_goal(instance: Instance, robot: RobotId) -> Mapping[ResourceId, int]:
    """The least number of moves, and so of ticks, from each resource to the goal."""
    import networkx as nx  # noqa: PLC0415 - loaded only where used

    backward = nx.DiGraph((target, source) for source, target in instance.graph.moves)
    goal = instance.robot[robot].goal
    backward.add_node(goal)
    hops: Mapping[ResourceId, int] = nx.single_source_shortest_path_length(backward, goal)
    return hops


def visits_of(instance: Instance, robot: RobotId, last: Moment) -> tuple[Visit, ...]:
    """Join the moments in one resource into visits."""
    moments = [last]
    while moments[-1].before is not None:
        moments.append(moments[-1].before)
    entries = [next(stay) for _, stay in groupby(reversed(moments), key=lambda moment: moment.resource)]
    visits = [Visit(at.resource, at.tick, to.tick) for at, to in pairwise(entries)]
    stay = instance.stay(robot, instance.robot[robot].stops[-1])
    leave = None if instance.after_goal == "park" else last.tick + stay
    return (*visits, Visit(last.resource, entries[-1].tick, leave))


def time_expanded(instance: Instance) -> tuple[Plan, ...]:
    """Plan the robots in the order given."""
    plans: list[Plan] = []
    for robot in instance.robots:
        plan = find_plan_by_ticks(instance, plans, robot.id)
        if plan is not None:
            plans.append(plan)
    return tuple(plans)
