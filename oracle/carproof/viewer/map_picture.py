"""The map: resources and moves, and above them the robots and the violations of a tick."""

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from math import isqrt
from xml.etree.ElementTree import Element, SubElement

from carp_spec import ResourceGraph
from carproof.viewer.colours import of
from carproof.viewer.lanes import SIDE, STRIP
from carproof.viewer.legend import Entry, write_legend
from carproof.viewer.names import fitted
from carproof.viewer.placement import MARGIN, UNIT
from carproof.viewer.plants import Point
from carproof.viewer.scene import Broken, Mark, Place, Scene, Track
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
NOSE, NOSE_LENGTH = 15, 7
SERVING = 14
PLANT_NAME_SIZE = 9
MOST_NAMED_GROUPS = 60
HALF = SIDE // 2
SPARSEST = 4
"""A grid has at most this many squares for each resource."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a robot is drawn: its place by number, its centre, radius and heading, and whether it serves a stop."""

    place: int
    at: Point
    radius: int
    heading: Point | None
    serves: bool


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
    draw_outlines(ground, scene)
    path(ground, "one-way", (line(ends) for ends in one_way))
    lanes = [(place.way, place.capacity == "1") for place in scene.places if place.way]
    cells = [(at, place.capacity == "1") for place, at in located if not place.way]
    path(ground, "lane", (line(ends) for ends, is_for_one in lanes if is_for_one))
    path(ground, "lane roomy", (line(ends) for ends, is_for_one in lanes if not is_for_one))
    path(ground, square, (cell(at) for at, is_for_one in cells if is_for_one))
    path(ground, "cell roomy", (cell(at) for at, is_for_one in cells if not is_for_one))
    path(ground, "one-way head", (arrow_head(*ends) for ends in one_way))
    path(ground, "lane head", (head(end, way(begin, end), HEAD) for (begin, end), _ in lanes))
    write_names(ground, located, is_named=scene.named)
    return picture


def way(one: Point, other: Point) -> Point:
    """The way from one point to another."""
    return other[0] - one[0], other[1] - one[1]


def draw_outlines(ground: Element, scene: Scene) -> None:
    """Outline the groups, with their names if there are few."""
    for each in scene.outlines:
        path(ground, "group", [line(each.corners) + "z"])
    for each in scene.outlines if len(scene.outlines) <= MOST_NAMED_GROUPS else ():
        left, top = min(each.corners, key=lambda corner: (corner[1], corner[0]))
        text(ground, "group-name", (left, top - 4), each.label, TRAITS_SIZE)


def edge_ends(graph: ResourceGraph, scene: Scene) -> list[tuple[Point, Point, bool]]:
    """The edges as pairs of points, each pair of opposite moves once, and whether both moves are there."""
    points = [place.at for place in scene.places]
    found: list[tuple[Point, Point, bool]] = []
    moves = set(graph.edges)
    for source, target in graph.edges:
        back = not graph.directed or (target, source) in moves
        again = graph.directed and back and graph.index[source] > graph.index[target]
        one, two = points[graph.index[source]], points[graph.index[target]]
        is_of_lane = any(scene.places[graph.index[end]].way for end in (source, target))
        if not again and one is not None and two is not None and not is_of_lane:
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
    is_plant = any(place.way for place, _ in located)
    points = [each for each in located if not each[0].way] if is_named else []
    names = fitted([place.name for place, _ in points], NAME_LENGTH * (1 + is_plant))
    for (_, (x, y)), name in zip(points, names, strict=True):
        if is_plant:
            text(ground, "point-name", (x, y - HALF - PLANT_NAME_SIZE // 2), name, PLANT_NAME_SIZE)
        else:
            size = max(NAME_SIZES[0], min(NAME_SIZES[1], NAME_WIDTH // max(1, len(name))))
            text(ground, "name", (x - HALF + 2, y - HALF + STRIP // 2 + 1), name, size)
    traits = [(place_traits(place), at, place.way is not None) for place, at in located if place_traits(place)]
    for each, (x, y), is_lane in traits if len(traits) <= MOST_TRAITS else ():
        if is_lane:
            text(ground, "lane-traits", (x, y), each, TRAITS_SIZE + 1)
        else:
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
        path(drawn, "stop", (diamond(mark) for mark in track.stop_marks), stroke=hue)
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


def diamond(mark: Mark) -> str:
    """Path data of the mark of a stop before the goal."""
    x, y, half = mark.x, mark.y, mark.half
    return line([(x, y - half), (x + half, y), (x, y + half), (x - half, y)]) + "z"


def length(track: Track) -> int:
    """The length of a robot's name on the map, as far as it matters."""
    return min(len(track.short), len(SIZE_OF_LENGTH) - 1)


def robot_picture(robots: Element, track: Track, scene: Scene, pose: Pose, *, is_blamed: bool) -> None:
    """A robot, with its heading if it is on a lane or came by one, and a ring while it serves a stop."""
    look = scene.looks[track.look]
    edge = {"stroke": of("wrong"), "stroke-width": "3"} if is_blamed else {}
    kind = "robot blamed" if is_blamed else "robot"
    robot = group(robots, kind, **{"fill": look.fill, "stroke": look.edge, "stroke-width": f"{look.width}", **edge})
    SubElement(robot, "title").text = track.label
    if pose.heading is not None:
        dx, dy = pose.heading
        far = max(1, isqrt(dx * dx + dy * dy))
        path(robot, "nose", [head((dx * NOSE // far, dy * NOSE // far), pose.heading, NOSE_LENGTH)])
    if pose.serves:
        circle(robot, "serving", (0, 0), SERVING)
    circle(robot, "body", (0, 0), ROBOT_RADIUS)
    text(robot, "short", (0, 0), track.short, SIZE_OF_LENGTH[length(track)], fill=look.text)
    x, y = pose.at
    robot.set("transform", f"translate({x} {y}) scale({pose.radius * 100 // ROBOT_RADIUS}e-2)")


def pose_of(track: Track, scene: Scene, tick: int) -> Pose | None:
    """The robot's pose at the tick; if a broken plan has it in several places, that of the last visit."""
    for number in reversed(range(len(track.stays))):
        at_stand, enter, leave = track.stays[number]
        stand = scene.stands[at_stand]
        if enter <= tick and (leave is None or tick < leave):
            if stand.at is None:
                return None
            serves = any(start <= tick < end for start, end in track.services)
            here = scene.places[stand.place].way
            if here is not None:
                (x, y), (end_x, end_y) = here
                done, all_ticks = (1, 2) if leave is None else (tick - enter, leave - enter)
                at = (x + (end_x - x) * done // all_ticks, y + (end_y - y) * done // all_ticks)
                return Pose(stand.place, at, stand.radius, way(*here), serves)
            before = scene.places[scene.stands[track.stays[number - 1][0]].place].way if number else None
            heading = None if before is None else way(*before)
            return Pose(stand.place, stand.at, stand.radius, heading, serves)
    return None


def violations_at(scene: Scene, tick: int) -> Iterator[Broken]:
    """The violations that hold at the tick; one that takes no time is shown for one tick."""
    for each in scene.violations:
        if each.start is not None and each.start <= tick and (each.end is None or tick < max(each.end, each.start + 1)):
            yield each


def still_map(graph: ResourceGraph, scene: Scene, tick: int) -> Element:
    """The map at a tick, with its violations."""
    picture = map_picture(graph, scene)
    poses = {number: pose_of(track, scene, tick) for number, track in enumerate(scene.tracks)}
    write_marks(picture, scene, {pose.place for pose in poses.values() if pose is not None})
    wrong = list(violations_at(scene, tick))
    write_legend(picture, entries(scene, is_broken=bool(wrong)))
    marks, robots = group(picture, "marks"), group(picture, "robots")
    for place in dict.fromkeys(place for each in wrong for place in each.places):
        centre = scene.places[place].at
        if centre is not None:
            path(marks, "violation", [cell(centre)])
    blamed = {track for each in wrong for track in each.tracks}
    for number, track in enumerate(scene.tracks):
        pose = poses[number]
        if pose is not None:
            robot_picture(robots, track, scene, pose, is_blamed=number in blamed)
    return picture


def entries(scene: Scene, *, is_broken: bool) -> Iterator[Entry]:
    """The legend of a still map."""
    if not scene.alone:
        yield "robot", "robot"
    if scene.tracks:
        yield "start", "start"
        yield "goal", "goal"
    if any(track.stop_marks for track in scene.tracks):
        yield "stop", "stop"
    if scene.outlines:
        yield "group", "group"
    if any(track.services for track in scene.tracks):
        yield "serving", "serves a stop"
    if is_broken:
        yield "violation", "broken rule"
    traits = [place_traits(place) for place in scene.places if place.at is not None]
    if any("x" in each for each in traits):
        yield "", "2x: room for two"
    if any("t" in each for each in traits):
        yield "", "3t: takes three ticks"
    if scene.named and scene.start:
        yield "", f"names without {scene.start}"
