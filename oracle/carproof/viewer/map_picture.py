"""The map: resources and moves, and above them the robots and the violations of a tick."""

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from xml.etree.ElementTree import Element, SubElement

from carp_spec import ResourceGraph
from carproof.viewer.colours import of
from carproof.viewer.lanes import SIDE, STRIP
from carproof.viewer.legend import Entry, write_legend
from carproof.viewer.names import fitted
from carproof.viewer.placement import MARGIN, UNIT, Point
from carproof.viewer.scene import Broken, Place, Scene, Stand, Track
from carproof.viewer.shapes import box, circle, drawing, group, hatch_definition, head, line, path, text

MOST_TRAITS = 2_000
NAME_LENGTH = 10
NAME_SIZES = (5, 7)
NAME_WIDTH = 50
"""The length of a name times its size, at most, so that it fits into a resource."""
TRAITS_SIZE = 6
SMALLEST_NAMED_MARK = 4
SIZE_OF_LENGTH = (0, 13, 11, 8, 6)
"""The size of a robot's name, by its length, in a circle of a radius of ten."""
SIZE_OF_MARK = (0, 12, 10, 7, 5)
ROBOT_RADIUS = 10
HEAD = 9
HALF = SIDE // 2
SPARSEST = 4
"""A grid has at most this many squares for each resource."""


def map_picture(graph: ResourceGraph, scene: Scene) -> Element:
    """All that stays: resources, moves, names."""
    picture = drawing(scene.width, scene.height, "map")
    hatch_definition(picture)
    ground = group(picture, "ground")
    ways = edge_ends(graph, scene)
    one_way = [(source, target) for source, target, back in ways if not back]
    located = [(place, place.at) for place in scene.places if place.at is not None]
    square = "cell"
    if is_grid(ways, scene):
        square = "square"
        path(ground, "wall", [box(0, 0, scene.width, scene.height)])
        path(ground, "joint", joints(ways))
    else:
        path(ground, "edge thin" if scene.computed else "edge", (line([one, two]) for one, two, back in ways if back))
    path(ground, "one-way", (line(ends) for ends in one_way))
    path(ground, square, (cell(at) for place, at in located if place.capacity == "1"))
    path(ground, "cell roomy", (cell(at) for place, at in located if place.capacity != "1"))
    path(ground, "one-way head", (arrow_head(*ends) for ends in one_way))
    write_names(ground, located, is_named=scene.named)
    return picture


def edge_ends(graph: ResourceGraph, scene: Scene) -> list[tuple[Point, Point, bool]]:
    """The edges as pairs of points, each pair of opposite moves once, and whether both moves are there."""
    points = [place.at for place in scene.places]
    found: list[tuple[Point, Point, bool]] = []
    moves = set(graph.edges)
    for source, target in graph.edges:
        back = not graph.directed or (target, source) in moves
        again = graph.directed and back and graph.index[source] > graph.index[target]
        one, two = points[graph.index[source]], points[graph.index[target]]
        if not again and one is not None and two is not None:
            found.append((one, two, back))
    return found


def is_grid(ways: Sequence[tuple[Point, Point, bool]], scene: Scene) -> bool:
    """Whether the resources are squares of a grid that fill much of it, so that all between them can be a wall."""
    located = [place.at for place in scene.places if place.at is not None]
    return (
        not scene.computed
        and scene.width * scene.height <= SPARSEST * len(located) * UNIT * UNIT
        and all((x - MARGIN) % UNIT == 0 and (y - MARGIN) % UNIT == 0 for x, y in located)
        and all(abs(one[0] - two[0]) + abs(one[1] - two[1]) == UNIT for one, two, _ in ways)
    )


def joints(ways: Sequence[tuple[Point, Point, bool]]) -> Iterator[str]:
    """Path data of the floor between squares that are joined, and between four that are joined in a ring."""
    joined = {(min(one, two), max(one, two)) for one, two, _ in ways}
    for (x, y), (end_x, end_y) in sorted(joined):
        if end_y == y:
            yield box(x + HALF, y - HALF, UNIT - SIDE, SIDE)
            below, beside = (x, y + UNIT), (end_x, y + UNIT)
            if {((x, y), below), ((end_x, y), beside), (below, beside)} <= joined:
                yield box(x + HALF, y + HALF, UNIT - SIDE, UNIT - SIDE)
        else:
            yield box(x - HALF, y + HALF, SIDE, UNIT - SIDE)


def cell(centre: Point) -> str:
    """Path data of a resource."""
    return box(centre[0] - HALF, centre[1] - HALF, SIDE, SIDE)


def arrow_head(source: Point, target: Point) -> str:
    """Path data of the head of an arrow, just outside the resource that it points to."""
    dx, dy = target[0] - source[0], target[1] - source[1]
    reach = max(abs(dx), abs(dy), 1)
    return head((target[0] - dx * HALF // reach, target[1] - dy * HALF // reach), (dx, dy), HEAD)


def write_names(ground: Element, located: Sequence[tuple[Place, Point]], *, is_named: bool) -> None:
    """Write the resources' names, if there are few, and capacities and durations that are not one."""
    if is_named:
        names = fitted([place.name for place, _ in located], NAME_LENGTH)
        for (_, (x, y)), name in zip(located, names, strict=True):
            size = max(NAME_SIZES[0], min(NAME_SIZES[1], NAME_WIDTH // max(1, len(name))))
            text(ground, "name", (x - HALF + 2, y - HALF + STRIP // 2 + 1), name, size)
    traits = [(place_traits(place), at) for place, at in located]
    if sum(bool(each) for each, _ in traits) <= MOST_TRAITS:
        for each, (x, y) in traits:
            if each:
                text(ground, "traits", (x + HALF - 2, y + HALF - STRIP // 2), each, TRAITS_SIZE)


def place_traits(place: Place) -> str:
    """Room and duration as the map shows them: 2x for a capacity of two, 3t for three ticks."""
    room = "" if place.capacity == "1" else f"{place.capacity}x"
    ticks = "" if place.duration == "1" else f"{place.duration}t"
    return " ".join(each for each in (room, ticks) if each)


def write_marks(picture: Element, scene: Scene, stood: AbstractSet[int]) -> None:
    """Draw the starts as rings and the goals as squares, each with its robot's name where there is room.

    No name is written in the places in which robots stand.
    """
    drawn = group(picture, "goals")
    for track in scene.tracks:
        hue = scene.looks[track.look].hue
        for mark, kind, place in ((track.start_mark, "start", track.start), (track.goal_mark, "goal", track.goal)):
            if mark is None:
                continue
            if kind == "goal":
                path(
                    drawn, kind, [box(mark.x - mark.half, mark.y - mark.half, 2 * mark.half, 2 * mark.half)], stroke=hue
                )
            else:
                circle(drawn, kind, (mark.x, mark.y), mark.half, stroke=hue)
            if mark.half >= SMALLEST_NAMED_MARK and place not in stood:
                text(drawn, "goal-of", (mark.x, mark.y), track.short, mark.half * SIZE_OF_MARK[length(track)] // 10)


def length(track: Track) -> int:
    """The length of a robot's name on the map, as far as it matters."""
    return min(len(track.short), len(SIZE_OF_LENGTH) - 1)


def robot_picture(robots: Element, track: Track, scene: Scene, *, is_blamed: bool) -> Element:
    """A robot at the origin, of a radius of ten; the caller moves and scales it."""
    look = scene.looks[track.look]
    edge = {"stroke": of("wrong"), "stroke-width": "3"} if is_blamed else {}
    kind = "robot blamed" if is_blamed else "robot"
    robot = group(robots, kind, **{"fill": look.fill, "stroke": look.edge, "stroke-width": f"{look.width}", **edge})
    SubElement(robot, "title").text = track.label
    circle(robot, "body", (0, 0), ROBOT_RADIUS)
    text(robot, "short", (0, 0), track.short, SIZE_OF_LENGTH[length(track)], fill=look.text)
    return robot


def standing(track: Track, scene: Scene, tick: int) -> Stand | None:
    """The robot's stand at the tick; if a broken plan has several, that of the last visit."""
    for stand, enter, leave in reversed(track.stays):
        if enter <= tick and (leave is None or tick < leave):
            return scene.stands[stand]
    return None


def violations_at(scene: Scene, tick: int) -> Iterator[Broken]:
    """The violations that hold at the tick; one that takes no time is shown for one tick."""
    for each in scene.violations:
        if each.start is not None and each.start <= tick and (each.end is None or tick < max(each.end, each.start + 1)):
            yield each


def still_map(graph: ResourceGraph, scene: Scene, tick: int) -> Element:
    """The map at a tick, with its violations."""
    picture = map_picture(graph, scene)
    stood = {number: standing(track, scene, tick) for number, track in enumerate(scene.tracks)}
    write_marks(picture, scene, {stand.place for stand in stood.values() if stand is not None})
    wrong = list(violations_at(scene, tick))
    write_legend(picture, entries(scene, is_broken=bool(wrong)))
    marks, robots = group(picture, "marks"), group(picture, "robots")
    for place in dict.fromkeys(place for each in wrong for place in each.places):
        centre = scene.places[place].at
        if centre is not None:
            path(marks, "violation", [cell(centre)])
    blamed = {track for each in wrong for track in each.tracks}
    for number, track in enumerate(scene.tracks):
        stand = stood[number]
        if stand is not None and stand.at is not None:
            robot = robot_picture(robots, track, scene, is_blamed=number in blamed)
            robot.set(
                "transform", f"translate({stand.at[0]} {stand.at[1]}) scale({stand.radius * 100 // ROBOT_RADIUS}e-2)"
            )
    return picture


def entries(scene: Scene, *, is_broken: bool) -> Iterator[Entry]:
    """The legend of a still map."""
    if not scene.alone:
        yield "robot", "robot"
    if scene.tracks:
        yield "start", "start"
        yield "goal", "goal"
    if is_broken:
        yield "violation", "broken rule"
    traits = [place_traits(place) for place in scene.places if place.at is not None]
    if any("x" in each for each in traits):
        yield "", "2x: room for two"
    if any("t" in each for each in traits):
        yield "", "3t: takes three ticks"
    if scene.named and scene.start:
        yield "", f"names without {scene.start}"
