"""Instances and solutions to look at, and what a page or picture holds."""

import json
import re
from dataclasses import replace
from typing import Any
from xml.etree import ElementTree as ET

from tests.oracle.layouts.layout_files import OPENTCS
from tests.oracle.running import BROKEN, TWO, Document, Run, save

from carproof import Instance, Plan, Robot, Solution, Stop, Visit, import_layout

SVG = "{http://www.w3.org/2000/svg}"
COLLIDING, CORRIDOR = BROKEN, TWO
HOSTILE = "</script><script>alert('1')</script>&\"\u2028é漢字🤖\u202e"


def plant() -> tuple[Instance, Solution]:
    """A robot that drives east from a to b, serves there, and drives north to c, where it serves again."""
    stops = (Stop("b", 4), Stop("c", 6))
    instance = replace(import_layout(OPENTCS.encode()).instance, robots=(Robot("tow", "a", stops=stops),))
    visits = (Visit("a", 0, 1), Visit("ab", 1, 4), Visit("b", 4, 8), Visit("bc", 8, 12), Visit("c", 12, None))
    return instance, Solution.of(instance, [Plan("tow", visits)])


def drawn(carproof: Run, instance: Document, plans: Document, *options: str) -> str:
    """What `carproof view` makes in the folder that a test is in."""
    save(town=instance, plans=plans)
    outcome = carproof("view town.json plans.json", *options)
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
