"""Guides: ways without waits that meet each other as little as can be, before any robot moves.

Robots that each go the shortest way meet head-on where a detour of a few ticks would avoid it. So each gets a guide,
one after the other: of all ways that are at most `SLACK` ticks longer than the shortest, one that meets the fewest
guides of others, in a place at a tick or on an edge from opposite sides. In further passes each is looked for again.
`carp_optimized.lacam.pibt` prefers the next place of the guide.

A way that comes to a place later than another, and has met as many, is not looked at further. It could meet fewer
from there on, so what is found need not be the best. But a shortest way that meets fewer is never missed, searches take
half as long, and plans by LaCAM are as good. Source: optimised use of space (Han and Yu 2022), as it is put before
LaCAM by Okumura 2024.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import FAR, Crowd, ways_of
from carp_optimized.draws import GOLDEN
from carp_optimized.jit.compiling import compiled, entry
from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.jit.references import Native, dereference
from carp_optimized.queries.heap import push, replace_root
from carp_optimized.state.arrays import NONE

SLACK = 10
"""The ticks by which a guide may be longer than the shortest way."""
WIDTH = SLACK + 1
PART = 8
"""The robots whose guides one compiled call looks for."""
PASSES = 4
"""Plans by LaCAM after each differ by a few percent, and not in one direction: the best are taken."""
MEETING = 1 << 40
"""What a meeting counts in a key, more than any way and slack."""
LATER = 1 << 20  # what a tick beyond the shortest way counts in a key, more than any distance
COUNTED = 20
"""The bits that count the uses of an entry; the others are its key."""
LINE = 3
"""The last bits of a key, which tell an entry from others in its line of the cache: those of places nearby."""


class Guides(NamedTuple):
    """The guide of each robot, `way[first[robot]:][:size[robot]]`, and who uses which place or edge when.

    `uses` are hashed: how many use a place at a tick, or an edge, below the key. `since[place]` is when a robot parks
    there. A label of a search is a place and a slack; `popped[place]` is the least slack with which it was expanded.
    """

    crowd: Crowd
    way: Ints
    first: Longs
    size: Ints
    since: Ints
    uses: Longs
    met: Ints
    mark: Ints
    before: Ints
    popped: Ints
    keys: Longs
    nodes: Ints
    searches: Longs


guides_at = dereference(Guides)


def no_guides(crowd: Crowd) -> Guides:
    """No guides; there is room for those of all robots of the crowd, which has been measured, and `can_begin`."""
    room = ways_of(crowd).astype(np.int64) + SLACK + 1
    resources, edges = crowd.queue.size, crowd.target.size
    entries = 1 << ((2 * PASSES + 1) * int(room.sum())).bit_length()
    labels = resources * WIDTH
    return Guides(
        crowd=crowd,
        way=np.empty(int(room.sum()), np.int32),
        first=np.concatenate([[0], np.cumsum(room)[:-1]]).astype(np.int64),
        size=np.zeros(room.size, np.int32),
        since=np.full(resources, FAR, np.int32),
        uses=np.zeros(entries, np.int64),
        met=np.empty(labels, np.int32),
        mark=np.zeros(labels, np.int32),
        before=np.empty(labels, np.int32),
        popped=np.zeros(resources, np.int32),
        keys=np.empty(edges * WIDTH + 1, np.int64),
        nodes=np.empty(edges * WIDTH + 1, np.int32),
        searches=np.zeros(1, np.int64),
    )


def guides_of(crowd: Crowd, goes_on: Callable[[], bool]) -> Iterator[Guides]:
    """Guides of the robots after each pass, the last of which may end early for want of time."""
    guides = no_guides(crowd)
    native = Native(guides)
    order = np.argsort(-ways_of(crowd), kind="stable").astype(np.int32)
    for _ in range(PASSES):
        for begin in range(0, order.size, PART):
            if not goes_on():
                yield guides
                return
            find_guides(native, order, begin, min(begin + PART, order.size))
        yield guides


@entry
def find_guides(native: Native[Guides], order: Ints, begin: int, end: int) -> None:
    """Look for the guides of the robots `order[begin:end]`, again if they have some."""
    guides = guides_at(native)
    for k in range(begin, end):
        robot = int(order[k])
        count_guide(guides, robot, -1)
        write_guide(guides, robot, find_guide(guides, robot))
        count_guide(guides, robot, 1)


@compiled
def key_of(guides: Guides, tick: int, what: int) -> int:
    """The key of a place at a tick, or of an edge, whose number follows those of places; never 0."""
    return int(tick * (guides.since.size + guides.crowd.target.size) + what + 1)


@compiled
def entry_of(guides: Guides, key: int) -> int:
    """The entry of a key, or the empty one where it would stand."""
    last = guides.uses.size - 1
    mixed = np.uint64(key >> LINE) * GOLDEN
    at = ((int(np.int64(mixed >> np.uint64(24))) << LINE) + key % (1 << LINE)) & last
    while guides.uses[at] != 0 and guides.uses[at] >> COUNTED != key:
        at = (at + 1) & last
    return int(at)


@compiled
def uses_of(guides: Guides, tick: int, what: int) -> int:
    """How many guides use it at the tick."""
    return int(guides.uses[entry_of(guides, key_of(guides, tick, what))] % (1 << COUNTED))


@compiled
def count_use(guides: Guides, tick: int, what: int, sign: int) -> None:
    """Add a use, or take it off again."""
    key = key_of(guides, tick, what)
    at = entry_of(guides, key)
    if guides.uses[at] == 0:
        guides.uses[at] = key << COUNTED
    guides.uses[at] += sign


@compiled
def count_guide(guides: Guides, robot: int, sign: int) -> None:
    """Add what the robot's guide uses, or take it off again."""
    first = int(guides.first[robot])
    size = int(guides.size[robot])
    resources = int(guides.since.size)
    for tick in range(size):
        place = int(guides.way[first + tick])
        count_use(guides, tick, place, sign)
        if tick > 0:
            before = int(guides.way[first + tick - 1])
            count_use(guides, tick, resources + edge_between(guides.crowd, before, place), sign)
    if size > 0 and guides.crowd.parks:
        guides.since[int(guides.crowd.goal[robot])] = size if sign > 0 else FAR


@compiled
def edge_between(crowd: Crowd, source: int, target: int) -> int:
    """The number of the edge; `NONE` if there is none."""
    for edge in range(int(crowd.first[source]), int(crowd.first[source + 1])):
        if crowd.target[edge] == target:
            return edge
    return NONE


@compiled
def find_guide(guides: Guides, robot: int) -> int:
    """The label of the goal at the end of a way that meets the fewest (Dijkstra), of these one of the shortest.

    `NONE` if there is none because the distance from the start is an estimate, and too low by more than `SLACK`.
    """
    crowd = guides.crowd
    distance = crowd.distance[robot]
    start = int(crowd.start[robot])
    goal = int(crowd.goal[robot])
    least = int(distance[start])
    resources = int(guides.since.size)
    guides.searches[0] += 1
    generation = int(guides.searches[0])
    label = start * WIDTH
    guides.mark[label] = generation
    guides.met[label] = 0
    guides.before[label] = NONE
    push(guides.keys, guides.nodes, 0, least, label)
    size = 1
    while size > 0:
        label = int(guides.nodes[0])
        size -= 1
        replace_root(guides.keys, guides.nodes, size, int(guides.keys[size]), int(guides.nodes[size]))
        place = label // WIDTH
        slack = label % WIDTH
        if place == goal:
            return label
        here = int(guides.popped[place])
        if here // WIDTH == generation and slack >= here % WIDTH:
            continue
        guides.popped[place] = generation * WIDTH + slack
        met = int(guides.met[label])
        tick = least + slack - int(distance[place]) + 1
        is_entered = uses_of(guides, tick, place) > 0  # as it is if any guide comes the other way on an edge
        for edge in range(int(crowd.first[place]), int(crowd.first[place + 1])):
            target = int(crowd.target[edge])
            later = tick + int(distance[target]) - least
            if later > SLACK:
                continue
            meets = met + uses_of(guides, tick, target) + (1 if guides.since[target] <= tick else 0)
            back = edge_between(crowd, target, place) if is_entered else NONE
            if back != NONE:
                meets += uses_of(guides, tick, resources + back)
            reached = target * WIDTH + later
            if guides.mark[reached] != generation or meets < guides.met[reached]:
                guides.mark[reached] = generation
                guides.met[reached] = meets
                guides.before[reached] = label
                rank = meets * MEETING + later * LATER + int(distance[target])
                push(guides.keys, guides.nodes, size, rank, reached)
                size += 1
    return NONE


@compiled
def write_guide(guides: Guides, robot: int, found: int) -> None:
    """Write the way that leads to a label; without one there is no guide."""
    least = int(guides.crowd.distance[robot][int(guides.crowd.start[robot])])
    size = 0 if found == NONE else least + found % WIDTH + 1
    guides.size[robot] = size
    at = int(guides.first[robot]) + size
    while found != NONE:
        at -= 1
        guides.way[at] = found // WIDTH
        found = int(guides.before[found])


@compiled
def next_on_guide(way: Ints, first: int, size: int, rest: int, place: int) -> int:
    """Where the guide goes on from a place that is `rest` from the goal; `NONE` if it does not come there."""
    for slack in range(WIDTH):
        at = size - 1 - rest - slack
        if at < 0:
            return NONE
        if way[first + at] == place:
            return int(way[first + at + 1]) if at + 1 < size else NONE
    return NONE
