"""Which resources lie in one group, and which are close."""

from carp_optimized.jit.compiling import compiled, inlined
from carp_optimized.state.arrays import GROUPED, NEVER, NONE, Graph


@inlined
def is_grouped(graph: Graph, resource: int) -> bool:
    """Whether the resource, or `NONE`, is one of a group."""
    return resource != NONE and graph.capacity[resource] == GROUPED


@compiled
def is_within(graph: Graph, group: int, resource: int) -> bool:
    """Whether the resource, or `NONE`, is one of the group."""
    if not is_grouped(graph, resource):
        return False
    for k in range(int(graph.groups_first[resource]), int(graph.groups_first[resource + 1])):
        if graph.group[k] == group:
            return True
    return False


@compiled
def share_group(graph: Graph, one: int, other: int, most: int) -> bool:
    """Whether two resources, or `NONE`, lie in one group with room for at most so many."""
    if not is_grouped(graph, one):
        return False
    for k in range(int(graph.groups_first[one]), int(graph.groups_first[one + 1])):
        group = int(graph.group[k])
        if graph.room[graph.capacity.size + group] <= most and is_within(graph, group, other):
            return True
    return False


@inlined
def are_close(graph: Graph, one: int, other: int) -> bool:
    """Whether two resources, or `NONE`, are the same or lie in one group of capacity 1."""
    return one == other or share_group(graph, one, other, 1)


@inlined
def meet(graph: Graph, one: int, other: int) -> bool:
    """Whether two resources are the same or lie in one group."""
    return one == other or share_group(graph, one, other, NEVER)
