"""SVG elements and path data; text is escaped by the standard library's XML writer.

The kind of a shape or group is its class, and decides how it is painted (`colours.PAINT`).
"""

from collections.abc import Iterable
from math import isqrt
from xml.etree.ElementTree import Element, SubElement, tostring

from carproof.viewer.colours import PAINT

NAMESPACE = "http://www.w3.org/2000/svg"
FONTS = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif"
LOWER = "0.35em"
"""From the middle of a line of text down to its base; not all renderers know `dominant-baseline`."""


def drawing(width: int, height: int, kind: str) -> Element:
    """An empty drawing."""
    box = f"0 0 {width} {height}"
    return Element("svg", {"xmlns": NAMESPACE, "viewBox": box, "class": kind, "font-family": FONTS})


def group(parent: Element, kind: str, **attributes: str) -> Element:
    """A group; attributes that its kind does not decide are given."""
    return SubElement(parent, "g", {"class": kind, **PAINT.get(kind, {}), **attributes})


def path(parent: Element, kind: str, data: Iterable[str], **attributes: str) -> None:
    """A path; nothing where there is nothing to draw."""
    joined = "".join(data)
    if joined:
        SubElement(parent, "path", {"class": kind, "d": joined, **PAINT.get(kind, {}), **attributes})


def text(parent: Element, kind: str, at: tuple[int, int], content: str, size: int, **attributes: str) -> None:
    """A text whose middle line is at the height of the point."""
    place = {"x": str(at[0]), "y": str(at[1]), "dy": LOWER, "font-size": str(size)}
    SubElement(parent, "text", {"class": kind, **place, **PAINT.get(kind, {}), **attributes}).text = content


def circle(parent: Element, kind: str, at: tuple[int, int], radius: int, **attributes: str) -> None:
    """A circle around a point."""
    place = {"cx": str(at[0]), "cy": str(at[1]), "r": str(radius)}
    SubElement(parent, "circle", {"class": kind, **place, **PAINT.get(kind, {}), **attributes})


def box(x: int, y: int, width: int, height: int) -> str:
    """Path data of a rectangle."""
    return f"M{x} {y}h{width}v{height}h{-width}z"


def line(points: Iterable[tuple[int, int]]) -> str:
    """Path data of a line through the points."""
    return "M" + "L".join(f"{x} {y}" for x, y in points)


def head(tip: tuple[int, int], way: tuple[int, int], length: int) -> str:
    """Path data of the head of an arrow that comes that way; it is as wide as it is long."""
    (x, y), (dx, dy) = tip, way
    far = max(1, isqrt(dx * dx + dy * dy))
    back_x, back_y = x - dx * length // far, y - dy * length // far
    side_x, side_y = -dy * length // (2 * far), dx * length // (2 * far)
    return f"M{x} {y}L{back_x + side_x} {back_y + side_y}L{back_x - side_x} {back_y - side_y}z"


def svg_text(element: Element) -> str:
    """The element as text."""
    return tostring(element, encoding="unicode")


def hatch_definition(picture: Element) -> None:
    """Define the hatching that marks violations, so that they differ without their colour."""
    size = {"width": "6", "height": "6"}
    turned = {"patternUnits": "userSpaceOnUse", "patternTransform": "rotate(45)"}
    pattern = SubElement(SubElement(picture, "defs"), "pattern", {"id": "hatch", **size, **turned})
    SubElement(pattern, "rect", {"width": "2", "height": "6", **PAINT["hatch"]})
