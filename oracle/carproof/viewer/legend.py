"""The legend below a still picture: a sample of each kind of shape, and what it is."""

from collections.abc import Iterable
from typing import TypeAlias
from xml.etree.ElementTree import Element

from carproof.viewer.colours import LOOKS
from carproof.viewer.shapes import box, circle, group, head, line, path, text

Entry: TypeAlias = tuple[str, str]
"""The kind of a shape, or nothing for a note, and what it is."""

SIZE = 9
LETTER = 5
"""The width of a letter of that size, and a little more."""
ROW = 16
SAMPLE = 14
GAP = 12
LEAST_WIDTH = 240


def write_legend(picture: Element, entries: Iterable[Entry]) -> None:
    """Make the picture higher by its legend, and wider if need be."""
    *corner, width, height = map(int, picture.get("viewBox", "").split())
    widest = max(width, LEAST_WIDTH)
    legend = group(picture, "legend")
    x, y = GAP, height + ROW
    right = width
    for kind, words in entries:
        needed = (SAMPLE if kind else 0) + LETTER * len(words)
        if x > GAP and x + needed > widest:
            x, y = GAP, y + ROW
        if kind:
            draw_sample(legend, kind, x, y)
        text(legend, "legend-text", (x + (SAMPLE if kind else 0), y), words, SIZE)
        x += needed + GAP
        right = max(right, x)
    if len(legend):
        picture.set("viewBox", f"{corner[0]} {corner[1]} {right} {y + ROW}")
    else:
        picture.remove(legend)


def draw_sample(legend: Element, kind: str, x: int, y: int) -> None:
    """Draw a small shape of the kind."""
    look, sample = LOOKS[0], group(legend, "sample")
    if kind == "robot":
        circle(sample, kind, (x + 4, y), 5, fill=look.fill)
    elif kind == "serving":
        circle(sample, kind, (x + 4, y), 5)
    elif kind == "stop":
        path(sample, kind, [line([(x + 4, y - 5), (x + 9, y), (x + 4, y + 5), (x - 1, y)]) + "z"], stroke=look.hue)
    elif kind == "start":
        circle(sample, kind, (x + 4, y), 4, stroke=look.hue)
    elif kind in ("waits", "cycle"):
        arrow = group(sample, kind)
        path(arrow, "arrow", [line([(x - 1, y), (x + 5, y)])])
        path(arrow, "head", [head((x + 10, y), (1, 0), 6)])
    else:
        colour = {"goal": {"stroke": look.hue}, "visit": {"fill": look.fill}}.get(kind, {})
        path(sample, kind, [box(x, y - 4, 9, 8)], **colour)
    for shape in sample.iter():
        shape.set("class", "sample")
