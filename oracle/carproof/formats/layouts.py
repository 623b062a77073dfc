"""Plant layouts and maps of other systems, named where a command is given one in place of a document."""

import json
import re
from collections.abc import Mapping
from contextlib import suppress

BEGINNING = 100_000
"""The bytes by which a text is recognised."""
MAP = "a map of MovingAI"
TEXTS: Mapping[str, str] = {
    "an openTCS plant model": r"<model\b[^>]*>(?=.*<(point|path|vehicle)\b)",
    "an Open-RMF building or navigation graph": r"^levels:(?=.*^\s+-?\s*(vertices|lanes):)",
    "another XML document": r"\A\s*<\?xml\b",
    "a map for ROS": r"^image:(?=.*^resolution:)",
    MAP: r"\Atype [a-z]+\r?\nheight ",
}
GEOJSON = {"FeatureCollection", "Feature", "GeometryCollection"}


def layout_named(data: bytes) -> str | None:
    """The kind of the data, as `an openTCS plant model`; `None` if it is no layout that carproof knows by sight."""
    text = data[:BEGINNING].decode(errors="replace")
    for name, sign in TEXTS.items():
        if re.search(sign, text, re.DOTALL | re.MULTILINE):
            return name
    if any(f'"{sign}"' in text for sign in ("layouts", *GEOJSON)):
        with suppress(ValueError, RecursionError):
            document = json.loads(data)
            if isinstance(document, dict) and isinstance(document.get("layouts"), list):
                return "a Layout Interchange Format (LIF) document"
            if isinstance(document, dict) and document.get("type") in GEOJSON:
                return "a GeoJSON document"
    return None
