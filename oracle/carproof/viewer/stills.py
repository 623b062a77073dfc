"""Still pictures as SVG files, with plain attributes that every renderer knows."""

from xml.etree.ElementTree import Element

from carp_spec import Instance, Solution
from carproof.viewer.chart_picture import chart_picture
from carproof.viewer.colours import PAINT, fixed
from carproof.viewer.limits import refuse_more, refuse_tick
from carproof.viewer.map_picture import still_map
from carproof.viewer.scene_builder import make_scene
from carproof.viewer.shapes import svg_text


def map_still(instance: Instance, solution: Solution | None, tick: int, title: str) -> bytes:
    """The map at a tick, or without a solution with starts and goals alone."""
    refuse_tick(tick, "--at")
    scene = make_scene(instance, solution, title)
    when = "starts and goals" if scene.alone else f"at tick {tick}"
    return still(still_map(instance.graph, scene, tick), f"{scene.title} {when}")


def chart_still(instance: Instance, solution: Solution, title: str) -> bytes:
    """The chart of resources by time."""
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
