"""The options of layouts, the reading of their files, and the list of what an instance does not express."""

import json
from dataclasses import dataclass

import click

from carp_spec import AfterGoal
from carp_spec.documents.instances import write_instance
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, print_document, read_bytes, shown, write_whole
from carproof.command_line.options import gathered
from carproof.command_line.output import show_instance
from carproof.command_line.tables import remark
from carproof.layouts import READERS, Imported, Settings, import_layout
from carproof.layouts.settings import footprint, seconds, speed

MOST_LINES = 8
"""The lines that are listed of a feature."""


@dataclass(frozen=True, slots=True)
class LayoutOptions:
    """The options that were given."""

    tick: str | None
    speed: str | None
    robots: int | None
    seed: int | None
    requests: str | None
    footprint: str | None
    turning: str | None


def layout_formats() -> str:
    """The formats with their descriptions."""
    return "; ".join(f"{each.name}: {each.description}" for each in READERS.values())


layout_options = gathered(
    "layout",
    LayoutOptions,
    click.option("--tick", help="The time of a tick, like 0.5s or 100ms.  [default: 1s]"),
    click.option("--speed", help="The speed of vehicles, like 1.2m/s.  [default: the file's, or 1m/s]"),
    click.option("--robots", type=int, help="Robots on points where vehicles may stand.  [default: the file's]"),
    click.option("--seed", type=int, help="The seed of starts and goals.  [default: 0]"),
    click.option("--requests", type=InputFile(), help="CSV with the columns robot, start, goal and release."),
    click.option("--footprint", help="The size of vehicles, 900x600mm or a radius like 450mm, to keep them apart."),
    click.option("--turning", help="The time of a quarter turn, like 2s.  [default: vehicles turn at once]"),
)


def show_layout(name: str, format: str | None, options: LayoutOptions, after_goal: AfterGoal, output: Output) -> Answer:
    """Make an instance of a layout, write it, and list what it does not express."""
    if output.as_json and output.file is None:
        raise click.UsageError("--json lists what is not expressed; give the instance a file by -o.")
    if options.requests is not None and (options.robots is not None or options.seed is not None):
        raise click.UsageError("--requests has the robots, so --robots and --seed do not apply.")
    default = Settings()
    settings = Settings(
        default.tick if options.tick is None else seconds(options.tick),
        None if options.speed is None else speed(options.speed),
        options.robots,
        options.seed or 0,
        None if options.requests is None else read_bytes(options.requests),
        after_goal,
        None if options.footprint is None else footprint(options.footprint),
        None if options.turning is None else seconds(options.turning, "turning"),
        "requests" if options.requests is None else shown(options.requests),
    )
    imported = import_layout(read_bytes(name, layouts=True), shown(name), format, settings)
    if output.as_json and output.file is not None:
        write_whole(output.file, write_instance(imported.instance))
        print_document(json.dumps(_document(imported), ensure_ascii=False).encode() + b"\n")
    else:
        show_instance(imported.instance, output)
        for each in imported.notes:
            lines = ", ".join(map(str, each.lines[:MOST_LINES])) + (", ..." if len(each.lines) > MOST_LINES else "")
            where = f"line {lines}" if len(each.lines) == 1 else f"{len(each.lines)} times, lines {lines}"
            remark(f"{shown(name)}: not expressed: {each.feature} ({where})")
    return Answer.YES


def _document(imported: Imported) -> dict[str, object]:
    notes = [{"feature": each.feature, "lines": list(each.lines)} for each in imported.notes]
    return {"format": imported.format, "not_expressed": notes}
