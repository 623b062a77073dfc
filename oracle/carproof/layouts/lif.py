"""The Layout Interchange Format (LIF) of VDMA, versions 1 and 2.

Fields: LIF.md of the repository Intralogistics-2X-LIF/Layout-Interchange-Format, section 8.3, in the branches
release/V1.0 and dev/V2. Positions and lengths are in m, speeds in m/s. An edge leads from its start to its end. Version
1.0 calls itself 0.11.0 in that section and in its examples. Version 2 has layouts within origins, and robot types in
place of vehicle types. Nodes of one map at one place are for different vehicles or actions there; an edge between them
is a turn on the spot (section 10.9).
"""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from math import ceil

from carproof.layouts.layout import PLANE, Layout, Reader, spot
from carproof.layouts.located import METRE, Tree
from carproof.layouts.strips import Spot, Track, length_of

NODES = ("vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties")
EDGES = ("vehicleTypeEdgeProperties", "mobileRobotTypeEdgeProperties")
TYPES = ("vehicleTypeId", "mobileRobotTypeId")
LEFT_OUT = {
    "actions": "actions of nodes and edges",
    "loadRestriction": "restrictions by load",
    "corridor": "corridors",
    "rotationAllowed": "rotation on edges",
    "rotationAtStartNodeAllowed": "directions of rotation at nodes",
    "rotationAtEndNodeAllowed": "directions of rotation at nodes",
    "reachOrientationBeforeEntering": "orientations on edges",
    "vehicleOrientation": "orientations on edges",
    "vehicleOrientations": "orientations on edges",
    "mobileRobotOrientations": "orientations on edges",
    "theta": "orientations at nodes",
    "maxRotationSpeed": "speeds of rotation; --turning sets one time for all",
    "maximumRotationSpeed": "speeds of rotation; --turning sets one time for all",
    "reentryAllowed": "edges on which vehicles may be taken over",
}
HEIGHTS = ("minHeight", "maxHeight", "minimumLoadHandlingDeviceHeight", "maximumMobileRobotHeight")
LEFT_OUT |= dict.fromkeys(HEIGHTS, "limits of height")
SILENT = {
    *("projectIdentification", "creator", "exportTimestamp", "lifVersion", "orientationType"),
    *(f"layout{each}" for each in ("Name", "Version", "Description", "LevelId")),
    *(f"{thing}{each}" for thing in ("node", "edge", "origin") for each in ("Name", "Description", "Descriptor")),
    *("originId", "mapId", "mapDescription", "degree", "knotVector", "weight"),
    *(f"station{each}" for each in ("Name", "Description", "Height", "Position")),
}
"""What says nothing of routes."""


def _looks_like(tree: Tree) -> bool:
    return tree.get("metaInformation") is not None


def read(tree: Tree) -> Layout:
    """Read all layouts of the file."""
    version = tree["metaInformation"]["lifVersion"]
    major, minor = (*version.quoted_text.split("."), "")[:2]
    if major not in ("1", "2") and (major, minor) != ("0", "11"):
        raise version.refuse(
            f"the version must be 1, 0.11 as in the document of version 1.0, or 2, not {version.shown}"
        )
    if major != "2":
        layouts = tree["layouts"].entries
    else:
        layouts = [each for origin in tree["origins"].entries for each in origin["layouts"].entries]
    layout = Layout(tree)
    stations = [station for each in layouts for station in each.all("stations")]
    _require_once(layouts, "layoutId")
    _require_once(stations, "stationId")
    served = {node.quoted_text for station in stations for node in station["interactionNodeIds"].entries}
    _nodes(layout, layouts, served)
    for station in stations:
        for node in station["interactionNodeIds"].entries:
            if node.quoted_text not in layout.points:
                raise node.refuse(f"the node {node.quoted_text!r} must be one of the layout")
        layout.note("stations; their nodes are where vehicles stand", station)
    edges = [edge for each in layouts for edge in each["edges"].entries]
    _require_once(edges, "edgeId")
    for edge in edges:
        _edge(layout, edge)
    _note_types(layout, edges)
    return layout


def _require_once(things: Sequence[Tree], field: str) -> None:
    """Raise `Refusal` where two things of a kind have one id."""
    seen: set[str] = set()
    for id in (each[field] for each in things):
        if id.quoted_text in seen:
            raise id.refuse(f"the {field} {id.shown} must be given once")
        seen.add(id.quoted_text)


def _note_types(layout: Layout, edges: Sequence[Tree]) -> None:
    """Note the edges that are not for all types of vehicles: those for which an edge has properties may use it."""
    allowed = [{each.get(*TYPES) for each in edge.all(*EDGES)} for edge in edges]
    names = [{None if type is None else type.value for type in types} for types in allowed]
    for edge, types in zip(edges, names, strict=True):
        if types and types != set().union(*names):
            layout.note("edges that are not for all types of vehicles; here they are", edge.get(*EDGES))


def _nodes(layout: Layout, layouts: Sequence[Tree], served: AbstractSet[str]) -> None:
    """Add the nodes, and find those that are at one place of one map."""
    first: dict[object, str] = {}
    main: str | None = None
    for node in (node for each in layouts for node in each["nodes"].entries):
        name, place, level = node["nodeId"].quoted_text, node["nodePosition"], node.get("mapId")
        at = (METRE * place["x"].number, METRE * place["y"].number)
        map = None if level is None else level.quoted_text
        layout.point(node, name, at, stands=not served or name in served, level=map)
        _types(layout, node, NODES)
        if main is not None and map not in (None, main):
            layout.note(f"maps beside the first; {PLANE}", level)
        main = map if main is None else main
        layout.places[name] = first.setdefault((map, layout.points[name].x, layout.points[name].y), name)


def _types(layout: Layout, thing: Tree, names: tuple[str, ...]) -> list[Tree]:
    """The properties of each type of vehicle."""
    types = thing.all(*names)
    if len(types) > 1:
        layout.note("differences between types of vehicles; lanes are open to all, at the lowest speed", types[1])
    for each in types:
        each.get(*TYPES)
    return types


def _edge(layout: Layout, edge: Tree) -> None:
    name, ends = edge["edgeId"].quoted_text, (edge["startNodeId"].quoted_text, edge["endNodeId"].quoted_text)
    layout.require_points(edge, *ends)
    distance = layout.distance(*ends) or 0
    types = _types(layout, edge, EDGES)
    speeds = [each.metres("maxSpeed", "maximumSpeed") for each in types]
    tracks = [_track(layout, each, distance) for each in types]
    stays = ends[0] != ends[1] and not distance
    if stays and layout.places[ends[0]] == layout.places[ends[1]]:
        layout.note(
            "turns on the spot, from node to node at one place; they take a tick unless a length is given", edge
        )
    elif stays:
        layout.note("the way up and down between maps; it takes a tick unless its length is given", edge)
    layout.lane(
        edge,
        None if name in layout.points else name,
        ends,
        level=not stays,
        speed=min((each for each in speeds if each), default=None),
        length=max((each.length for each in tracks if each.length), default=None),
        tracks=tracks,
    )


def _track(layout: Layout, properties: Tree, distance: int) -> Track:
    """What the properties say: a curve is no longer than the polygon of its control points, and leads to the end."""
    guided, curve = properties.get("physicalLineGuidedProperty"), properties.get("trajectory")
    given = None if guided is None else guided.metres("length")
    course = () if curve is None else _course(curve)
    layout.note("the shape of trajectories; their length is that of the control polygon, which is no less", curve)
    least = ceil(given) if given is not None else distance if course else 0
    return Track(max(least, length_of(course)) or None, course)


def _course(curve: Tree) -> tuple[Spot, ...]:
    places = curve["controlPoints"].entries
    return tuple(spot(each, (METRE * each["x"].number, METRE * each["y"].number)) for each in places)


READER = Reader(
    "lif", "the Layout Interchange Format (LIF) of VDMA, versions 1 and 2", _looks_like, read, LEFT_OUT, SILENT
)
