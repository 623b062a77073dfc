"""A large plant of openTCS made of equal tiles, and how long `carproof plan` takes for its fleets.

A tile has four crossings of one-way streets, and two bays at each, where vehicles stand. Streets go on from tile to
tile, in turn one way and the other. `python -m carp_experiments.measuring.tiled_plant` prints the table; with names of
layouts, such as a published plant model, the table of plants whose tiles are these.
"""

import sys
from collections.abc import Callable, Iterator
from os import times
from pathlib import Path

import carp_optimized
import carproof
from carp_experiments.measuring.tiling import core_of, tiled
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.anytime import nearest_first, shortest_ways
from carp_optimized.improve.holding import plan_holding_starts
from carp_spec import Carp, Instance, Solution, judge
from carproof.layouts import Settings, import_layout, read_layout
from carproof.layouts.layout import Layout
from carproof.layouts.making import instance_of

PITCH = 5000
"""Between two crossings, in mm."""
TILES = 12
"""In a row, and in a column."""
FLEETS = ((100, 12), (300, 12), (1000, 12), (3000, 21))
"""Robots, and tiles in a row: bays for 3,000 take a larger plant."""
SECONDS = 10
RESOURCES = 5000
"""At least, of a plant whose tiles are a layout; robots that its points cannot hold take a larger plant."""


def tiled_plant(tiles: int = TILES) -> bytes:
    """The plant model of a square of tiles."""
    parts = "".join(part for x in range(2 * tiles) for y in range(2 * tiles) for part in _crossing(x, y, 2 * tiles - 1))
    return f'<model version="7.0.0" name="tiles">{parts}</model>'.encode()


def _crossing(x: int, y: int, last: int) -> Iterator[str]:
    """A crossing with its bays, and the streets that lead out of it: rows go east and west, columns up and down."""
    name = f"{x},{y}"
    yield _point(name, PITCH * x, PITCH * y, "HALT_POSITION")
    for number, (dx, dy) in enumerate(((1500, 1500), (-1500, 1500))):
        bay = f"{name} bay {number}"
        yield _point(bay, PITCH * x + dx, PITCH * y + dy, "PARK_POSITION")
        yield _path(f"to {bay}", name, bay, 2122, 1000)
    east, down = x + (-1 if y % 2 else 1), y + (1 if x % 2 else -1)
    if 0 <= east <= last:
        yield _path(f"{name} to {east},{y}", name, f"{east},{y}", PITCH, 0)
    if 0 <= down <= last:
        yield _path(f"{name} to {x},{down}", name, f"{x},{down}", PITCH, 0)


def _point(name: str, x: int, y: int, kind: str) -> str:
    return f'<point name="{name}" positionX="{x}" positionY="{y}" type="{kind}"/>'


def _path(name: str, source: str, target: str, length: int, back: int) -> str:
    ends = f'sourcePoint="{source}" destinationPoint="{target}"'
    return f'<path name="{name}" {ends} length="{length}" maxVelocity="1000" maxReverseVelocity="{back}"/>'


def tiled_instance(robots: int, tiles: int = TILES) -> Instance:
    """The plant with a fleet that vanishes at its goals."""
    settings = Settings(robots=robots, after_goal="vanish")
    return import_layout(tiled_plant(tiles), "tiles.xml", settings=settings).instance


def instance_of_tiles(layout: Layout, robots: int, resources: int = RESOURCES) -> Instance:
    """As few tiles of a layout as have the resources and points where all robots can stand; they vanish at goals."""
    stands = sum(each.stands for each in core_of(layout))
    if not stands:
        raise layout.tree.refuse("the layout must have points where vehicles stand, each reached from each")
    tiles = max(-(-resources // (len(layout.points) + len(layout.lanes))), -(-robots // stands))
    return instance_of(tiled(layout, tiles), Settings(robots=robots, after_goal="vanish"))


def _row(instance: Instance) -> str:
    """The numbers of a fleet: its plans by CARP alone, where each holds its start, and within ten seconds."""
    by_way = nearest_first(shortest_ways(PlannedFleet(instance)))
    row: list[object] = [len(instance.robots), len(instance.graph.resources), len(instance.graph.groups)]
    planners: tuple[Callable[[], Solution], ...] = (
        lambda: carp_optimized.plan(instance, Carp()),
        lambda: Solution.of(instance, plan_holding_starts(instance, by_way, lambda _: True).plans),
        lambda: carproof.plan_within(instance, seconds=SECONDS),
    )
    for make in planners:
        started = _processor_seconds()
        solution = make()
        row.append(f"{_processor_seconds() - started:.2f}")
        verdict = judge(instance, solution)
        if not verdict.valid:
            raise AssertionError(verdict.violations[0])
        row += [verdict.unplanned, verdict.cost]
    return f"| {' | '.join(map(str, row))} |"


def _processor_seconds() -> float:
    """Of this process and those that it has waited for."""
    return sum(times()[:4])


if __name__ == "__main__":
    _row(tiled_instance(8, 1))  # compiles
    for count, size in () if sys.argv[1:] else FLEETS:
        print(_row(tiled_instance(count, size)), flush=True)  # noqa: T201 - the table
    for file in sys.argv[1:]:
        read = read_layout(Path(file).read_bytes(), file)[1]
        for count, _ in FLEETS:
            print(_row(instance_of_tiles(read, count)), flush=True)  # noqa: T201 - the table
