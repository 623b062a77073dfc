"""Roadmaps: annotated ones of libMultiRobotPlanning, and graphs as networkx writes them, in GraphML or JSON.

Annotated: fields as in `tools/annotate_roadmap.py` and `example/cbs_roadmap.cpp` of whoenig/libMultiRobotPlanning. An
edge from a vertex to itself is to wait there; the conflicts of an edge are the numbers of those that may not be used
with it. Plain: the node-link form of networkx, or GraphML, with `x` and `y` of nodes, and `length` and `speed` of edges
if they are known. Positions and lengths are in m, speeds in m/s.
"""

from fractions import Fraction
from itertools import product

from carproof.layouts.layout import Layout, Reader
from carproof.layouts.located import METRE, Tree, elements

SILENT = {"multigraph", "graph", "id", "key", "for", "attr.type"}


def _looks_annotated(tree: Tree) -> bool:
    return tree.get("roadmap") is not None


def read_annotated(tree: Tree) -> Layout:
    """Read an annotated roadmap."""
    layout, roadmap = Layout(tree), tree["roadmap"]
    edges = roadmap["edges"].entries
    vertices = roadmap.get("vertices")
    if vertices is not None:
        for name, place in vertices.fields.items():
            layout.point(place, name, _place(place))
    else:
        for edge in edges:
            for end in edge.entries:
                if end.text not in layout.points:
                    layout.point(end, end.text, None)
    both = roadmap["undirected"].is_true
    lanes: list[tuple[str, ...]] = []
    for edge in edges:
        source, target = (end.text for end in edge.first(2, "an edge must have two ends", most=2))
        if source not in layout.points:
            raise edge.refuse(f"the vertex {source!r} must be one of the roadmap")
        lanes.append((source,) if source == target else layout.lane(edge, None, (source, target), back=both))
    _waiting(layout, roadmap, {ends[0] for ends in lanes if len(ends) == 1})
    _conflicts(layout, roadmap, lanes)
    for agent in tree.all("agents"):
        layout.vehicle(agent, agent["name"].text, agent["start"].text, agent["goal"].text)
    return layout


def _waiting(layout: Layout, roadmap: Tree, loops: set[str]) -> None:
    allowed = roadmap.get("allow_wait_actions")
    if allowed is not None and not allowed.is_true and not loops >= layout.points.keys():
        layout.note("vertices without an edge to themselves, where robots may not wait; here they may", allowed)


def _conflicts(layout: Layout, roadmap: Tree, lanes: list[tuple[str, ...]]) -> None:
    """Add a block of two for each pair of edges in conflict."""
    listed = roadmap.all("conflicts")
    if listed and len(listed) != len(lanes):
        raise roadmap["conflicts"].refuse(f"there must be conflicts of each of {len(lanes)} edges, not {len(listed)}")
    done: set[frozenset[str]] = set()
    for number, entry in enumerate(listed):
        seen: set[int] = set()
        for other in entry.entries:
            if (index := other.whole) >= len(lanes) or index == number or index in seen:
                raise other.refuse(f"a conflict must be another of the {len(lanes)} edges, counted from 0, and once")
            seen.add(index)
            for one, two in product(lanes[number], lanes[index]):
                if one != two and frozenset((one, two)) not in done:
                    done.add(frozenset((one, two)))
                    layout.block(other, f"{one} | {two}", [(other, one), (other, two)])


def _place(place: Tree) -> tuple[Fraction, Fraction]:
    x, y = place.first(2, "a position must be x and y", most=2)
    return METRE * x.number, METRE * y.number


def _looks_plain(tree: Tree) -> bool:
    is_node_link = tree.get("nodes") is not None and tree.get("links", "edges") is not None
    return tree.says("<>") == "graphml" or is_node_link


def read_plain(tree: Tree) -> Layout:
    """Read a graph."""
    layout = Layout(tree)
    graphml = tree.get("<>") is not None
    nodes, edges, directed = _graphml(tree) if graphml else _node_link(tree)

    def name(at: Tree) -> str:
        return at.text if graphml else at.name

    for node in nodes:
        pos = node.get("pos")
        at = _place(pos) if pos is not None else (METRE * node["x"].number, METRE * node["y"].number)
        layout.point(node, name(node["id"]), at)
        layout.note_unread(node, {}, SILENT)
    for edge in edges:
        speed, ends = edge.metres("speed"), (name(edge["source"]), name(edge["target"]))
        layout.lane(edge, None, ends, speed=speed, length=edge.metres("length"), back=not directed)
        layout.note_unread(edge, {}, SILENT)
    return layout


def _node_link(tree: Tree) -> tuple[list[Tree], list[Tree], bool]:
    directed, edges = tree.get("directed"), tree.get("links") or tree["edges"]
    return tree["nodes"].entries, edges.entries, directed is not None and directed.is_true


def _graphml(tree: Tree) -> tuple[list[Tree], list[Tree], bool]:
    """The nodes and edges as mappings of their attributes' names, with what the keys have as defaults."""
    keys = {key["id"].text: key for key in elements(tree, "key")}
    graphs = list(elements(tree, "graph"))
    if len(graphs) != 1:
        raise tree.refuse(f"the file must have one graph, not {len(graphs)}")

    def plain(thing: Tree) -> Tree:
        own = thing.attributes
        given: dict[str, Tree] = {}
        for each in elements(thing, "data"):
            key = each["key"].text
            if key not in keys or key in given:
                raise each.refuse(f"the key {key!r} must be one of the file, and given once")
            given[key] = each
        for id, declared in keys.items():
            if declared.says("for") in (thing.says("<>"), "all", None):
                for each in elements(declared, "default"):
                    given.setdefault(id, each)
        fields = {**own}
        for id, each in given.items():
            name, value = keys[id]["attr.name"].text, each.get("text")
            fields[f"data {name}" if name in own else name] = value or Tree(each.file, each.line, "")
        return Tree(thing.file, thing.line, fields, asked=set())

    kind = graphs[0]["edgedefault"]
    if kind.value not in ("directed", "undirected"):
        raise kind.refuse(f"edgedefault must be directed or undirected, not {kind.shown}")
    nodes, edges = ([plain(each) for each in elements(graphs[0], tag)] for tag in ("node", "edge"))
    return nodes, edges, kind.value == "directed"


ANNOTATED = Reader(
    "annotated-roadmap", "a roadmap of libMultiRobotPlanning with its conflicts, YAML", _looks_annotated, read_annotated
)
PLAIN = Reader("roadmap", "a graph with positions in GraphML or networkx's JSON", _looks_plain, read_plain, {}, SILENT)
