"""The cheapest plans of a crowd: branching over the robots' first moves, with a bound by prices for each part.

Where robots stand on most resources, prices and formulas are far from the optimum: at first only rings of robots can
move, and the bound of prices lets each robot take a part of several moves. Once the place of a robot at a tick is
fixed, the bound rises. So the search splits into the places that a robot can be in at the first tick at which this is
open, again and again. A part is left once its bound (`carp_optimum.branching.bounds`) is above the total asked for.
Plans are found where the cheapest ways of all robots break no rule. Source: branch and bound over a Lagrangian
relaxation, with pseudo-costs. Nothing here is trusted: the law judges the plans.
"""

import itertools
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import is_stepwise
from carp_optimized.jit.kinds import Flags, Ints, Longs
from carp_optimized.jit.references import Native
from carp_optimized.state.arrays import NONE
from carp_optimized.state.encoding import encode_graph
from carp_optimum.branching.arrays import COUNTERS, ENDLESS, SCALE, WORK, Live, Nodes, Part, Rows
from carp_optimum.branching.bounds import bound_part
from carp_optimum.branching.choices import put, robot_of_choice, tick_of_choice
from carp_optimum.lagrangian.multipliers import moves_back, refuse_table
from carp_spec import Instance, Plan, Visit
from carp_verify.optimum.robot_clauses import predecessors
from carp_verify.routes import routes_of

FIRST_STEPS, STEPS = 1000, 75
"""The steps of the prices for all parts together, and for each part."""
FIRST_AIM, AIM = 4 * SCALE, 3 * SCALE // 2
PARTS_BETWEEN_RESULTS = 64
PARTS_TO_SHARE = 64
"""Two searches that take half of the parts each begin with the same splits, until there are this many parts."""
MOST_RISE = 8 * SCALE
"""A choice counts as if it raised the bound by no more, also where it leaves nothing to search."""
MOST_NODES = 1 << 21
ARCS_OF_PROPAGATION = 64
"""The rows and arcs that count as a propagation of a solver, so that the search beside this one seldom waits for it."""


def is_crowded(instance: Instance) -> bool:
    """Whether the search is for such instances: robots vanish, move from tick to tick, and stand on most resources."""
    robots, resources = len(instance.robots), len(instance.graph.resources)
    return instance.after_goal == "vanish" and is_stepwise(instance) and robots * 3 > resources * 2


class _Open(NamedTuple):
    """A part that is to be split: its bound, nodes and prices, and the tick whose choices split it."""

    bound: int
    alive: Ints
    price: Longs
    tick: int


class Branching:
    """The search for the cheapest plans of at most a total; after it, no plans cost less than `least`.

    With a `half`, 0 or 1, that is true of half of the parts: of all, where both halves are searched for the same total.
    Each robot needs a way. `look` is called before each part is bounded, and may end the search by an exception.
    Raises `Refusal` where the tables would be too large.
    """

    def __init__(self, instance: Instance, most: int, look: Callable[[], None], half: int | None = None) -> None:
        self.instance = instance
        self.half = half
        self.look = look
        self.plans: Sequence[Plan] | None = None
        self.least = most + 1
        self.work = 0
        self._goals = np.array([instance.graph.index[robot.goal] for robot in instance.robots], np.int32)
        self._make_part(_nodes_within(instance, most))

    def run(self) -> Iterator[int]:
        """Search, and give the work so far now and then, and where `plans` are better."""
        before = 0
        open_parts = self._bounded(FIRST_STEPS, FIRST_AIM)
        if open_parts:
            before, price = int(self._part.counters[WORK]), open_parts[0].price
            self._make_part(self._kept())
            self._part.rows.price[:] = price[: len(self._part.rows.price)]
            open_parts = self._bounded(STEPS, AIM)
        if self.half is not None:
            open_parts = self._shared(open_parts, self.half)
        for count in itertools.count():
            self.work = (before + int(self._part.counters[WORK])) // ARCS_OF_PROPAGATION
            if not open_parts:
                return
            part, plans = open_parts.pop(), self.plans
            if part.bound <= (self.least - 1) * SCALE:
                open_parts += sorted(self._split(part), key=lambda each: -each.bound)
            if self.plans is not plans or count % PARTS_BETWEEN_RESULTS == 0:
                yield self.work

    def _shared(self, parts: list[_Open], half: int) -> list[_Open]:
        """Half of the parts, after those of the lowest bound are split until there are enough of them."""
        while 0 < len(parts) < PARTS_TO_SHARE:
            parts.sort(key=lambda each: -each.bound)
            parts += self._split(parts.pop())
        parts.sort(key=lambda each: -each.bound)
        return parts[half::2]

    def least_of_all(self) -> int:
        """The bound before anything is split: no plans cost less than this, or than `least`."""
        self.look()
        bound = bound_part(self._native, self.least - 1, FIRST_STEPS, FIRST_AIM)
        return min(-(-bound // SCALE), self.least)

    def _make_part(self, kept: Flags) -> None:
        """Make the arrays for these nodes, by robot, tick and resource."""
        self._part = _part_of(self.instance, self._goals, kept)
        self._native = Native(self._part)

    def _kept(self) -> Flags:
        """The nodes that are alive, by robot, tick and resource, up to the last tick of any."""
        at = self._part.nodes.at
        alive = (at != NONE) & (self._part.alive[at] > 0)
        kept: Flags = alive.reshape(len(at), -1, len(self.instance.graph.resources))
        return kept[:, : int(np.flatnonzero(kept.any(axis=(0, 2)))[-1]) + 1]

    def _bounded(self, steps: int, aim: int) -> list[_Open]:
        """The part of the nodes that are alive, if it may have cheaper plans and something is open in it."""
        self.look()
        bound = bound_part(self._native, self.least - 1, steps, aim)
        if bound == ENDLESS:
            return []
        self._take_ways()
        tick = tick_of_choice(self._native)
        if tick == NONE:  # all robots have one way left: plans, or against a rule
            if bound_part(self._native, self.least - 1, 1, aim) < ENDLESS:
                self._take_ways()
            return []
        return [_Open(bound, self._part.alive.copy(), self._part.rows.price.copy(), tick)]

    def _split(self, part: _Open) -> Iterator[_Open]:
        """The parts that the choices of a robot at a tick make, bounded; choices that were never tried are tried."""
        nodes = self._part.nodes
        for untried in np.flatnonzero((nodes.tick == part.tick) & (nodes.tries == 0) & (part.alive > 0)):
            robot = int(np.searchsorted(nodes.of_robot, untried, "right")) - 1
            if len(self._choices(part, robot)) > 1 and not self._try(part, robot, int(untried)):
                part.alive[untried] = 0
        self._part.alive[:] = part.alive
        robot = robot_of_choice(self._native, part.tick)
        if robot == NONE:
            self._part.rows.price[:] = part.price
            yield from self._bounded(STEPS, AIM)
            return
        for node in self._choices(part, robot):
            yield from self._try(part, robot, node)

    def _choices(self, part: _Open, robot: int) -> Sequence[int]:
        """The nodes that the robot may have at the part's tick, and `NONE` if it may be gone."""
        at = self._part.nodes.at[robot].reshape(-1, len(self.instance.graph.resources))
        nodes = [int(node) for node in at[part.tick] if node != NONE and part.alive[node] > 0]
        if any(node != NONE and part.alive[node] > 0 for node in at[: part.tick, self._goals[robot]]):
            nodes.append(NONE)
        return nodes

    def _try(self, part: _Open, robot: int, node: int) -> list[_Open]:
        """The part that a choice makes, bounded; what the bound rises by is noted."""
        self._part.alive[:] = part.alive
        self._part.rows.price[:] = part.price
        bounded = self._bounded(STEPS, AIM) if put(self._native, robot, part.tick, node) else []
        if node != NONE:
            rise = min(bounded[0].bound - part.bound, MOST_RISE) if bounded else MOST_RISE
            self._part.nodes.gain[node] += max(rise, 0)
            self._part.nodes.tries[node] += 1
        return bounded

    def _take_ways(self) -> None:
        """Take the cheapest ways if they are plans that cost less than all before."""
        if not (self._part.rows.used <= 1).all():
            return
        ways = [self._way(robot) for robot in range(len(self._goals))]
        cost = sum(len(way) - 1 for way in ways)
        if cost < self.least:
            self.least = cost
            self.plans = [self._plan(robot, way) for robot, way in enumerate(ways)]

    def _way(self, robot: int) -> Sequence[int]:
        """The resources of the robot's cheapest way, tick by tick."""
        live = self._part.live
        each = int(live.of_robot[robot])
        way = [int(self._part.nodes.place[live.node[each]])]
        while way[-1] != self._goals[robot]:
            each = int(live.to[live.choice[each]])
            way.append(int(self._part.nodes.place[live.node[each]]))
        return way

    def _plan(self, robot: int, way: Sequence[int]) -> Plan:
        """The plan of a robot that follows this way."""
        resources = self.instance.graph.resources
        enters = [tick for tick, here in enumerate(way) if tick == 0 or way[tick - 1] != here]
        stays = zip(enters, [*enters[1:], len(way)], strict=True)
        visits = [Visit(resources[way[enter]].id, enter, leave) for enter, leave in stays]
        return Plan(self.instance.robots[robot].id, tuple(visits))


def _nodes_within(instance: Instance, most: int) -> Flags:
    """The nodes of each robot if the others have no delay and all cost at most this, by robot, tick and resource."""
    before = predecessors(instance)
    index = instance.graph.index
    rests = [{**routes_of(instance, robot, before).rests(), robot.goal: -1} for robot in instance.robots]
    ticks = [rest[robot.start] + 1 for robot, rest in zip(instance.robots, rests, strict=True)]
    spare = most - sum(ticks)
    last = max(max(ticks) + spare, 0)
    refuse_table("$.robots", "robots times ticks times resources", len(ticks) * (last + 1) * len(index), MOST_NODES)
    kept = np.zeros((len(ticks), last + 1, len(index)), np.bool_)
    for robot, rest in enumerate(rests):
        for resource, further in rest.items():
            kept[robot, 1 : max(ticks[robot] + spare - further, 1), index[resource]] = True
        kept[robot, 0, index[instance.robots[robot].start]] = True
    return kept


def _part_of(instance: Instance, goals: Ints, kept: Flags) -> Part:
    """The arrays for these nodes, all alive."""
    robots, ticks, resources = kept.shape
    graph = encode_graph(instance)
    moves = graph.target.size
    robot, tick, place = np.nonzero(kept)
    at = np.full(kept.shape, NONE, np.int32)
    at[kept] = np.arange(robot.size)
    branches = int(np.diff(graph.first).max(initial=0))
    leads = np.full((robot.size, branches + 1), NONE, np.int32)
    goes_on = np.flatnonzero((place != goals[robot]) & (tick + 1 < ticks))
    leads[goes_on, 0] = at[robot[goes_on], tick[goes_on] + 1, place[goes_on]]
    for way in range(branches):
        move = graph.first[place[goes_on]] + way
        moving = goes_on[move < graph.first[place[goes_on] + 1]]
        target = graph.target[graph.first[place[moving]] + way]
        leads[moving, way + 1] = at[robot[moving], tick[moving] + 1, target]
    width, size, arcs = resources + moves, robot.size, robot.size * (branches + 1)
    nodes = Nodes(
        first=graph.first,
        target=graph.target,
        back=moves_back(instance),
        goal=goals,
        of_robot=np.searchsorted(robot, np.arange(robots + 1)).astype(np.int32),
        place=place.astype(np.int32),
        tick=tick.astype(np.int32),
        at=at.reshape(robots, -1),
        leads=leads,
        gain=np.zeros(size, np.int64),
        tries=np.zeros(size, np.int64),
    )
    price, best, paid, course = np.zeros((4, ticks * width), np.int64)
    rows = Rows(price, best, paid, np.zeros(ticks * width, np.int32), course)
    number, node, choice, often = np.zeros((4, size), np.int32)
    to, row = np.zeros((2, arcs), np.int32)
    least, reached = np.zeros((2, size), np.int64)
    of_robot, arc = np.zeros(robots + 1, np.int32), np.zeros(size + 1, np.int32)
    live = Live(number, node, of_robot, arc, to, row, least, reached, choice, often)
    return Part(nodes, rows, live, np.ones(size, np.int32), np.zeros(COUNTERS, np.int64))
