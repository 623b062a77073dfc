"""Layouts of fleet systems: each reader fills a `Layout`, from which one function makes an instance.

To add a format, write its reader and put it into `READERS`.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from carp_spec import Instance, Refusal
from carp_spec.shapes import require_shape
from carproof.input_rules import Code
from carproof.layouts import lif, nav2, open_rmf, opentcs, roadmaps
from carproof.layouts.layout import Layout, Note, Reader
from carproof.layouts.located import RIGHT_LAYOUT, read_tree
from carproof.layouts.making import instance_of
from carproof.layouts.settings import RIGHT_SETTINGS, Settings, require_settings

__all__ = ["LAYOUT_RULES", "READERS", "Imported", "Note", "Reader", "Settings", "import_layout"]

READERS: Mapping[str, Reader] = {
    each.name: each
    for each in (opentcs.READER, open_rmf.READER, lif.READER, nav2.READER, roadmaps.ANNOTATED, roadmaps.PLAIN)
}
"""The formats by name, in the order in which they are tried."""
LAYOUT_RULES: tuple[Code, ...] = (RIGHT_LAYOUT, RIGHT_SETTINGS)


@dataclass(frozen=True, slots=True)
class Imported:
    """An instance, the name of the format from which it was made, and what of the file it does not express."""

    instance: Instance
    format: str
    notes: tuple[Note, ...]


DEFAULTS = Settings()


def import_layout(
    data: bytes, file: str = "layout", format: str | None = None, settings: Settings = DEFAULTS
) -> Imported:
    """Make an instance of a layout in the format named or, if none is, in the one that it looks like.

    Raises `Refusal` with file and line, or for wrong settings.
    """
    require_settings(settings)
    name, layout = read_layout(data, file, format)
    return Imported(instance_of(layout, settings), name, layout.notes)


def read_layout(data: bytes, file: str = "layout", format: str | None = None) -> tuple[str, Layout]:
    """Read a layout; returns the name of its format with it."""
    require_shape(data, bytes, file)
    require_shape(format, str | None, "$.format")
    tree = read_tree(data, file)
    if format is None:
        looks = [name for name, each in READERS.items() if each.looks_like(tree)]
        if not looks:
            raise tree.refuse(f"it looks like none of {', '.join(READERS)}")
        format = looks[0]
    elif format not in READERS:
        message = f"there is no format {format!r}; the formats are {', '.join(READERS)}"
        raise Refusal("option", "$.format", RIGHT_SETTINGS.id, message)
    reader = READERS[format]
    layout = reader.read(tree)
    layout.note_lanes_apart()
    layout.note_unread(tree, reader.features, reader.silent)
    return format, layout
