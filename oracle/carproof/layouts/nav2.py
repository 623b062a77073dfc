"""Graphs of Nav2's route server, in GeoJSON.

Fields: `nav2_route/README.md` of ros-navigation/navigation2, and its sample graphs. Points are nodes, lines are edges
from `startid` to `endid`; the course of a line is not used there either. Positions are in m, `abs_speed_limit` is in
m/s, and `speed_limit` in percent of the speed of the robot.
"""

from fractions import Fraction

from carproof.layouts.layout import Layout, Reader
from carproof.layouts.located import METRE, Tree

WHOLE = 100
LINES = ("LineString", "MultiLineString")
SILENT = {"type", "name", "crs", "date_generated", "coordinates"}
LEFT_OUT = {
    "operations": "operations at nodes and edges",
    "cost": "costs of edges",
    "overridable": "costs of edges",
    "penalty": "costs of edges",
    "class": "classes of nodes and edges",
    "abs_time_taken": "times measured on edges",
}


def _looks_like(tree: Tree) -> bool:
    return tree.says("type") == "FeatureCollection"


def read(tree: Tree) -> Layout:
    """Read a graph."""
    layout = Layout(tree)
    features = tree["features"].entries
    for each in features:
        kind, properties = each["geometry"]["type"], each["properties"]
        if kind.value == "Point":
            x, y = each["geometry"]["coordinates"].first(2, "a position must have x and y")
            layout.point(each, properties["id"].name, (METRE * x.number, METRE * y.number))
            layout.note("frames of nodes other than map", properties.get("frame"), usual="map")
            properties.get("metadata")
        elif kind.value not in LINES:
            raise kind.refuse(f"the type must be Point, LineString or MultiLineString, not {kind.shown}")
    for each in features:
        if each["geometry"]["type"].value in LINES:
            _edge(layout, each["properties"])
    return layout


def _edge(layout: Layout, edge: Tree) -> None:
    metadata = edge.get("metadata") or Tree(edge.file, edge.line, {})
    share = metadata.get("speed_limit")
    ends = edge["startid"].name, edge["endid"].name
    name, limit = edge["id"].name, metadata.metres("abs_speed_limit")
    if ends[0] == ends[1]:
        layout.note("edges from a node to itself", edge)
        return
    is_new = name not in layout.lanes and name not in layout.points
    layout.note("ids that are given twice; such an edge is named by its ends", None if is_new else edge)
    layout.lane(
        edge,
        name if is_new else None,
        ends,
        speed=limit,
        share=None if share is None else min(share.positive / WHOLE, Fraction(1)),
    )


READER = Reader("nav2", "a graph of Nav2's route server, GeoJSON", _looks_like, read, LEFT_OUT, SILENT)
