"""The arrays of one part of a search by branching (`carp_optimum.branching.branching`).

All stays take a tick and all resources hold one robot. A node says that a robot is in a resource at a tick, and a way
of a robot is a path of nodes from its start to its goal. A part of the search is the nodes that are still `alive`.
"""

from typing import NamedTuple

from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, IntTable, Longs
from carp_optimized.jit.references import dereference

SCALE = 1 << 16  # parts of a tick
ENDLESS = 1 << 60
COUNTERS = 4
WORK, STEPS, LAST, LATE = range(COUNTERS)
"""The counters: rows and arcs looked at, steps, the last tick of the ways and that of the nodes."""


class Nodes(NamedTuple):
    """The graph and the nodes, by robot, tick and resource.

    Moves lead from r to `target[first[r]:first[r + 1]]`; `back[move]` is the move back, or `NONE`. `of_robot` has the
    first node of each robot, and at the end their number; `at[robot][tick * resources + resource]` is the node, or
    `NONE`. A node leads to `leads[node][0]` by waiting and to `leads[node][1 + k]` by the k-th move of its resource,
    each `NONE` where it does not; one at the goal leads nowhere. `gain` adds up what the bound rose by where the robot
    was put there, which was tried as often as `tries` says.
    """

    first: Ints
    target: Ints
    back: Ints
    goal: Ints
    of_robot: Ints
    place: Ints
    tick: Ints
    at: IntTable
    leads: IntTable
    gain: Longs
    tries: Longs


class Rows(NamedTuple):
    """Prices and use: tick by tick, first the resources and then the moves.

    `best` are the prices of the best bound. `paid` is what waiting in a resource costs at the tick, and the move.
    """

    price: Longs
    best: Longs
    paid: Longs
    used: Ints
    course: Longs


class Live(NamedTuple):
    """The nodes that are alive, in order, with their arcs; `of_robot` has the first of each robot.

    Node k has the arcs from `arc[k]` on, to the live node `to` for what `row` costs. `least` is the least that is paid
    from the node on, `before` that up to it, and `choice` the arc of the cheapest way. `often` is in how many steps the
    robot's way had it.
    """

    number: Ints
    node: Ints
    of_robot: Ints
    arc: Ints
    to: Ints
    row: Ints
    least: Longs
    before: Longs
    choice: Ints
    often: Ints


class Part(NamedTuple):
    """All arrays of a search; `alive` says of each node whether the part has it."""

    nodes: Nodes
    rows: Rows
    live: Live
    alive: Ints
    counters: Longs


part_at = dereference(Part)


@compiled
def rows_of_tick(part: Part) -> int:
    """The number of rows of a tick."""
    return part.nodes.first.size - 1 + part.nodes.target.size
