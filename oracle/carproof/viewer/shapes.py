"""SVG elements and path data; text is escaped by the standard library's XML writer."""

from collections.abc import Iterable
from math import isqrt
from xml.etree.ElementTree import Element, SubElement, tostring

NAMESPACE = "http://www.w3.org/2000/svg"


def drawing(width: int, height: int, **attributes: str) -> Element:
    """An empty drawing."""
    return Element("svg", {"xmlns": NAMESPACE, "viewBox": f"0 0 {width} {height}", **attributes})


def group(parent: Element, kind: str) -> Element:
    """A group whose class is its kind."""
    return SubElement(parent, "g", {"class": kind})


def path(parent: Element, kind: str, data: Iterable[str]) -> None:
    """A path of the class; nothing where there is nothing to draw."""
    joined = "".join(data)
    if joined:
        SubElement(parent, "path", {"class": kind, "d": joined})


def text(parent: Element, kind: str, x: int, y: int, content: str, size: int = 0) -> None:
    """A text of the class; without a size the style says how large it is."""
    sized = {"font-size": str(size)} if size else {}
    SubElement(parent, "text", {"class": kind, "x": str(x), "y": str(y), **sized}).text = content


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
    pattern = SubElement(
        SubElement(picture, "defs"),
        "pattern",
        {
            "id": "hatch",
            "width": "6",
            "height": "6",
            "patternUnits": "userSpaceOnUse",
            "patternTransform": "rotate(45)",
        },
    )
    SubElement(pattern, "rect", {"class": "hatch", "width": "2", "height": "6"})
