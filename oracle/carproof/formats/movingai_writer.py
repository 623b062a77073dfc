"""Writes classical instances as MovingAI `.map` and `.scen` files, which `movingai` reads.

The files do not have the ids of resources and robots; cells identify resources, and the order of robots is kept. The
lengths, which are for octile moves, are written as 0.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from carp_spec import Instance, Refusal
from carp_spec.inputs.values import require_instance
from carproof.formats.movingai import CLASSICAL
from carproof.formats.walks import cell_of
from carproof.generate.options import size_is_bounded

MAP_NAME = "instance.map"


@dataclass(frozen=True, slots=True)
class MovingAIFiles:
    """The contents of both files."""

    map: bytes
    scen: bytes


def is_classical(instance: Instance) -> bool:
    """Whether the files can express the instance, and it is one of classical multi-agent path finding.

    It has robots, which all start in different cells, end in different cells and park. They are present from tick 0,
    have goals alone, and paces, durations and capacities are one. Cells are joined exactly to those beside them.
    """
    resources, robots = instance.graph.resources, instance.robots
    starts, goals = {robot.start for robot in robots}, {robot.goal for robot in robots}
    return (
        instance.after_goal == "park"
        and len(starts) == len(goals) == len(robots) > 0
        and all(robot.has_goal_alone and (robot.release, robot.pace) == (0, 1) for robot in robots)
        and all((resource.capacity, resource.duration) == (1, 1) for resource in resources)
        and _is_grid(instance)
    )


def _is_grid(instance: Instance) -> bool:
    graph = instance.graph
    places = [(each.x, each.y) for each in graph.resources if each.x is not None and each.y is not None]
    cells = {(x, y) for x, y in places if x >= 0 and y >= 0}
    if len(cells) < len(graph.resources) or not size_is_bounded(*_size(cells)):
        return False
    moves = {(cell_of(instance, source), cell_of(instance, target)) for source, target in graph.moves}
    beside = {((x, y), other) for x, y in cells for other in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1))}
    return moves == {(cell, other) for cell, other in beside if other in cells}


def _size(cells: set[tuple[int, int]]) -> tuple[int, int]:
    """The width and height of the least map with the cells."""
    return (max((x for x, _ in cells), default=-1) + 1, max((y for _, y in cells), default=-1) + 1)


def write_movingai(instance: Instance) -> MovingAIFiles:
    """Write a classical instance; raises `Refusal` for another, which the files cannot express."""
    require_instance(instance)
    if not is_classical(instance):
        raise Refusal("option", "$", CLASSICAL.id, "a map and a scenario cannot express it: it must be classical")
    cells = {cell_of(instance, id) for id in instance.graph.index}
    width, height = _size(cells)
    rows = ["".join("." if (x, y) in cells else "@" for x in range(width)) for y in range(height)]
    agents = []
    for robot in instance.robots:
        ends = (*cell_of(instance, robot.start), *cell_of(instance, robot.goal))
        agents.append("\t".join(map(str, (0, MAP_NAME, width, height, *ends, 0))))
    return MovingAIFiles(
        _file(["type octile", f"height {height}", f"width {width}", "map", *rows]), _file(["version 1", *agents])
    )


def _file(lines: Iterable[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()
