"""Plant models of openTCS, in XML of the versions 0.0.4, 0.0.5, 6 and 7.

Attributes: the samples of each version in openTCS's `opentcs-common`. Meaning: openTCS's user's guide, "Plant model
elements" and "Default scheduler": positions and lengths are in mm, speeds in mm/s; a path that is locked is not used,
nor is a direction with a speed of 0. A vehicle allocates a path with the point to which it leads, before it moves, and
frees what lies behind when it has arrived. So who is on a path holds both its ends.
"""

import re
from collections.abc import Iterable
from collections.abc import Set as AbstractSet
from fractions import Fraction

from carproof.layouts.layout import PLANE, Layout, Reader
from carproof.layouts.located import Tree, elements

VERSIONS = re.compile(r"0\.0\.[45]|[67](\.\d+)*")
KINDS = ("HALT_POSITION", "PARK_POSITION", "REPORT_POSITION")
NAMED = ("point", "path", "locationType", "location", "block", "vehicle")
STOREY = 2000
"""How much higher points are, in mm, below which vehicles drive."""
SPEEDS = "speeds of vehicles; --speed sets one for all"
LEFT_OUT = {
    "<property>": "properties",
    "maxVelocity": SPEEDS,
    "maxReverseVelocity": SPEEDS,
}
SILENT = {
    *(f"<{each}Layout>" for each in ("point", "path", "location", "block", "vehicle", "visual")),
    *(name for axis in "XYZ" for name in (f"position{axis}", f"{axis.lower()}Position")),
    *("name", "locationNamePrefix", "<locationType>", "<visualLayout>"),
    *(f"energyLevel{each}" for each in ("Critical", "Good", "FullyRecharged", "SufficientlyRecharged")),
}
"""What says nothing of routes."""


def _looks_like(tree: Tree) -> bool:
    return tree.says("<>") == "model" and tree.get("version") is not None


def read(tree: Tree) -> Layout:
    """Read a plant model."""
    version = tree["version"]
    if VERSIONS.fullmatch(version.text) is None:
        raise version.refuse(f"the version must be 0.0.4, 0.0.5, 6 or 7, not {version.shown}")
    layout = Layout(tree, holds_ends=True)
    kinds = _names(tree)
    served = {link["point"].text for location in elements(tree, "location") for link in elements(location, "link")}
    points = list(elements(tree, "point"))
    storeys = _storeys(map(_height, points))
    for point in points:
        for each in elements(point, "outgoingPath"):
            _require_named(each["name"], kinds["path"], "path")
        _point(layout, point, served, storeys[_height(point)])
        if _height(point) != _height(points[0]):
            layout.note(f"heights of points; {PLANE}", point)
    paths = {path["name"].text: _path(layout, path) for path in elements(tree, "path")}
    for location in elements(tree, "location"):
        if kinds["locationType"]:
            _require_named(location["type"], kinds["locationType"], "type of locations")
        for link in elements(location, "link"):
            layout.require_points(link, link["point"].text)
        layout.note("locations; the points that they are linked to are where vehicles stand", location)
    for block in elements(tree, "block"):
        _block(layout, block, paths, kinds["location"])
    for vehicle in elements(tree, "vehicle"):
        _vehicle(layout, vehicle)
    return layout


def _names(tree: Tree) -> dict[str, set[str]]:
    """The names of each kind of element; no two elements share one."""
    found: dict[str, set[str]] = {kind: set() for kind in NAMED}
    for kind, names in found.items():
        for each in elements(tree, kind):
            name = each["name"].text
            if any(name in others for others in found.values()):
                raise each.refuse(f"the name {name!r} must be given once")
            names.add(name)
    return found


def _require_named(name: Tree, names: set[str], what: str) -> None:
    if name.text not in names:
        raise name.refuse(f"it must be the name of a {what}, and {name.shown} is none")


_PLACES = (("positionX", "xPosition"), ("positionY", "yPosition"))


def _height(point: Tree) -> Fraction:
    height = point.get("positionZ", "zPosition")
    return Fraction(0) if height is None else height.number


def _storeys(heights: Iterable[Fraction]) -> dict[Fraction, str]:
    """The level of each height; one begins where a vehicle has room above the next lower height."""
    found: dict[Fraction, str] = {}
    before = None
    for height in sorted(set(heights)):
        found[height] = str(height) if before is None or height - before >= STOREY else found[before]
        before = height
    return found


def _point(layout: Layout, point: Tree, served: AbstractSet[str], level: str) -> None:
    """Add a point; vehicles stand at park positions and where a location is served."""
    name, kind = point["name"].text, point.says("type")
    if kind not in (None, *KINDS):
        raise point["type"].refuse(f"the type must be {', '.join(KINDS)}, not {point['type'].shown}")
    x, y = (point.get(each, other) or point[each] for each, other in _PLACES)
    layout.point(point, name, (x.number, y.number), stands=kind == "PARK_POSITION" or name in served, level=level)
    if kind == "REPORT_POSITION":
        layout.note("report positions, at which vehicles may not halt", point)
    layout.note("properties of points and paths", point.get("<property>"))
    layout.note("vehicle envelopes of points", point.get("<vehicleEnvelope>"))
    layout.note("bounding boxes that vehicles must fit at points", point.get("<maxVehicleBoundingBox>"))
    layout.note("orientations at points", point.get("vehicleOrientationAngle"), usual="NaN")


def _path(layout: Layout, path: Tree) -> tuple[str, ...]:
    """Add a path, and return its lanes; none if it is locked."""
    name, source, target = (path[each].text for each in ("name", "sourcePoint", "destinationPoint"))
    forward, backward = (path[each].number for each in ("maxVelocity", "maxReverseVelocity"))
    length = _length(layout, path, (source, target))
    if min(forward, backward) < 0:
        raise path.refuse("the speeds of a path must not be below 0")
    layout.note("properties of points and paths", path.get("<property>"))
    layout.note("peripheral operations", path.get("<peripheralOperation>"))
    layout.note("vehicle envelopes of paths", path.get("<vehicleEnvelope>"))
    locked = path.get("locked")
    if (locked is not None and locked.is_true) or not (forward or backward):
        layout.require_points(path, source, target)
        return ()
    if forward:
        return layout.lane(
            path,
            name,
            (source, target),
            speed=forward,
            length=length,
            back=bool(backward),
            back_speed=backward,
            backwards=bool(backward),
        )
    return layout.lane(path, name, (target, source), speed=backward, length=length, backwards=True)


def _length(layout: Layout, path: Tree, ends: tuple[str, str]) -> Fraction:
    """The length; versions 0.0.4 and 0.0.5 may leave it out, where it is the distance of the points, and at least 1."""
    if path.get("length") is None and layout.tree["version"].text.startswith("0.0."):
        layout.require_points(path, *ends)
        return Fraction(max(1, layout.distance(*ends) or 0))
    return path["length"].positive


def _block(layout: Layout, block: Tree, paths: dict[str, tuple[str, ...]], locations: set[str]) -> None:
    """Add a block. Its group has its paths, its points, and the lanes on which a vehicle holds one of these points."""
    kind = block.get("type")
    if kind is not None and kind.value not in ("SINGLE_VEHICLE_ONLY", "SAME_DIRECTION_ONLY"):
        raise kind.refuse(f"the type must be SINGLE_VEHICLE_ONLY or SAME_DIRECTION_ONLY, not {kind.shown}")
    members: list[tuple[Tree, str]] = []
    seen: set[str] = set()
    for member in elements(block, "member"):
        name = member["name"].text
        if name in seen:
            raise member.refuse(f"the member {name!r} must be named once in a block")
        seen.add(name)
        if name in locations:
            layout.note("locations as members of blocks", member)
        elif name in paths:
            members += [(member, lane) for lane in paths[name]]
        else:
            members.append((member, name))
    if block.says("type") == "SAME_DIRECTION_ONLY":
        layout.note("blocks of the type SAME_DIRECTION_ONLY", block)
        return
    named = {name for _, name in members}
    for _, name in tuple(members):
        if name in layout.points:
            held = [each.id for each in layout.lanes.values() if name in (each.source, each.target)]
            members += [(block, lane) for lane in held if lane not in named]
            named.update(held)
    if members:
        layout.block(block, block["name"].text, members)


def _vehicle(layout: Layout, vehicle: Tree) -> None:
    """Add a vehicle, if the file says where it is; other vehicles are left to `--robots`."""
    layout.note("sizes of vehicles; --footprint sets one for all", vehicle.get("<boundingBox>", "length"))
    start = [
        each["value"] for each in elements(vehicle, "property") if each["name"].value == "loopback:initialPosition"
    ]
    if len(start) > 1:
        raise start[1].refuse("the position of a vehicle must be given once")
    if start:
        layout.vehicle(vehicle, vehicle["name"].text, start[0].text)
    else:
        layout.note("vehicles without a position", vehicle)


READER = Reader(
    "opentcs",
    "a plant model of openTCS, XML of the versions 0.0.4, 0.0.5, 6 and 7",
    _looks_like,
    read,
    LEFT_OUT,
    SILENT,
)
