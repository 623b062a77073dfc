"""Every small query: all connected graphs of a few resources, with two robots committed and a third to plan."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

from carp_spec import AfterGoal, Instance, Plan, Resource, ResourceGraph, Robot, RobotId

MOST_RESOURCES = 4
COMMITTED = ("first", "second")
ASKED: RobotId = "third"


@dataclass(frozen=True, slots=True)
class Pattern:
    """Durations and capacities of the resources by index, and the releases of the three robots."""

    durations: tuple[int, ...]
    capacities: tuple[int, ...]
    releases: tuple[int, int, int]


PATTERNS: tuple[Pattern, ...] = (
    Pattern((1, 1, 1, 1), (1, 1, 1, 1), (0, 0, 0)),
    Pattern((1, 2, 1, 3), (1, 1, 1, 1), (0, 0, 0)),
    Pattern((2, 1, 1, 1), (1, 2, 1, 1), (0, 0, 1)),
    Pattern((1, 1, 2, 1), (2, 1, 1, 1), (1, 0, 0)),
)


@dataclass(frozen=True, slots=True)
class SmallCase:
    """An instance, the plans of its first two robots (as far as they have one), and the third robot."""

    instance: Instance
    committed: tuple[Plan, ...]


def connected_graphs() -> Iterator[tuple[int, tuple[tuple[int, int], ...]]]:
    """The connected graphs of up to four nodes in networkx's atlas: how many nodes, and the edges."""
    import networkx as nx
    from networkx.generators.atlas import graph_atlas_g

    for graph in graph_atlas_g():
        if 0 < len(graph) <= MOST_RESOURCES and nx.is_connected(graph):
            yield len(graph), tuple((int(source), int(target)) for source, target in graph.edges)


def small_cases(pattern: Pattern) -> Iterator[SmallCase]:
    """All graphs, starts, goals and policies for one pattern; the committed plans are CARP's."""
    import carp_reference

    policies: tuple[AfterGoal, ...] = ("vanish", "park")
    for (size, edges), after_goal in product(connected_graphs(), policies):
        nodes = range(size)
        graph = ResourceGraph(
            tuple(Resource(node, pattern.capacities[node], pattern.durations[node]) for node in nodes), edges
        )
        for ends in product(product(nodes, repeat=2), repeat=2):
            committed: tuple[Plan, ...] = ()
            robots = [
                Robot(id, start, goal, release)
                for id, (start, goal), release in zip(COMMITTED, ends, pattern.releases, strict=False)
            ]
            instance = Instance(graph, tuple(robots), after_goal)
            for robot in COMMITTED:
                plan = carp_reference.query(instance, committed, robot)
                committed = committed if plan is None else (*committed, plan)
            for start, goal in product(nodes, repeat=2):
                asked = Robot(ASKED, start, goal, pattern.releases[2])
                yield SmallCase(Instance(graph, (*robots, asked), after_goal), committed)
