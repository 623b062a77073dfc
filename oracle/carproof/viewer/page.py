"""The page: one HTML file with map, chart, lists and script; a browser needs nothing else and fetches nothing.

Content from a document reaches the page escaped: as XML text in the map, and as JSON without `<`, `>` and `&` for the
script, which shows it as text only. The page's content security policy lets no other script run.
"""

from base64 import b64encode
from hashlib import sha256
from html import escape
from importlib.resources import files
from string import Template

import msgspec

from carp_spec import Instance, Solution
from carp_spec.execution.traces import Trace
from carproof.viewer.colours import variables
from carproof.viewer.limits import refuse_more
from carproof.viewer.map_picture import map_picture
from carproof.viewer.scene_builder import make_scene
from carproof.viewer.shapes import svg_text

TITLE = "carproof"
SCRIPTS = ("scene.js", "clock.js", "waits.js", "map.js", "chart.js", "lists.js", "main.js")
UNSAFE_IN_HTML = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029"}


def view(
    instance: Instance, solution: Solution | None = None, *, title: str = TITLE, trace: Trace | None = None
) -> bytes:
    """One HTML file that shows a solution, or starts and goals alone; with a trace, also what has happened.

    Raises `Refusal` for malformed input, and for what is too large to show.
    """
    scene = make_scene(instance, solution, title, trace)
    picture = map_picture(instance.graph, scene)
    style = variables() + page_file("page.css")
    script = "\n".join(map(page_file, SCRIPTS))
    filled = Template(page_file("page.html")).substitute(
        title=escape(scene.title),
        policy=f"default-src 'none'; img-src data:; style-src '{digest(style)}'; script-src '{digest(script)}'",
        style=style,
        map=svg_text(picture),
        scene=msgspec.json.encode(scene).decode().translate(UNSAFE_IN_HTML),
        script=script,
    )
    data = filled.encode()
    refuse_more("bytes", len(data))
    return data


def page_file(name: str) -> str:
    """A file of the page, as text."""
    return files("carproof.viewer").joinpath("web", name).read_text(encoding="utf-8")


def digest(text: str) -> str:
    """How a content security policy names an inline text."""
    return f"sha256-{b64encode(sha256(text.encode()).digest()).decode()}"
