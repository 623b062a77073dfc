"""Still pictures as SVG files, with plain attributes that every renderer knows."""

from xml.etree.ElementTree import Element

from carp_spec import Instance, Solution
from carp_spec.shapes import require_shape
from carproof.viewer.chart_picture import chart_picture
from carproof.viewer.colours import PAINT, fixed
from carproof.viewer.limits import refuse_more, refuse_tick
from carproof.viewer.map_picture import still_map
from carproof.viewer.page import TITLE
from carproof.viewer.scene_builder import make_scene
from carproof.viewer.shapes import svg_text


def view_map(instance: Instance, solution: Solution | None = None, *, at: int = 0, title: str = TITLE) -> bytes:
    """An SVG file of the map at a tick, or without a solution of starts and goals. Raises as `view` does."""
    require_shape(at, int, "--at")
    refuse_tick(at, "--at")
    scene = make_scene(instance, solution, title)
    when = "starts and goals" if scene.alone else f"at tick {at}"
    return still(still_map(instance.graph, scene, at), f"{scene.title} {when}")


def view_chart(instance: Instance, solution: Solution, *, title: str = TITLE) -> bytes:
    """An SVG file of resources by time. Raises as `view` does."""
    scene = make_scene(instance, solution, title)
    return still(chart_picture(scene), f"{scene.title}: resources by time")


def still(picture: Element, title: str) -> bytes:
    """The picture as a file, with a title and a ground."""
    _, _, width, height = picture.get("viewBox", "").split()
    picture.set("width", width)
    picture.set("height", height)
    picture.insert(0, Element("rect", {"width": width, "height": height, **PAINT["paper"]}))
    heading = Element("title")
    heading.text = title
    picture.insert(0, heading)
    fixed(picture)
    data = svg_text(picture).encode() + b"\n"
    refuse_more("bytes", len(data))
    return data
