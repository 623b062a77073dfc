"""The clauses of one robot: its ways from start to goal, written as a graph of (resource, tick) pairs.

A node (r, t) is a variable: the robot is in r and free to leave it at t, so it has been there for at least its
duration. From there it waits, to (r, t + 1), or moves to a neighbour s, to (s, t + d(s)). So a long stay needs no more
nodes than a short one, and in (t - d(r), t] the robot is in r.

The robot's delay is its cost minus its shortest-path cost, written as a unary number. Each node has a least delay,
that of the best way through it, and is there only if this delay is at most the robot's `horizon`. A robot that
is later than its horizon is not described at all: where a way leaves the nodes that exist, the clause ends in
`delay > horizon`. So every plan of the robot is a model of the clauses, whatever the horizon (the clauses are a
relaxation), and every model with a delay within the horizon holds a plan of at most that delay.

A robot that is *seen* at a tick is described up to that tick alone, to the first node that it leaves later. Its delay
is the least delay of that node then, unless it has arrived by the tick.
"""

from bisect import bisect_right, insort
from collections import defaultdict
from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from itertools import count
from operator import itemgetter
from typing import TypeAlias

from carp_spec import Instance, Plan, ResourceId, Robot, Visit
from carp_verify.optimum.clauses import Clause, Formula, Literal
from carp_verify.routes import Place, routes_of

Node: TypeAlias = tuple[Place, int]


def predecessors(instance: Instance) -> Mapping[ResourceId, Sequence[ResourceId]]:
    """The resources from which one move leads to a resource, in the instance's order."""
    before: dict[ResourceId, list[ResourceId]] = {resource.id: [] for resource in instance.graph.resources}
    for resource in instance.graph.resources:
        for target in instance.graph.successors[resource.id]:
            before[target].append(resource.id)
    return before


class RobotClauses:
    """The clauses of one robot, added to a formula and growing with the robot's horizon.

    `shortest` is the robot's cost on the empty graph, or `None` if no way leads from its start to its goal; then
    it has no clauses. With `vanish` a robot that enters its goal has arrived: going on could only cost more. One that
    is seen, at tick `seen`, may go on, and so may one whose last visit is longer than another one there.
    """

    def __init__(
        self,
        instance: Instance,
        robot: Robot,
        before: Mapping[ResourceId, Sequence[ResourceId]],
        formula: Formula,
        seen: int | None = None,
    ) -> None:
        self.robot = robot
        self.seen = seen
        self.horizon = -1
        self.node: dict[Node, Literal] = {}
        self.late: list[Literal] = []
        """The k-th literal, from 1, says that the delay is at least k; there are horizon + 1."""
        self._formula = formula
        self._parks = instance.after_goal == "park"
        self.routes = routes_of(instance, robot, before)
        self._drives_on = self._parks or seen is not None or self.routes.must_pass
        self._rest = self.routes.rests()
        self._last = frozenset(self.routes.last)
        self._ticks: dict[Place, list[int]] = defaultdict(list)
        self._open: list[Node] = []
        self._kept: Container[Node] | None = None
        duration = self.routes.duration
        starts = [place for place in self.routes.starts if place in self._rest]
        self._starts: list[Node] = [(place, robot.release + duration[place]) for place in starts]
        self._has_begun = False
        self.shortest = self.routes.shortest(self._rest)
        self.earliest = robot.release + (self.shortest or 0)
        """The tick at which the robot enters its goal if nothing delays it."""

    @property
    def _stands_still(self) -> bool:
        return self.routes.is_there and not self._drives_on

    def least_delay(self, node: Node) -> int:
        """The least delay of a plan through the node."""
        place, tick = node
        return tick + self._rest[place] - self.earliest

    def later_than(self, delay: int) -> Literal:
        """The literal of a delay of more than `delay`, or of more than the horizon if that is less."""
        return self.late[min(delay, self.horizon)]

    def leads_to(self, node: Node) -> list[Node]:
        """Where the robot can be free to leave next."""
        place, tick = node
        if self._is_after(tick):
            return []
        moves = [
            (target, tick + self.routes.duration[target])
            for target in self.routes.successors[place]
            if target in self._rest and (self._drives_on or target != self.routes.there)
        ]
        following = [(place, tick + 1), *moves]
        return following if self._kept is None else [each for each in following if each in self._kept]

    def keep_only(self, nodes: Container[Node]) -> None:
        """Describe no plans through other nodes; before the first growth."""
        self._kept = nodes

    def nodes_within(self, horizon: int) -> int:
        """How many nodes the robot has at a horizon."""
        if self._stands_still:
            return 1
        first: dict[Place, int] = {}
        number = count()
        queue = [(tick, next(number), place) for place, tick in sorted(self._starts, key=itemgetter(1))]
        while queue:
            tick, _, place = heappop(queue)
            if place not in first:
                first[place] = tick
                for following, later in self.leads_to((place, tick))[1:]:
                    heappush(queue, (later, next(number), following))
        return sum(max(0, horizon + 1 - self.least_delay(node)) for node in first.items())

    def grow(self) -> None:
        """Raise the horizon by one tick of delay and add the clauses of all nodes that this brings."""
        self.horizon += 1
        self.late.append(self._formula.variable())
        if self.horizon > 0:
            self._formula.add(-self.late[-1], self.late[-2])
        if self._stands_still:
            self._stand_still()
            return
        added = self._add_nodes()
        for node in added:
            self._arrive_late(node)
            self._come_from(node)
        reached = [*self._open, *added]
        self._open = [node for node in reached if not self._go_on(node)]
        self._arrive_at_horizon()

    def _stand_still(self) -> None:
        if self.horizon == 0:
            place = self.routes.there
            start = (place, self.robot.release + self.routes.duration[place])
            self._add_node(start, [])
            self._formula.add(self.node[start])
            self._formula.add(-self.late[0])

    def _add_nodes(self) -> list[Node]:
        """Add the nodes whose least delay is the horizon."""
        added: list[Node] = []
        for start in self._starts:
            if self.least_delay(start) == self.horizon:
                self._add_node(start, added)
        self._begin()
        for node in self._open:
            self._add_following(node, added)
        for node in added:  # grows while it is read
            self._add_following(node, added)
        return added

    def _begin(self) -> None:
        """The robot begins at one of its starts, or has arrived at once, or is too late."""
        begun = [self.node[start] for start in self._starts if start in self.node]
        if begun and not self._has_begun:
            self._has_begun = len(begun) == len(self._starts)
            at_goal = [-self.late[0]] if self.routes.is_there else []
            late = [] if self._has_begun else [self.late[self.horizon]]
            self._formula.add(*at_goal, *begun, *late)

    def _add_following(self, node: Node, added: list[Node]) -> None:
        for following in self.leads_to(node):
            if self.least_delay(following) <= self.horizon:
                self._add_node(following, added)

    def _add_node(self, node: Node, added: list[Node]) -> None:
        if node not in self.node:
            self.node[node] = self._formula.variable()
            insort(self._ticks[node[0]], node[1])
            added.append(node)

    def _arrive_late(self, node: Node) -> None:
        """A robot that passes the node has at least its delay; a robot that has arrived does not pass it."""
        delay = self.least_delay(node)
        if delay > 0:
            self._formula.add(-self.node[node], self.late[delay - 1])

    def _is_after(self, tick: int) -> bool:
        """Whether the robot is not described at the tick, as it was seen before."""
        return self.seen is not None and tick > self.seen

    def _go_on(self, node: Node) -> bool:
        """From the node the robot waits, moves, arrives, or is too late; returns whether all nodes exist."""
        place, tick = node
        if self._is_after(tick):
            return True
        following = self.leads_to(node)
        ways = [self.node[each] for each in following if each in self.node]
        complete = len(ways) == len(following)
        if place in self._last:
            ways.append(-self.later_than(tick - self.earliest))
        if not complete:
            ways.append(self.late[self.horizon])
        self._formula.add(-self.node[node], *ways)
        return complete

    def _come_from(self, node: Node) -> None:
        """To the node the robot waited or moved, unless its plan begins there."""
        place, tick = node
        if node not in self._starts:
            entered = tick - self.routes.duration[place]
            sources = [(place, tick - 1), *((source, entered) for source in self.routes.predecessors[place])]
            self._formula.add(-self.node[node], *(self.node[each] for each in sources if each in self.node))

    def _arrive_at_horizon(self) -> None:
        """A robot that arrives with a delay of exactly the horizon comes from a node before the goal."""
        tick = self.earliest + self.horizon
        if self._is_after(tick) or (self.routes.is_there and self.horizon == 0):
            return
        earlier = [-self.late[self.horizon - 1]] if self.horizon > 0 else []
        sources = [(source, tick) for source in self.routes.last]
        self._formula.add(
            *earlier, self.late[self.horizon], *(self.node[each] for each in sources if each in self.node)
        )

    def may_visit(self, resource: ResourceId) -> bool:
        """Whether the robot may be in the resource at all, within its horizon."""
        return resource == self.robot.goal or any(place in self._ticks for place in self.routes.at(resource))

    def stays(self, resource: ResourceId, tick: int) -> Iterator[Clause]:
        """The alternatives that put the robot into the resource at the tick: each is literals that hold together."""
        if self._is_after(tick):
            return
        yield from ((node,) for node in self.nodes_of(resource, tick))
        delay = tick - self.earliest
        if resource == self.robot.goal and delay >= 0 and not self._stands_still:
            left = delay - self.routes.stay
            if self._parks or left < 0:
                yield (-self.later_than(delay),)
            elif left < self.horizon:
                yield (-self.later_than(delay), self.late[left])

    def nodes_of(self, resource: ResourceId, tick: int) -> Iterator[Literal]:
        """The nodes of a stay in the resource at the tick that is not the last one."""
        for place in self.routes.at(resource):
            ticks = self._ticks.get(place, [])
            until = range(bisect_right(ticks, tick), bisect_right(ticks, tick + self.routes.duration[place]))
            yield from (self.node[place, ticks[each]] for each in until)

    def leaving(self, resource: ResourceId, tick: int) -> Clause:
        """The literals of the nodes at which the robot may leave the resource at the tick."""
        nodes = [(place, tick) for place in self.routes.at(resource)]
        return tuple(self.node[node] for node in nodes if node in self.node)

    def leaves(self) -> list[tuple[ResourceId, int]]:
        """The resources and ticks at which the robot may leave, in the order of its nodes."""
        return list(dict.fromkeys((self.routes.resource(place), tick) for place, tick in self.node))

    def largest_delay(self, seen: int, places: Collection[ResourceId], arrival: int) -> int:
        """The largest delay of a robot that arrives by a tick, or is in one of the places at another."""
        at = [place for resource in places for place in self.routes.at(resource) if place in self._rest]
        last = [(place, seen + self.routes.duration[place]) for place in at]
        return max([0, arrival - self.earliest, *map(self.least_delay, last)])

    def demand(self, seen: int, places: Collection[ResourceId], arrival: int) -> None:
        """Demand that the robot is in one of the places at a tick, or arrives by one that is not after it.

        Its clauses would let it be in two places. So if it is seen again later, it is in no other place.
        """
        nodes = [node for place in places for node in self.nodes_of(place, seen)]
        arrived = [-self.later_than(arrival - self.earliest)] if arrival >= self.earliest else []
        self._formula.add(*nodes, *arrived)
        if seen < (self.seen or 0):
            for (place, leave), node in self.node.items():
                if self.routes.resource(place) not in places and seen < leave <= seen + self.routes.duration[place]:
                    self._formula.add(-node)

    def entries(self) -> list[tuple[ResourceId, int]]:
        """The resources and ticks at which the robot may enter, in the order of its nodes."""
        entries = [(self.routes.resource(place), tick - self.routes.duration[place]) for place, tick in self.node]
        if not self._stands_still:
            entries += [(self.robot.goal, self.earliest + delay) for delay in range(self.horizon + 1)]
        return list(dict.fromkeys(entries))

    def plan(self, model: Sequence[bool]) -> Plan | None:
        """The plan in a model, given by the truth of each variable; `None` if the robot is later than its horizon."""
        late = sum(model[literal] for literal in self.late)
        if late > self.horizon:
            return None
        visits = []
        enter = self.robot.release
        arrival = self.earliest + late
        if self.routes.is_there and late == 0:
            arrival = self.robot.release
        else:
            node = self._first(self._starts, model)
            while not (node[1] == arrival and node[0] in self._last):
                following = self._first(self.leads_to(node), model)
                if following[0] != node[0]:
                    visits.append(Visit(self.routes.resource(node[0]), enter, node[1]))
                    enter = node[1]
                node = following
            visits.append(Visit(self.routes.resource(node[0]), enter, arrival))
        leave = None if self._parks else arrival + self.routes.stay
        return Plan(self.robot.id, (*visits, Visit(self.robot.goal, arrival, leave)))

    def _first(self, nodes: Sequence[Node], model: Sequence[bool]) -> Node:
        """The first of these nodes that is true."""
        return next(node for node in nodes if node in self.node and model[self.node[node]])
