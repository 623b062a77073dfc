"""Makes an instance of a layout: points and lanes become resources, strips and blocks become groups.

A point takes a tick. A lane takes its length by the speed, in ticks, rounded up. Positions are in mm; a lane is at the
middle of its ends.
"""

from collections.abc import Iterator
from fractions import Fraction

from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.inputs.values import require_instance
from carp_spec.model import Group
from carproof.csv_rows import rows_of
from carproof.generate import Fleet
from carproof.generate.fleet import random_robots
from carproof.generate.options import ends_suffice, refuse_wrong_options
from carproof.layouts.footprint import conflicts
from carproof.layouts.layout import Lane, Layout, Point
from carproof.layouts.settings import RIGHT_SETTINGS, Settings
from carproof.layouts.turning import with_headings

DEFAULT_SPEED = Fraction(1000)
COLUMNS = ("robot", "start", "goal")
"""Of requests."""


def instance_of(layout: Layout, settings: Settings) -> Instance:
    """Make the instance; raises `Refusal` where the robots do not fit the layout."""
    if not layout.points:
        raise layout.tree.refuse("the layout must have at least one point that a lane joins to another")
    points = [Resource(each.id, 1, 1, each.x, each.y) for each in layout.points.values()]
    lanes = [_resource(each, layout, settings) for each in layout.lanes.values()]
    edges = tuple(move for each in layout.lanes.values() for move in ((each.source, each.id), (each.id, each.target)))
    graph = ResourceGraph((*points, *lanes), edges, directed=True, groups=tuple(_groups(layout, settings)))
    instance = Instance(graph, _robots(layout, graph, settings), settings.after_goal)
    if settings.turning is not None:
        instance = with_headings(layout, instance, -int(-settings.turning / settings.tick // 1))
    require_instance(instance)
    return instance


def _resource(lane: Lane, layout: Layout, settings: Settings) -> Resource:
    limits = [each for each in (lane.speed, settings.speed) if each is not None]
    fast = lane.share * min(limits, default=DEFAULT_SPEED)
    duration = 1 if lane.length is None else max(1, -int(-lane.length / (fast * settings.tick) // 1))
    one, two = layout.points[lane.source], layout.points[lane.target]
    return Resource(lane.id, 1, duration, _middle(one.x, two.x), _middle(one.y, two.y))


def _middle(one: int | None, two: int | None) -> int | None:
    return None if one is None or two is None else (one + two) // 2


def _groups(layout: Layout, settings: Settings) -> Iterator[Group]:
    """The strips with two lanes, points at one place, the ends that vehicles on lanes hold, blocks, and footprints."""
    strips: dict[object, list[str]] = {}
    at: dict[str, list[str]] = {each: [each] for each in layout.points}
    for lane in layout.lanes.values():
        for strip in lane.strips:
            strips.setdefault(strip, []).append(lane.id)
        at[lane.source].append(lane.id)
        if lane.target != lane.source:
            at[lane.target].append(lane.id)
    taken = set(layout.blocks)

    def named(name: str) -> str:
        while name in taken:
            name += "'"
        taken.add(name)
        return name

    if layout.holds_ends:
        yield from (Group(named(f"at {point}"), tuple(held)) for point, held in at.items() if len(held) > 1)
    shared = dict.fromkeys(tuple(lanes) for lanes in strips.values() if len(lanes) > 1)
    yield from (Group(named(f"strip {lanes[0]}"), lanes) for lanes in shared)
    yield from (Group(named(f"place {name}"), held) for name, held in _at_one_place(layout) if len(held) > 1)
    yield from (Group(each.id, each.members) for each in layout.blocks.values())
    if settings.footprint is not None:
        for each in conflicts(layout, settings.footprint):
            yield Group(named(str(each.id)), each.resources)


def _at_one_place(layout: Layout) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The points at each place, with the lanes that stay there."""
    held: dict[str, list[str]] = {}
    for point, place in layout.places.items():
        held.setdefault(place, []).append(point)
    for lane in layout.lanes.values():
        here = layout.places.get(lane.source)
        if here is not None and here == layout.places.get(lane.target):
            held[here].append(lane.id)
    return ((place, tuple(members)) for place, members in held.items())


def _robots(layout: Layout, graph: ResourceGraph, settings: Settings) -> tuple[Robot, ...]:
    if settings.requests is not None:
        return tuple(_requested(layout, settings.requests, settings.requests_file))
    if settings.robots is None:
        return _vehicles(layout, graph, settings)
    fleet = Fleet(settings.robots, settings.seed, settings.after_goal)
    refuse_wrong_options(fleet=(fleet, Fleet))
    places = [each.id for each in _standing(layout, graph)]
    _require_room(places, fleet.robots, "robots")
    return random_robots(fleet, places, places)


def _require_room(places: list[str], robots: int, what: str) -> None:
    """Refuse more robots than there are points for them."""
    if not ends_suffice(len(places), robots):
        message = (
            f"{robots} {what} need as many points where vehicles may stand together and which all reach each other, "
            f"and the layout has {len(places)}"
        )
        raise Refusal("option", "$.robots", ends_suffice.id, message)


def _standing(layout: Layout, graph: ResourceGraph) -> list[Point]:
    """The points where vehicles may stand together, of the largest part of the layout where each is reached from each.

    Of points in one group as many as its capacity, the first ones.
    """
    import networkx as nx  # noqa: PLC0415 - slow to load

    moves: nx.DiGraph[object] = nx.DiGraph(list(graph.edges))
    moves.add_nodes_from(layout.points)
    stands = [each for each in layout.points.values() if each.stands]
    parts = [[each for each in stands if each.id in part] for part in nx.strongly_connected_components(moves)]
    largest = max(parts, key=lambda part: (len(part), [each.id for each in part]), default=[])
    room = [each.capacity for each in graph.constraints]
    together = []
    for point in largest:
        places = graph.constraints_of(point.id)
        if all(room[place] > 0 for place in places):
            together.append(point)
            for place in places:
                room[place] -= 1
    return together


def _vehicles(layout: Layout, graph: ResourceGraph, settings: Settings) -> tuple[Robot, ...]:
    """The vehicles of the file; who has no goal gets one of the seed."""
    without = [each for each in layout.vehicles.values() if each.goal is None]
    goals: dict[str, str] = {}
    if without:
        taken = {each.goal for each in layout.vehicles.values()}
        places = [each.id for each in _standing(layout, graph) if each.id not in taken]
        _require_room(places, len(without), "vehicles without goals")
        drawn = random_robots(Fleet(len(without), settings.seed, settings.after_goal), places, places)
        goals = {each.id: str(robot.goal) for each, robot in zip(without, drawn, strict=True)}
    return tuple(Robot(each.id, each.start, each.goal or goals[each.id]) for each in layout.vehicles.values())


def _requested(layout: Layout, data: bytes, file: str) -> Iterator[Robot]:
    seen: set[str] = set()
    for line, row in rows_of(RIGHT_SETTINGS.text(data, file), file, RIGHT_SETTINGS, COLUMNS, ("release",)):
        where = f"{file}:{line}"
        if row["robot"] in seen:
            raise RIGHT_SETTINGS.refuse(where, f"the robot {row['robot']!r} must be given once")
        seen.add(row["robot"])
        for name in ("start", "goal"):
            if row[name] not in layout.points:
                raise RIGHT_SETTINGS.refuse(where, f"the {name} must be a point of the layout, not {row[name]!r}")
        release = row.get("release") or "0"
        if not (release.isascii() and release.isdigit() and len(release) < 10):  # noqa: PLR2004 - below 2^30
            raise RIGHT_SETTINGS.refuse(where, f"the release must be a whole number, not {release!r}")
        yield Robot(row["robot"], row["start"], row["goal"], int(release))
