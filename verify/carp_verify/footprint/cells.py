"""A floor of cells: a vehicle is in each from half way from the one before until half way to the one after.

Nothing but positions and plans is read. Consecutive visits at one position, such as those of the headings of a cell,
are turns there. Lengths are doubled, so that half ways are whole.
"""

from collections.abc import Iterator, Sequence

from carp_spec import Plan, Visit
from carp_spec.model import ResourceGraph
from carp_verify.footprint.floor import Shape, Spot, spots_of


def swept_in_cells(graph: ResourceGraph, plans: Sequence[Plan], step: int) -> Iterator[tuple[Shape, Plan, Visit]]:
    """The shapes of each visit of a known resource; `step` is the doubled length of a step of the positions, in mm.

    Raises `Refusal` for a resource without a position.
    """
    spot = {each: (step * x, step * y) for each, (x, y) in spots_of(graph).items()}
    for plan in plans:
        known = [each for each in plan.visits if each.resource in spot]
        spots = [spot[each.resource] for each in known]
        for number, visit in enumerate(known):
            beside = [*spots[max(0, number - 1) : number], *spots[number + 1 : number + 2]]
            for shape in _swept(spots[number], beside):
                yield shape, plan, visit


def _swept(here: Spot, beside: Sequence[Spot]) -> Iterator[Shape]:
    """The ways from half way to those beside, and the cell itself where the vehicle turns or stays."""
    ways = [(x - here[0], y - here[1]) for x, y in beside]
    for way in ways:
        if way != (0, 0):
            yield Shape(here, (here[0] + way[0] // 2, here[1] + way[1] // 2), way)
    if not ways or (0, 0) in ways or ways[0][0] * ways[-1][1] != ways[0][1] * ways[-1][0]:
        yield Shape(here, here, None)
