"""Plans of all robots together, step by step, where each move takes one tick: LaCAM (Okumura 2023).

A configuration is the place of every robot at a tick. The search is depth-first over configurations, each with ever
longer demands on its successor, which fix the place of one more robot at a time. Successors come from
`carp_optimized.lacam.pibt`; of several tries the one whose ways left have the least sum is taken (Okumura 2024). So
crowds are planned for which no order of robots works. Totals are far from the least; `carp_optimized.crowds.rounds`
lowers them. Nothing here is trusted: the law judges the plans.
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import GONE, Crowd, can_begin, crowd_of, is_stepwise, ways_of
from carp_optimized.crowds.distances import measure
from carp_optimized.crowds.improving import LONGER
from carp_optimized.crowds.stays import Paths, no_paths, solution_along
from carp_optimized.draws import FIRST_MIX, GOLDEN, SECOND_MIX
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, IntTable, Longs, Numbers
from carp_optimized.jit.references import Native, dereference
from carp_optimized.lacam.guides import Guides
from carp_optimized.lacam.pibt import NOWHERE, Step, begin, choose, end, is_open, no_step, rank_choices, take
from carp_optimized.state.arrays import NONE
from carp_spec import Instance, Plan

STEPS = 10_000
"""The search ends after this number of successors; most searches that succeed need a few hundred."""
FOUND, FAILED, FULL, RUNNING = range(4)
NODES, DEMANDS, DEPTH, TRIED = range(4)  # the counts
ENDLESS = 1 << 40
"""More than any sum of distances."""
ROOM = 256
"""The configurations, beyond the steps of the longest way, for which there is room at first."""
DEMANDED = 8
"""The demands of a configuration for which there is room at first, however many places it leads to."""
MOST = 1 << 25
"""Places in all configurations, or demands, beyond which there is no more room; twice as many take up to a gigabyte."""


class Nodes(NamedTuple):
    """The configurations reached: their places, the robots that are to move by priority, and the one before.

    `chain` leads on to the next configuration with the same `bucket`. From `head[node]` on, `later` leads through the
    demands still to be tried: a demand is that its robot goes to `place`, beside what the demand `above` demands. The
    robot is that at the place `level - 1` of the node's order.
    """

    places: IntTable
    order: IntTable
    present: Ints
    parent: Ints
    hash: Numbers
    chain: Ints
    bucket: Ints
    head: Ints
    tail: Ints
    place: Ints
    above: Ints
    level: Ints
    later: Ints
    stack: Ints
    counts: Longs


class Lacam(NamedTuple):
    """The whole search. `chosen` are the best next places of `samples` tries."""

    crowd: Crowd
    step: Step
    nodes: Nodes
    least: Ints
    chosen: Ints
    samples: int


lacam_at = dereference(Lacam)


def plans_by_steps(instance: Instance, steps: int = STEPS) -> tuple[Plan, ...] | None:
    """Plans of all robots; `None` if the search finds none in that many steps, or the instance is not `is_stepwise`."""
    if not is_stepwise(instance):
        return None
    crowd = crowd_of(instance)
    measure(Native(crowd), np.arange(crowd.start.size, dtype=np.int32), 0, crowd.start.size)
    if not can_begin(crowd):
        return None
    search = Search(crowd)
    search.go(steps)
    return None if search.paths is None else solution_along(instance, instance.robots, search.paths).plans


class Search:
    """A search that goes on as long as it is asked to."""

    __slots__ = ("_native", "outcome", "paths")

    def __init__(self, crowd: Crowd, seed: int = 0, guides: Guides | None = None, samples: int = 1) -> None:
        """The crowd has been measured, and `can_begin`. The best of so many next configurations is taken."""
        self.outcome = RUNNING
        self.paths: Paths | None = None
        least = ways_of(crowd)
        step, nodes = no_step(crowd, seed, guides), _no_nodes(crowd, ROOM + int(least.max(initial=0)))
        self._native = Native(Lacam(crowd, step, nodes, least, crowd.start.copy(), samples))
        _place_root(self._native.fields)

    @property
    def tried(self) -> int:
        """The successors tried so far."""
        return int(self._native.fields.nodes.counts[TRIED])

    @property
    def longest(self) -> int:
        """The steps that the longest way of a robot takes, and so all ways together at least."""
        return int(self._native.fields.least.max())

    def go(self, steps: int) -> None:
        """Try that many successors, or until `outcome` is not `RUNNING`; if it is `FOUND`, there are `paths`.

        It ends as `FULL` where more configurations or demands would take too much memory.
        """
        nodes = self._native.fields.nodes
        last = int(nodes.counts[TRIED]) + steps
        while self.outcome == RUNNING and nodes.counts[TRIED] < last:
            self.outcome = search(self._native, last - int(nodes.counts[TRIED]))
            if self.outcome == FULL:
                lacam = self._native.fields
                is_full = nodes.counts[NODES] == nodes.present.size or nodes.counts[DEPTH] == nodes.stack.size
                if (nodes.places.size if is_full else nodes.place.size) > MOST:
                    return
                nodes = _enlarged(lacam.crowd, nodes) if is_full else _with_more_demands(nodes)
                self._native = Native(lacam._replace(nodes=nodes))
                self.outcome = RUNNING
        if self.outcome == FOUND:
            self.paths = _paths(nodes)


def _no_nodes(crowd: Crowd, room: int, least: int = 0) -> Nodes:
    """Room for so many configurations, and for at least so many demands."""
    robots = crowd.start.size
    choices = int(np.diff(crowd.first).max(initial=0)) + 1
    demands = max(min(choices + 1, DEMANDED) * room, least) + choices + 1  # each successor tried adds at most `choices`
    return Nodes(
        places=np.empty((room, robots), np.int32),
        order=np.empty((room, robots), np.int32),
        present=np.empty(room, np.int32),
        parent=np.empty(room, np.int32),
        hash=np.empty(room, np.uint64),
        chain=np.empty(room, np.int32),
        bucket=np.full(2 * room, NONE, np.int32),
        head=np.empty(room, np.int32),
        tail=np.empty(room, np.int32),
        place=np.empty(demands, np.int32),
        above=np.empty(demands, np.int32),
        level=np.empty(demands, np.int32),
        later=np.empty(demands, np.int32),
        stack=np.empty(2 * room, np.int32),
        counts=np.zeros(4, np.int64),
    )


def _enlarged(crowd: Crowd, nodes: Nodes) -> Nodes:
    """The same configurations, with room for twice as many."""
    larger = _no_nodes(crowd, 2 * nodes.present.size, nodes.place.size)
    used = int(nodes.counts[NODES])
    for name, before in nodes._asdict().items():
        if name != "bucket":
            kept = before[:used] if len(before) == nodes.present.size else before
            getattr(larger, name)[: len(kept)] = kept
    for node in range(used):
        at = int(larger.hash[node]) % larger.bucket.size
        larger.chain[node], larger.bucket[at] = larger.bucket[at], node
    return larger


def _with_more_demands(nodes: Nodes) -> Nodes:
    """The same configurations, with room for twice the demands."""
    demands = (nodes.place, nodes.above, nodes.level, nodes.later)
    place, above, level, later = (np.concatenate([each, np.empty_like(each)]) for each in demands)
    return nodes._replace(place=place, above=above, level=level, later=later)


def _place_root(lacam: Lacam) -> None:
    """The configuration at tick 0; robots with the longest ways come first."""
    crowd, nodes, distance = lacam.crowd, lacam.nodes, lacam.least
    by_distance = np.argsort(-distance, kind="stable").astype(np.int32)
    present = by_distance if crowd.parks else by_distance[distance[by_distance] > 0]
    nodes.order[0, : present.size] = present
    nodes.present[0] = present.size
    add_root(Native(lacam))


def _paths(nodes: Nodes) -> Paths:
    """The paths of all robots."""
    node = int(nodes.stack[nodes.counts[DEPTH] - 1])
    steps = []
    while node != NONE:
        steps.append(node)
        node = int(nodes.parent[node])
    places = nodes.places[steps[::-1]]
    enters = []
    for way in places.T:
        present = int((way != GONE).sum())
        enters.append(np.concatenate([[0], 1 + np.flatnonzero(np.diff(way[:present]))]))
    paths = no_paths(len(enters), max(map(len, enters), default=0) + LONGER)
    for robot, ticks in enumerate(enters):
        paths.size[robot] = ticks.size
        paths.enter[robot, : ticks.size] = ticks
        paths.place[robot, : ticks.size] = places[ticks, robot]
    return paths


@entry
def add_root(native: Native[Lacam]) -> None:
    """Take the places chosen for the first configuration, whose order is there already."""
    lacam = lacam_at(native)
    add_node(lacam, NONE, hash_of(lacam.chosen))
    lacam.nodes.stack[0] = 0
    lacam.nodes.counts[DEPTH] = 1


@entry
def search(native: Native[Lacam], steps: int) -> int:
    """Try that many successors; returns how it ended, with the last configuration on top of the stack."""
    lacam = lacam_at(native)
    nodes = lacam.nodes
    counts = nodes.counts
    choices = lacam.step.wishes[0].size
    for _ in range(steps):
        if counts[DEPTH] == 0:
            return FAILED
        node = int(nodes.stack[int(counts[DEPTH]) - 1])
        if is_done(lacam.crowd, nodes.places[node]):
            return FOUND
        if (
            counts[NODES] == nodes.present.size
            or counts[DEPTH] == nodes.stack.size
            or counts[DEMANDS] + choices + 1 > nodes.place.size
        ):
            return FULL
        counts[TRIED] += 1
        try_successor(lacam, node)
        while counts[DEPTH] > 0 and nodes.head[int(nodes.stack[int(counts[DEPTH]) - 1])] == NONE:
            counts[DEPTH] -= 1
    return RUNNING


@compiled
def is_done(crowd: Crowd, places: Ints) -> bool:
    """Whether every robot is at its goal or gone."""
    for robot in range(crowd.goal.size):  # noqa: SIM110 - no generators in compiled code
        if places[robot] != crowd.goal[robot] and places[robot] != GONE:
            return False
    return True


@compiled
def try_successor(lacam: Lacam, node: int) -> None:
    """Put a configuration on the stack that can follow and meets the next demands, if one is found."""
    nodes = lacam.nodes
    step = lacam.step
    demand = int(nodes.head[node])
    nodes.head[node] = nodes.later[demand]
    places = nodes.places[node]
    order = nodes.order[node]
    present = int(nodes.present[node])
    level = int(nodes.level[demand])
    if level < present:
        robot = int(order[level])
        demand_each(lacam, node, demand, robot)
    least = ENDLESS
    for _ in range(lacam.samples if level == 0 else 1):
        begin(step, places, order, present)
        if choose_all(lacam, node, demand):
            least = keep_nearer(lacam, least)
        end(step, places, order, present)
    if least < ENDLESS:
        hash = hash_of(lacam.chosen)
        found = node_at(nodes, lacam.chosen, hash)
        if found == NONE:
            found = add_node(lacam, node, hash)
        nodes.stack[int(nodes.counts[DEPTH])] = found
        nodes.counts[DEPTH] += 1


@compiled
def keep_nearer(lacam: Lacam, least: int) -> int:
    """Choose the places of the step if their sum of distances is less than `least`; the lesser of both.

    Where there is one try, there is nothing to compare.
    """
    places = lacam.step.next
    far = 0
    for robot in range(places.size if lacam.samples > 1 else 0):
        if places[robot] != GONE:
            far += int(lacam.crowd.distance[robot][int(places[robot])])
    if far < least:
        for robot in range(places.size):
            lacam.chosen[robot] = places[robot]
    return min(far, least)


@compiled
def demand_each(lacam: Lacam, node: int, above: int, robot: int) -> None:
    """Add the demands that the robot goes to each place that it can be in, beside the demands above."""
    nodes = lacam.nodes
    wishes = lacam.step.wishes[0]
    for k in range(rank_choices(lacam.crowd, lacam.step, robot, int(nodes.places[node][robot]), wishes)):
        add_demand(nodes, node, int(wishes[k]), above, int(nodes.level[above]) + 1)


@compiled
def add_demand(nodes: Nodes, node: int, place: int, above: int, level: int) -> None:
    """Put a demand behind those of the configuration."""
    demand = int(nodes.counts[DEMANDS])
    nodes.counts[DEMANDS] += 1
    nodes.place[demand] = place
    nodes.above[demand] = above
    nodes.level[demand] = level
    nodes.later[demand] = NONE
    if nodes.head[node] == NONE:
        nodes.head[node] = demand
    else:
        nodes.later[int(nodes.tail[node])] = demand
    nodes.tail[node] = demand


@compiled
def choose_all(lacam: Lacam, node: int, demand: int) -> bool:
    """Choose the next places of all robots as demanded; whether that was possible."""
    nodes = lacam.nodes
    step = lacam.step
    places = nodes.places[node]
    order = nodes.order[node]
    while nodes.level[demand] > 0:
        robot = int(order[int(nodes.level[demand]) - 1])
        place = int(nodes.place[demand])
        if not is_open(step, places, robot, place):
            return False
        take(step, robot, place)
        demand = int(nodes.above[demand])
    for k in range(int(nodes.present[node])):
        robot = int(order[k])
        if step.next[robot] == NOWHERE and not choose(lacam.crowd, step, places, robot):
            return False
    return True


@compiled
def hash_of(places: Ints) -> np.uint64:
    """A hash of a configuration: the sum of one number for each robot and place."""
    total = np.uint64(0)
    for robot in range(places.size):
        mixed = (np.uint64(robot + 1) << np.uint64(32)) + np.uint64(places[robot] + 1)
        mixed *= GOLDEN
        mixed = (mixed ^ (mixed >> np.uint64(30))) * FIRST_MIX
        mixed = (mixed ^ (mixed >> np.uint64(27))) * SECOND_MIX
        total += mixed ^ (mixed >> np.uint64(31))
    return np.uint64(total)


@compiled
def node_at(nodes: Nodes, places: Ints, hash: np.uint64) -> int:
    """The configuration with these places; `NONE` if it has not been reached."""
    node = int(nodes.bucket[int(hash % np.uint64(nodes.bucket.size))])
    while node != NONE:
        if nodes.hash[node] == hash and is_same(nodes.places[node], places):
            return node
        node = int(nodes.chain[node])
    return NONE


@compiled
def is_same(one: Ints, other: Ints) -> bool:
    """Whether two configurations are the same."""
    for robot in range(one.size):  # noqa: SIM110 - no generators in compiled code
        if one[robot] != other[robot]:
            return False
    return True


@compiled
def add_node(lacam: Lacam, parent: int, hash: np.uint64) -> int:
    """Make a configuration of the places chosen."""
    nodes = lacam.nodes
    node = int(nodes.counts[NODES])
    nodes.counts[NODES] += 1
    places = nodes.places[node]
    for robot in range(places.size):
        places[robot] = lacam.chosen[robot]
    nodes.parent[node] = parent
    nodes.hash[node] = hash
    at = int(hash % np.uint64(nodes.bucket.size))
    nodes.chain[node] = nodes.bucket[at]
    nodes.bucket[at] = node
    if parent != NONE:
        nodes.present[node] = put_in_order(lacam, node, nodes.order[parent], int(nodes.present[parent]))
    nodes.head[node] = NONE
    add_demand(nodes, node, NONE, NONE, 0)
    return node


@compiled
def put_in_order(lacam: Lacam, node: int, before: Ints, present: int) -> int:
    """Order the robots that are there at the next tick, from the order before; how many there are.

    Those that were at their goals longest ago come first, and those that are at theirs last, each by the length of the
    way from its start: in the order before, those on their way stand like that already.
    """
    crowd = lacam.crowd
    places = lacam.nodes.places[node]
    order = lacam.nodes.order[node]
    count = 0
    for k in range(present):
        robot = int(before[k])
        if places[robot] != crowd.goal[robot]:
            order[count] = robot
            count += 1
    away = count
    for k in range(present):
        robot = int(before[k])
        if places[robot] == crowd.goal[robot] and crowd.parks:
            place = count
            way = int(lacam.least[robot])
            while place > away and way > lacam.least[int(order[place - 1])]:
                order[place] = order[place - 1]
                place -= 1
            order[place] = robot
            count += 1
    return count
