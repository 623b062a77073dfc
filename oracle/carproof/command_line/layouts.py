"""The options of layouts and of orders, the reading of layouts, and the list of what an instance does not express."""

import json
from functools import partial
from typing import Any

import click

from carp_spec import AfterGoal
from carp_spec.documents.instances import write_instance
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, print_document, read_bytes, shown, write_whole
from carproof.command_line.options import gathered, options_given, read_by
from carproof.command_line.output import show_instance
from carproof.command_line.tables import remark
from carproof.formats.layouts import MAP, layout_named
from carproof.layouts import Settings, import_layout
from carproof.layouts.settings import footprint, millimetres, seconds, speed

MOST_LINES = 8
"""The lines that are listed of a feature."""


layout_options = gathered(
    "layout",
    options_given,
    click.option("--tick", callback=read_by(seconds), help="The time of a tick, like 0.5s or 100ms.  [default: 1s]"),
    click.option(
        "--speed", callback=read_by(speed), help="The speed of vehicles, like 1.2m/s.  [default: the file's, or 1m/s]"
    ),
    click.option("--robots", type=int, help="Robots on points where vehicles may stand.  [default: the file's]"),
    click.option("--seed", type=int, help="The seed of starts and goals.  [default: 0]"),
    click.option("--requests", type=InputFile(), help="CSV with the columns robot, start, goal and release."),
    click.option(
        "--footprint",
        callback=read_by(footprint),
        help="The size of vehicles, 900x600mm or a radius like 450mm, to keep them apart.",
    ),
    click.option(
        "--turning",
        callback=read_by(partial(seconds, name="turning")),
        help="The time of a quarter turn, like 2s.  [default: vehicles turn at once]",
    ),
)
order_options = gathered(
    "orders",
    options_given,
    click.option("--at", type=click.IntRange(min=0), help="The tick at which orders are sent.  [default: 0]"),
    click.option("--since", type=click.IntRange(min=0), help="The tick of the orders that are updated."),
    click.option(
        "--unit",
        callback=read_by(partial(millimetres, name="unit")),
        help="The unit of positions in orders, like 1m.  [default: 1mm]",
    ),
)


def show_layout(
    name: str, format: str | None, options: dict[str, Any], after_goal: AfterGoal, output: Output
) -> Answer:
    """Make an instance of a layout, write it, and list what it does not express."""
    if output.as_json and output.file is None:
        raise click.UsageError("--json lists what is not expressed; give the instance a file by -o.")
    if (requests := options.get("requests")) is not None:
        if "robots" in options or "seed" in options:
            raise click.UsageError("--requests has the robots, so --robots and --seed do not apply.")
        options = {**options, "requests": read_bytes(requests), "requests_file": shown(requests)}
    settings = Settings(after_goal=after_goal, **options)
    data = read_bytes(name, layouts=True)
    if layout_named(data) == MAP:
        raise click.UsageError(f"{shown(name)}: this is {MAP}: give its scenario too.")
    imported = import_layout(data, shown(name), format, settings)
    if output.as_json and output.file is not None:
        write_whole(output.file, write_instance(imported.instance))
        notes = [{"feature": each.feature, "lines": [*each.lines]} for each in imported.notes]
        document = {"format": imported.format, "not_expressed": notes}
        print_document(json.dumps(document, ensure_ascii=False).encode() + b"\n")
    else:
        show_instance(imported.instance, output)
        for each in imported.notes:
            lines = ", ".join(map(str, each.lines[:MOST_LINES])) + (", ..." if len(each.lines) > MOST_LINES else "")
            where = f"line {lines}" if len(each.lines) == 1 else f"{len(each.lines)} times, lines {lines}"
            remark(f"{shown(name)}: not expressed: {each.feature} ({where})")
    return Answer.YES
