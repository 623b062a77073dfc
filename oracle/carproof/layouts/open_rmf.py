"""Maps of Open-RMF: buildings as the traffic editor saves them, and navigation graphs as fleet adapters read them.

Fields: `rmf_building_map_tools/building_map` of open-rmf/rmf_traffic_editor for buildings, `parse_graph.cpp` of
open-rmf/rmf_ros2 for graphs. A building has positions in pixels of its drawing, with y downwards; the scale is the mean
over the measurements of a level of distance by length, in m for each pixel. Positions in degrees (`wgs84`) become those
on the ground east and north of the first vertex, by the lengths of a degree there. Mutexes name lanes and vertices in
which one robot may be at a time.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from functools import partial
from math import isqrt

from carproof.layouts.layout import PLANE, Layout, Reader
from carproof.layouts.located import METRE, Tree

FINE = 10**9
"""Steps of a pixel to which the lengths of measurements are known."""
AXIS = 6_378_137_000
"""Half the major axis of the ellipsoid WGS 84, in mm."""
FLATNESS = Decimal("0.00669437999014")
"""The square of its eccentricity."""
RADIAN = Decimal("3.14159265358979323846") / 180
STANDS = ("is_parking_spot", "is_charger", "is_holding_point")
OF_LANES = {"bidirectional", "is_bidirectional", "graph_idx", "mutex", "speed_limit"}
OF_VERTICES = {"name", "spawn_robot_name", "mutex", "lift", "lift_cabin", *STANDS}
LEFT_OUT = {
    "door_name": "doors",
    "orientation": "orientations of robots on lanes",
    "orientation_constraint": "orientations of robots on lanes",
    "dock_name": "docks",
    "undock_name": "docks",
    "demo_mock_floor_name": "lifts that lanes stand for",
    "demo_mock_lift_name": "lifts that lanes stand for",
}
LEFT_OUT_AT_VERTICES = {
    "dock_name": "docks",
    "is_passthrough_point": "points that robots only pass through; here they may wait there",
    "is_cleaning_zone": "zones to be cleaned",
    "spawn_robot_type": "types of robots",
    "pickup_dispenser": "dispensers and ingestors",
    "dropoff_ingestor": "dispensers and ingestors",
}


SILENT = {
    *("name", "building_name", "reference_level_name", "graphs", "parameters", "crowd_sim"),
    *("walls", "floors", "drawing", "models", "layers", "fiducials", "features", "constraints", "physical_cameras"),
    *("elevation", "x_meters", "y_meters", "flattened_x_offset", "flattened_y_offset", "measurements"),
}
"""Fields of buildings and levels that say nothing of where robots may go."""


Groups = dict[str, list[tuple[Tree, str]]]
Place = tuple[Fraction, Fraction]
Onto = Callable[[Fraction, Fraction], Place]


def _looks_like(tree: Tree) -> bool:
    return tree.get("levels") is not None


def read(tree: Tree) -> Layout:
    """Read a building or a navigation graph."""
    levels = tree["levels"].fields
    system = tree.get("coordinate_system")
    if system is not None and system.value not in ("reference_image", "cartesian_meters", "wgs84"):
        message = f"the coordinate system must be reference_image, cartesian_meters or wgs84, not {system.shown}"
        raise system.refuse(message)
    is_drawn = tree.get("building_name") is None and (system is None or system.value == "reference_image")
    layout, groups = Layout(tree), Groups()
    onto: Onto = _in_metres if system is None or system.value != "wgs84" else _around(levels.values())
    scale = Fraction(0)
    for name, level in levels.items():
        if is_drawn:
            scale = _scale(layout, level, scale)
            onto = partial(_drawn, scale)
        ids = _vertices(layout, level, onto, name if len(levels) > 1 else None)
        for lane in level.all("lanes"):
            _lane(layout, lane, ids, groups)
        for (vertex, options), id in zip(_options(level), ids, strict=True):
            for kind, field in (("mutex", "mutex"), ("lift", "lift"), ("lift", "lift_cabin")):
                _add(groups, kind, options.get(field), vertex, id)
        layout.note("doors", level.get("doors"))
    _remove_unused(layout, {end for lane in layout.lanes.values() for end in (lane.source, lane.target)})
    if len(levels) > 1:
        layout.note(
            f"the alignment of levels by fiducials; each level keeps its own positions, and {PLANE}", tree["levels"]
        )
    for group, members in groups.items():
        there = [(at, each) for at, each in members if each in layout.points or each in layout.lanes]
        if there:
            layout.block(there[0][0], group, there)
    layout.note("lifts between levels; a cabin holds one robot, on all levels together", tree.get("lifts"))
    return layout


def _add(groups: Groups, kind: str, named: Tree | None, at: Tree, *members: str) -> None:
    """Add members to the group that is named, if any."""
    name = _plain(named)
    if name is not None and name.value:
        groups.setdefault(f"{kind} {name.text}", []).extend((at, each) for each in members)


def _plain(value: Tree | None) -> Tree | None:
    """The value of a parameter; a building writes it behind the number of its type."""
    if value is not None and isinstance(value.value, list):
        return value.first(2, "a parameter must be a type and a value", most=2)[1]
    return value


def _scale(layout: Layout, level: Tree, before: Fraction) -> Fraction:
    """The mm of a pixel."""
    places = [_place(vertex) for vertex in level.all("vertices")]
    found = []
    for each in level.all("measurements"):
        one, two = (places[end] for end in _ends(each, len(places)))
        square = (one[0] - two[0]) ** 2 + (one[1] - two[1]) ** 2
        distance = _plain(each.entries[2].get("distance")) if len(each.entries) > 2 else None  # noqa: PLR2004
        if distance is None or not square:
            raise each.refuse("a measurement must have two places and a distance")
        found.append(distance.positive * METRE * FINE / isqrt(int(square * FINE**2)))
    if found:
        return sum(found, Fraction(0)) / len(found)
    layout.note("the scale of a level without measurements; it is that of the level before, or 1 m a pixel", level)
    return before or Fraction(METRE)


def _place(vertex: Tree) -> Place:
    x, y = vertex.first(2, "a vertex must have x and y")
    return x.number, y.number


def _ends(thing: Tree, count: int) -> Iterator[int]:
    """The numbers of the vertices at both ends, of so many."""
    for end in thing.first(2, "it must have two ends"):
        if (index := end.whole) >= count:
            raise end.refuse(f"it must be one of the {count} vertices of the level, counted from 0, not {index}")
        yield index


def _options(level: Tree) -> list[tuple[Tree, Mapping[str, Tree]]]:
    """The vertices, each with its parameters."""
    return [
        (each, each.entries[-1].fields if isinstance(each.entries[-1].value, dict) else {})
        for each in level.all("vertices")
        if each.entries
    ]


def _in_metres(x: Fraction, y: Fraction) -> Place:
    """Of metres, with y upwards."""
    return METRE * x, METRE * y


def _drawn(scale: Fraction, x: Fraction, y: Fraction) -> Place:
    """Of pixels, with y downwards."""
    return x * scale, -y * scale


def _around(levels: Iterable[Tree]) -> Onto:
    """Of degrees of longitude and latitude, by the lengths of a degree at the first vertex."""
    first = next((vertex for level in levels for vertex in level.all("vertices")), None)
    if first is None:
        return _in_metres
    origin = _place(first)
    if abs(origin[1]) > 85:  # noqa: PLR2004 - as far as maps in Mercator's projection go
        raise first.refuse("the latitude must be between -85 and 85 degrees")
    with localcontext(Context(prec=30)):
        angle = Decimal(origin[1].numerator) / origin[1].denominator * RADIAN
        term = cosine = Decimal(1)
        for number in range(1, 40, 2):
            term *= -angle * angle / (number * (number + 1))
            cosine += term
        bend = 1 - FLATNESS * (1 - cosine * cosine)
        east = Fraction(AXIS * cosine / bend.sqrt() * RADIAN)
        north = Fraction(AXIS * (1 - FLATNESS) / (bend * bend.sqrt()) * RADIAN)
    return lambda x, y: ((x - origin[0]) * east, (y - origin[1]) * north)


def _vertices(layout: Layout, level: Tree, onto: Onto, floor: str | None) -> list[str]:
    """Add the vertices of a floor, if it is one of several, and return their ids: the name, or else the index."""
    ids: list[str] = []
    prefix = "" if floor is None else f"{floor}/"
    for number, (vertex, options) in enumerate(_options(level)):
        given = options.get("name")
        if given is None and len(vertex.entries) > 3:  # noqa: PLR2004 - x, y, z, name
            given = vertex.entries[3]
        name = "" if given is None or given.value is None else given.text
        id = f"{prefix}{name or number}"
        if id in layout.points:
            id = f"{prefix}{name} {number}"
        at = onto(*_place(vertex))
        flags = [_plain(options.get(each)) for each in STANDS]
        stands = bool(name) or any(each is not None and each.is_true for each in flags)
        layout.point(vertex, id, at, stands=stands, level=floor)
        _note_others(layout, options, OF_VERTICES, LEFT_OUT_AT_VERTICES)
        robot = _plain(options.get("spawn_robot_name"))
        if robot is not None and robot.value:
            layout.vehicle(vertex, robot.text, id)
        ids.append(id)
    return ids


def _lane(layout: Layout, lane: Tree, ids: list[str], groups: Groups) -> None:
    source, target = (ids[end] for end in _ends(lane, len(ids)))
    options = lane.entries[2].fields if len(lane.entries) > 2 else {}  # noqa: PLR2004 - both ends and parameters
    both = _plain(options.get("bidirectional") or options.get("is_bidirectional"))
    limit = _plain(options.get("speed_limit"))
    speed = None if limit is None or limit.number == 0 else METRE * limit.positive
    back = both is not None and both.is_true
    lanes = layout.lane(lane, None, (source, target), speed=speed, back=back)
    _note_others(layout, options, OF_LANES, LEFT_OUT)
    graph = _plain(options.get("graph_idx"))
    if graph is not None and graph.whole:
        layout.note("the fleets to which graphs of lanes belong; lanes of all graphs are open to all", lane)
    _add(groups, "mutex", options.get("mutex"), lane, *lanes)


def _note_others(layout: Layout, options: Mapping[str, Tree], known: set[str], features: Mapping[str, str]) -> None:
    """Note the parameters that are not known, but for those that are off."""
    for name, value in options.items():
        plain = _plain(value)
        if name not in known and plain is not None and plain.value not in ("false", "False"):
            layout.note(features.get(name, f"the field {name}"), plain)


def _remove_unused(layout: Layout, used: set[str]) -> None:
    """Vertices without lanes are corners of walls and floors, unless a robot is there."""
    used |= {each.start for each in layout.vehicles.values()}
    for name in [each for each in layout.points if each not in used]:
        del layout.points[name]


READER = Reader("open-rmf", "a building or navigation graph of Open-RMF, YAML", _looks_like, read, {}, SILENT)
