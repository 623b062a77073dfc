"""Instances and solutions to look at, and what a page or picture holds."""

import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from tests.oracle.running import BROKEN, TWO, Document, Run

SVG = "{http://www.w3.org/2000/svg}"
COLLIDING, CORRIDOR = BROKEN, TWO
HOSTILE = "</script><script>alert('1')</script>&\"\u2028é漢字🤖\u202e"


def without_positions(document: Document) -> Document:
    """The instance without the positions of its resources."""
    nodes = [
        {key: value for key, value in node.items() if key not in ("x", "y")} for node in document["graph"]["nodes"]
    ]
    return {**document, "graph": {**document["graph"], "nodes": nodes}}


def drawn(carproof: Run, folder: Path, instance: Document, plans: Document, *options: str) -> str:
    """The file that `carproof view` makes."""
    (folder / "town.json").write_text(json.dumps(instance))
    (folder / "plans.json").write_text(json.dumps(plans))
    outcome = carproof("view", folder / "town.json", folder / "plans.json", *options)
    assert (outcome.code, outcome.stderr) == (0, "")
    return outcome.stdout


def scene_of(page: str) -> dict[str, Any]:
    """The scene that the page's script shows."""
    found = re.search(r'<script id="scene" type="application/json">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    scene = json.loads(found[1])
    assert isinstance(scene, dict)
    return scene


def picture_of(still: str) -> ET.Element:
    """The root of a still picture."""
    return ET.fromstring(still)  # noqa: S314 - we have just written it
