"""Cells split by the heading of robots, so that a turn takes time, as in the League of Robot Runners 2023 and 2024.

A cell becomes a resource for each heading E, S, W and N, and itself, at which goals are reached in any heading; all of
them are a group of the cell's capacity. A robot drives on in its heading (F), or moves to the next heading clockwise or
counter-clockwise (R, C), and each takes the duration of the cell. To end takes one step more, out of the heading.
"""

from dataclasses import replace

from carp_spec import Instance, Move, ResourceGraph, ResourceId
from carp_spec.inputs.values import require_instance
from carp_spec.model import Group
from carp_spec.rule import DESIGN
from carproof.input_rules import Code

HEADINGS = {(1, 0): "E", (0, 1): "S", (-1, 0): "W", (0, -1): "N"}
"""By the step of the position; y grows downwards."""
CELLS_SIDE_BY_SIDE = Code(
    "generate/headings",
    "Cells that are split by heading have positions, moves lead between cells side by side, no group is there before, "
    "and robots have goals alone.",
    DESIGN,
)


def parts_of(cell: ResourceId) -> tuple[str, ...]:
    """The resources of a cell that is split, one for each heading, in their order."""
    return tuple(f"{cell} {name}" for name in HEADINGS.values())


def with_headings(instance: Instance) -> Instance:
    """The instance with split cells; robots start with the heading E. Raises `Refusal` where cells cannot be split."""
    require_instance(instance)
    graph = instance.graph
    if graph.groups:
        raise CELLS_SIDE_BY_SIDE.refuse("$.graph.groups", "there must be no groups before cells are split")
    for index, robot in enumerate(instance.robots):
        if len(robot.stops) > 1 or robot.stops[0].service:
            raise CELLS_SIDE_BY_SIDE.refuse(
                f"$.robots[{index}].stops", "robots must have goals alone, to be reached in any heading"
            )
    parts = {each: dict(zip(HEADINGS, parts_of(each), strict=True)) for each in graph.resource}
    moves: list[Move] = []
    for source, target in sorted(graph.moves, key=lambda move: (graph.index[move[0]], graph.index[move[1]])):
        one, two = graph.resource[source], graph.resource[target]
        if one.x is None or one.y is None or two.x is None or two.y is None:
            raise CELLS_SIDE_BY_SIDE.refuse("$.graph.resources", f"{source!r} and {target!r} must have positions")
        way = (two.x - one.x, two.y - one.y)
        if way not in HEADINGS:
            raise CELLS_SIDE_BY_SIDE.refuse("$.graph.edges", f"{source!r} and {target!r} must be side by side")
        moves.append((parts[source][way], parts[target][way]))
    ring = [*HEADINGS]
    for each, split in parts.items():
        for way, following in zip(ring, [*ring[1:], ring[0]], strict=True):
            moves += [(split[way], split[following]), (split[following], split[way]), (split[way], each)]
    resources = [
        part for each in graph.resources for part in (each, *(replace(each, id=id) for id in parts[each.id].values()))
    ]
    groups = tuple(
        Group(f"cell {each.id}", (each.id, *parts[each.id].values()), each.capacity) for each in graph.resources
    )
    robots = tuple(replace(each, start=parts[each.start][ring[0]]) for each in instance.robots)
    made = replace(instance, graph=ResourceGraph(tuple(resources), tuple(moves), True, groups), robots=robots)
    require_instance(made)
    return made
