"""The chart of resources by time as a still: free windows, visits and violations of the resources that are visited."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

from carproof.viewer.legend import Entry, write_legend
from carproof.viewer.scene import Scene
from carproof.viewer.shapes import box, drawing, group, hatch_definition, line, path, text

LANE = 12
GAP = 4
AXIS = 22
WIDEST = 1_200
WIDEST_TICK = 40
FEWEST_PIXELS = 40
LETTER = 8
LETTER_OF_NAME = 7
"""The width of a letter of a row's name, at most."""


@dataclass(frozen=True, slots=True)
class TimeScale:
    """Ticks as places from left to right, beside the rows' names; something happens until the tick `last`."""

    first: int
    last: int
    end: int
    left: int = 0

    @classmethod
    def beside(cls, names: Iterable[str], first: int, last: int) -> "TimeScale":
        """The scale of a chart with these names; a little room behind the last tick stands for what is for ever."""
        longest = max([len("tick"), *map(len, names)])
        return cls(first, last, last + max(1, (last - first) // 40), 3 * GAP + LETTER_OF_NAME * longest)

    @property
    def width(self) -> int:
        """The width of all ticks together."""
        return min(WIDEST, WIDEST_TICK * (self.end - self.first))

    def at(self, tick: int) -> int:
        """The place where the tick begins."""
        return self.left + (tick - self.first) * self.width // (self.end - self.first)

    def span(self, start: int, end: int | None) -> tuple[int, int]:
        """The place where an interval begins, and its width; one for ever continues to the chart's edge."""
        left, right = self.at(start), self.at(self.end if end is None else min(end, self.end))
        return left, max(1, right - left)

    def marks(self) -> Iterator[int]:
        """Round ticks, not too close to each other, and the last one."""
        ticks = self.end - self.first
        rounded = (digit * 10**power for power in range(9) for digit in (1, 2, 5))
        step = next(step for step in rounded if step * self.width >= FEWEST_PIXELS * ticks)
        marks = range(-(-self.first // step) * step, self.last, step)
        yield from (tick for tick in marks if (self.last - tick) * self.width >= FEWEST_PIXELS * ticks)
        yield self.last


def chart_picture(scene: Scene) -> Element:
    """Draw the chart."""
    # the places of the first robot in the order of its visits, then of the second
    rows = dict.fromkeys(scene.stands[stand].place for track in scene.tracks for stand, _, _ in track.stays)
    scale = TimeScale.beside((scene.places[place].name for place in rows), scene.first, scene.last)
    tops: dict[int, int] = {}
    height = AXIS
    for place in rows:
        tops[place] = height
        height += scene.places[place].lanes * LANE + GAP
    picture = drawing(scale.at(scale.end) + 2 * GAP, height + GAP, "chart")
    hatch_definition(picture)
    draw_windows(picture, scene, scale, tops)
    draw_axis(picture, scale, height)
    draw_stays(picture, scene, scale, tops)
    draw_violations(picture, scene, scale, tops)
    write_legend(picture, entries(scene))
    return picture


def entries(scene: Scene) -> Iterator[Entry]:
    """The legend of a chart."""
    yield "visit", "visit of a robot"
    yield "window", "free window"
    if any(track.services for track in scene.tracks):
        yield "service", "serves a stop"
    if any(each.start is not None for each in scene.violations):
        yield "violation", "broken rule"
    if scene.start:
        yield "", f"names without {scene.start}"


def draw_axis(picture: Element, scale: TimeScale, height: int) -> None:
    """Draw lines at round ticks, and their numbers."""
    axis = group(picture, "axis")
    for tick in scale.marks():
        path(axis, "line", [line([(scale.at(tick), AXIS - GAP), (scale.at(tick), height)])])
        text(axis, "tick", (scale.at(tick), AXIS - 11), str(tick), 10)
    text(axis, "unit", (scale.left - 2 * GAP, AXIS - 11), "tick", 10)


def draw_windows(picture: Element, scene: Scene, scale: TimeScale, tops: Mapping[int, int]) -> None:
    """Draw the free windows, and each row's name."""
    rows = group(picture, "rows")
    for place, top in tops.items():
        drawn = scene.places[place]
        spans = [scale.span(start, end) for start, end in drawn.windows]
        path(rows, "window", (box(x, top, width, drawn.lanes * LANE) for x, width in spans))
        text(rows, "row-name", (scale.left - 2 * GAP, top + drawn.lanes * LANE // 2), drawn.name, 10)


def draw_stays(picture: Element, scene: Scene, scale: TimeScale, tops: Mapping[int, int]) -> None:
    """Draw each robot's visits in its lanes, with its name where there is room for it."""
    robots = group(picture, "stays")
    for track in scene.tracks:
        look = scene.looks[track.look]
        of_robot = group(robots, "stay", fill=look.fill, stroke=look.edge)
        SubElement(of_robot, "title").text = track.label
        for stand, enter, leave in track.stays:
            spot = scene.stands[stand]
            x, width = scale.span(enter, leave)
            top = tops[spot.place] + spot.lane * LANE
            path(of_robot, "bar", [box(x, top + 1, max(1, width - 1), LANE - 2)])
            for start, end in track.services:
                if start == enter:
                    left, wide = scale.span(start, end)
                    path(of_robot, "service", [box(left, top + LANE - 3, wide, 2)])
            if width >= LETTER * len(track.short):
                text(of_robot, "short", (x + width // 2, top + LANE // 2), track.short, 9, fill=look.text)


def draw_violations(picture: Element, scene: Scene, scale: TimeScale, tops: Mapping[int, int]) -> None:
    """Draw a hatched frame around every violation that has a place and a tick."""
    marks = group(picture, "marks")
    for each in scene.violations:
        for place in each.places:
            if place in tops and each.start is not None:
                x, width = scale.span(each.start, each.end)
                path(marks, "violation", [box(x, tops[place], max(3, width), scene.places[place].lanes * LANE)])
