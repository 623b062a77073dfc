"""Still pictures as SVG files: they carry their colours, for a light and for a dark page."""

from importlib.resources import files
from xml.etree.ElementTree import Element

from carp_spec import Instance, Solution
from carproof.viewer.chart_picture import chart_picture
from carproof.viewer.limits import refuse_more, refuse_tick
from carproof.viewer.map_picture import still_map
from carproof.viewer.shapes import svg_text
from carproof.viewer.staging import make_scene

STYLES = ("colours.css", "pictures.css")
GROUND = "\nsvg {\n  background: var(--paper);\n}\n"


def page_file(name: str) -> str:
    """A file of the page, as text."""
    return files("carproof.viewer").joinpath("web", name).read_text(encoding="utf-8")


def map_still(instance: Instance, solution: Solution, tick: int, title: str) -> bytes:
    """The map at a tick."""
    refuse_tick(tick, "--at")
    scene = make_scene(instance, solution, title)
    return still(still_map(instance.graph, scene, tick), f"{scene.title} at tick {tick}")


def chart_still(instance: Instance, solution: Solution, title: str) -> bytes:
    """The chart of resources by time."""
    scene = make_scene(instance, solution, title)
    return still(chart_picture(scene), f"{scene.title}: resources by time")


def still(picture: Element, title: str) -> bytes:
    """The picture as a file, with a title and its styles."""
    for name, content in (("style", "\n".join(map(page_file, STYLES)) + GROUND), ("title", title)):
        added = Element(name)
        added.text = content
        picture.insert(0, added)
    _, _, width, height = picture.get("viewBox", "").split()
    picture.set("width", width)
    picture.set("height", height)
    data = svg_text(picture).encode() + b"\n"
    refuse_more("bytes", len(data))
    return data
