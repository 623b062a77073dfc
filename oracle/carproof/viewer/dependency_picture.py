"""The dependency graph of a solution as a still: robots as rows, time from left to right, arrows between visits."""

from collections.abc import Iterator, Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

from carp_reference.execution import Order
from carp_spec import RobotId
from carp_spec.execution.dependencies import Dependency, Node, shortest_cycle
from carproof.execution.delays import slack
from carproof.viewer.chart_picture import AXIS, GAP, LANE, TimeScale, draw_axis
from carproof.viewer.colours import LOOKS
from carproof.viewer.legend import write_legend
from carproof.viewer.limits import refuse_large_pictures, refuse_more
from carproof.viewer.names import common_start, fitted, label
from carproof.viewer.plants import Point
from carproof.viewer.scene_builder import LONGEST_NAME
from carproof.viewer.shapes import box, drawing, group, head, path, text
from carproof.viewer.stills import still

ROW = 30
SIZES = ((9, 6), (7, 5))
"""Sizes of a name in a bar, and the width of a letter of each."""
LEAST_BEND, MOST_BEND = 5, 40
HEAD = 6


def dependency_still(order: Order, title: str) -> bytes:
    """The graph as a file; raises `Refusal` where it is too large.

    An arrow leads from the start of a visit to the start of one that waits for it. The robots of a shortest cycle come
    first, and its arrows are red.
    """
    refuse_large_pictures(order.instance, order.solution)
    refuse_more("edges", len(order.edges))
    visits = [visit for plan in order.solution.plans for visit in plan.visits]
    first = min((visit.enter for visit in visits), default=0)
    last = max([first + 1, *(visit.enter + 1 if visit.leave is None else visit.leave for visit in visits)])
    cycle = shortest_cycle(order.edges)
    robots = dict.fromkeys([*(edge.after[0] for edge in cycle), *(plan.robot for plan in order.solution.plans)])
    names = dict(zip(robots, fitted([label(robot) for robot in robots], LONGEST_NAME), strict=True))
    scale = TimeScale.beside(names.values(), first, last)
    tops = {robot: AXIS + at * ROW for at, robot in enumerate(robots)}
    height = AXIS + len(tops) * ROW
    picture = drawing(scale.at(scale.end) + AXIS, height, "chart")
    draw_axis(picture, scale, height)
    waits = [edge for edge in order.edges if edge.kind == "order" and edge not in cycle]
    draw_arrows(group(picture, "waits"), waits, order, scale, tops)
    start = common_start([label(id) for id in order.instance.graph.index])
    draw_visits(picture, order, scale, tops, names, start)
    draw_arrows(group(picture, "cycle"), cycle, order, scale, tops)
    legend = [("visit", "visit of a robot"), ("waits", "the visit at the head waits until the other begins")]
    legend += [("cycle", "each waits for the next: nobody can go first")] if cycle else []
    write_legend(picture, [*legend, *([("", f"names without {start}")] if start else [])])
    return still(picture, f"{title}: which visits wait for which")


def draw_visits(
    picture: Element,
    order: Order,
    scale: TimeScale,
    tops: Mapping[RobotId, int],
    names: Mapping[RobotId, str],
    start: str,
) -> None:
    """Draw the row of each robot with its visits; each says its ticks and its slack."""
    spare = slack(order)
    rows = group(picture, "stays")
    for at, plan in enumerate(order.solution.plans):
        look, top = LOOKS[at % len(LOOKS)], tops[plan.robot]
        row = group(rows, "stay", fill=look.fill, stroke=look.edge)
        text(row, "row-name", (scale.left - 2 * GAP, top + LANE // 2), names[plan.robot], 10, stroke="none")
        for place, visit in enumerate(plan.visits):
            x, width = scale.span(visit.enter, visit.leave)
            name, late = label(visit.resource), spare[plan.robot, place]
            leave = "for ever" if visit.leave is None else visit.leave
            bar = group(row, "visit")
            SubElement(bar, "title").text = f"{name} [{visit.enter}, {leave}), slack {'any' if late is None else late}"
            path(bar, "bar", [box(x, top, max(1, width - 1), LANE)])
            name = name.removeprefix(start)
            size = next((size for size, letter in SIZES if width >= letter * len(name)), None)
            if size is not None:
                text(bar, "short", (x + width // 2, top + LANE // 2), name, size, fill=look.text)


def draw_arrows(
    arrows: Element, edges: Sequence[Dependency], order: Order, scale: TimeScale, tops: Mapping[RobotId, int]
) -> None:
    """Draw edges between visits of different robots."""

    def start(node: Node) -> Point:
        return scale.at(order.visit(node).enter), tops[node[0]]

    ends = [(start(edge.before), start(edge.after)) for edge in edges if edge.before[0] != edge.after[0]]
    path(arrows, "arrow", (part for one, other in ends for part in curve(one, other)))
    path(arrows, "head", (head(tip, (tip[0] - x, tip[1] - y), HEAD) for x, y, tip in map(approach, ends)))


def curve(one: Point, other: Point) -> Iterator[str]:
    """Path data of the line of an arrow between the starts of two bars."""
    x, y, tip = approach((one, other))
    yield f"M{one[0]} {one[1] + (LANE if other[1] > one[1] else 0)}Q{x} {y} {tip[0]} {tip[1]}"


def approach(ends: tuple[Point, Point]) -> tuple[int, int, Point]:
    """The point from where an arrow bends to its tip, and the tip, at the edge of the bar that is nearer."""
    (x, y), (end_x, end_y) = ends
    down = end_y > y
    bend = min(MOST_BEND, LEAST_BEND * (1 + abs(end_y - y) // ROW))
    tip = (end_x, end_y if down else end_y + LANE)
    return (x + end_x) // 2 + (bend if down else -bend), (y + end_y + LANE) // 2, tip
