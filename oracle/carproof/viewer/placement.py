"""Placement of the resources of a graph: at their own positions, or laid out by networkx.

Own positions are used if every resource has one, no two share one, and they are not scattered so widely that the
resources would be dots. All results are whole numbers of drawing units. Plants, which have lanes, are placed by their
points; their y leads upwards, as in the files of fleet systems.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, pairwise
from math import isqrt
from statistics import median_low
from typing import TYPE_CHECKING

from carp_spec import ResourceGraph, ResourceId
from carproof.viewer.plants import Lanes, Point, Points, Way, parts_of, ways_of, without_lanes

if TYPE_CHECKING:
    from networkx import Graph

UNIT = 40
"""Drawing units from a resource to the nearest that it is joined to, unless others are much farther away."""
IN_PLANTS = 2
"""How many times as far apart points are that lanes join."""
MARGIN = 26
WIDEST = 4_000
LONGEST_EDGE = 4
LONGEST_LANE = 2
AROUND = ((0, 0), (18, 0), (0, 18), (-18, 0), (0, -18), (18, 18), (-18, 18), (-18, -18), (18, -18))
FLOORS = 2
"""How many times wider than high floors are put beside each other."""
FEWEST_SPRUNG, MOST_SPRUNG = 3, 400
ITERATIONS = 80
SPRING = UNIT * 3 // 2
PUSHES = 40


@dataclass(frozen=True, slots=True)
class Placement:
    """The centres of the resources, the size of the drawing, and whether the positions are not their own.

    `ways` has where lanes begin and end.
    """

    points: Points
    width: int
    height: int
    computed: bool
    ways: Mapping[ResourceId, Way] = field(default_factory=dict)


def placement(graph: ResourceGraph, lanes: Lanes | None = None) -> Placement:
    """Place the resources of a graph, and the lanes of a plant between their points."""
    if not lanes:
        own = own_points(graph)
        return in_drawing(computed_points(graph) if own is None else own, computed=own is None)
    among = without_lanes(graph, lanes)
    turned = tuple(each if each.y is None else replace(each, y=-each.y) for each in among.resources)
    own = own_points(ResourceGraph(turned, among.edges, directed=True), is_plant=True)
    points = computed_points(among) if own is None else own
    placed = in_drawing({id: (IN_PLANTS * x, IN_PLANTS * y) for id, (x, y) in points.items()}, computed=own is None)
    ways = ways_of(placed.points, lanes)
    middles = {id: ((one[0] + two[0]) // 2, (one[1] + two[1]) // 2) for id, (one, two) in ways.items()}
    return replace(placed, points={**placed.points, **middles}, ways=ways)


def in_drawing(points: Points, *, computed: bool) -> Placement:
    """The points in a drawing that begins at 0."""
    left = min((x for x, _ in points.values()), default=0) - MARGIN
    top = min((y for _, y in points.values()), default=0) - MARGIN
    shifted = {id: (x - left, y - top) for id, (x, y) in points.items()}
    width = max((x for x, _ in shifted.values()), default=MARGIN) + MARGIN
    height = max((y for _, y in shifted.values()), default=MARGIN) + MARGIN
    return Placement(shifted, width, height, computed)


def own_points(graph: ResourceGraph, *, is_plant: bool = False) -> Points | None:
    """The resources' own positions in drawing units, if they are fit to be drawn.

    Connected parts of a plant are put beside each other where two have points at one position: they are floors. Points
    at one position of a part, a point's headings, are drawn around it.
    """
    positions = {each.id: (each.x, each.y) for each in graph.resources if each.x is not None and each.y is not None}
    if len(positions) < len(graph.resources):
        return None
    lengths = [each for each in edge_lengths(positions, graph.edges) if each] or [1]
    spacing = max(lengths[0], median_low(lengths) // (LONGEST_LANE if is_plant else LONGEST_EDGE))
    part = parts_of(graph) if is_plant else dict.fromkeys(positions, 0)
    is_taken = len(set(positions.values())) < len(positions)
    if extent(positions.values()) > WIDEST * spacing or (is_taken and not is_plant):
        return None
    points: dict[ResourceId, Point] = {}
    count: Counter[tuple[int, Point]] = Counter()
    for id, (x, y) in positions.items():
        right, down = AROUND[count[part[id], (x, y)] % len(AROUND)]
        count[part[id], (x, y)] += 1
        points[id] = (x * UNIT // spacing + right, y * UNIT // spacing + down)
    if len(count) == len({at for _, at in count}):
        return points
    floors = [{id: points[id] for id in points if part[id] == each} for each in dict.fromkeys(part.values())]
    return packed(floors, FLOORS)


def edge_lengths(positions: Points, edges: Iterable[tuple[ResourceId, ResourceId]]) -> Sequence[int]:
    """The lengths of the edges along their longer axes, sorted; without edges, the gaps between coordinates."""
    lengths = [extent([positions[source], positions[target]]) for source, target in edges]
    axes = [sorted({point[axis] for point in positions.values()}) for axis in (0, 1)]
    gaps = [after - before for axis in axes for before, after in pairwise(axis)]
    return sorted(lengths or gaps or [1])


def extent(points: Iterable[Point]) -> int:
    """The longer side of the rectangle around the points."""
    return max((max(axis) - min(axis) for axis in zip(*points, strict=True)), default=0)


def computed_points(graph: ResourceGraph) -> Points:
    """Lay out each connected part by springs and pack the parts in rows, the largest first."""
    from networkx import Graph, connected_components  # noqa: PLC0415 - slow to load, and few pictures need it

    drawn: Graph[ResourceId] = Graph()
    drawn.add_nodes_from(each.id for each in graph.resources)
    drawn.add_edges_from(graph.edges)
    parts = [sorted(part, key=graph.index.__getitem__) for part in connected_components(drawn)]
    parts.sort(key=lambda part: (-len(part), graph.index[part[0]]))
    return packed(
        [sprung(drawn, part) if FEWEST_SPRUNG <= len(part) <= MOST_SPRUNG else in_rows(part) for part in parts]
    )


def sprung(drawn: "Graph[ResourceId]", part: Sequence[ResourceId]) -> Points:
    """A connected part as springs between its resources hold it, from a spectral start, so that it is unfolded."""
    from networkx import Graph, spectral_layout, spring_layout  # noqa: PLC0415 - as above

    graph: Graph[ResourceId] = Graph()
    graph.add_nodes_from(part)
    graph.add_edges_from((one, two) for one in part for two in drawn[one])
    start = spectral_layout(graph)
    spread = spring_layout(graph, pos=start, seed=0, iterations=ITERATIONS, method="force")
    rough = {id: (round(x * 2**20), round(y * 2**20)) for id, (x, y) in spread.items()}
    spacing = max(1, median_low(edge_lengths(rough, graph.edges)))
    return apart({id: (x * SPRING // spacing, y * SPRING // spacing) for id, (x, y) in rough.items()})


def apart(points: Points) -> Points:
    """Push resources that overlap away from each other, a few times over, along the axis that needs less of it."""
    moved = {id: list(point) for id, point in points.items()}
    for _ in range(PUSHES):
        done = True
        for one, two in combinations(moved.values(), 2):
            far = [two[0] - one[0], two[1] - one[1]]
            axis = 0 if abs(far[0]) >= abs(far[1]) else 1
            push = (UNIT - abs(far[axis]) + 1) // 2
            if push > 0:
                one[axis] -= push if far[axis] >= 0 else -push
                two[axis] += push if far[axis] >= 0 else -push
                done = False
        if done:
            break
    return {id: (x, y) for id, (x, y) in moved.items()}


def in_rows(part: Sequence[ResourceId]) -> Points:
    """A part that is too large for springs: row by row, in the instance's order."""
    columns = isqrt(len(part) - 1) + 1
    return {id: (number % columns * UNIT, number // columns * UNIT) for number, id in enumerate(part)}


def packed(parts: Sequence[Points], times: int = 1) -> Points:
    """Put the parts beside each other, in rows about as wide as the drawing is high, or so many times wider."""
    sides = [extent(part.values()) + 2 * UNIT for part in parts]
    widest = max([*sides, times * isqrt(sum(side * side for side in sides))], default=0)
    points: dict[ResourceId, Point] = {}
    left = top = height = 0
    for part, side in zip(parts, sides, strict=True):
        if left and left + side > widest:
            left, top, height = 0, top + height, 0
        corner = (min(x for x, _ in part.values()), min(y for _, y in part.values()))
        points.update({id: (x - corner[0] + left, y - corner[1] + top) for id, (x, y) in part.items()})
        left, height = left + side, max(height, side)
    return points
