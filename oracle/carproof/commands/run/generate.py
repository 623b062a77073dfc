"""`carproof generate`: instances to try planners on."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any, TypeVar, get_args

import click

from carp_spec import Instance, Refusal
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output
from carproof.command_line.options import RangeType, examples, gathered, output_options
from carproof.command_line.output import show_instance
from carproof.generate import Fleet, Grid, Traits, Warehouse, grid_instance, warehouse_instance, with_headings
from carproof.generate.options import Range

F = TypeVar("F", bound=Callable[..., Any])

HELP = {
    "width": "Cells from left to right.",
    "height": "Cells from top to bottom.",
    "map": "0 is a spanning tree, 20 the full grid.",
    "map_seed": "The seed of the map.",
    "columns": "Racks from left to right.",
    "rows": "Racks from top to bottom.",
    "rack_length": "Cells of a rack from left to right.",
    "rack_depth": "Cells of a rack from top to bottom.",
    "aisle": "Cells across an aisle.",
    "stations": "Picking stations at the left side, at most one a row.",
    "start_at": "Where robots start.",
    "robots": "How many robots.",
    "seed": "The seed of the robots.",
    "after_goal": "Robots vanish or park after their goals.",
    "distinct": "Which ends of the robots are distinct.",
    "release": "Release ticks, like 0..50.",
    "pace": "Paces, like 1..2.",
    "orders": "Robots go to their goals, or pick something up before.",
    "service": "Ticks to pick it up, like 2..5.",
    "capacity": "Capacities of resources, like 1..2.",
    "duration": "Durations of resources, like 1..3.",
}


def made(name: str, default: Fleet | Grid | Traits | Warehouse) -> Callable[[F], F]:
    """The options of a dataclass, which a command gets as the one value that is made of them."""
    options = [
        click.option(
            f"--{each.name.replace('_', '-')}",
            type=_type(each.type),
            default=getattr(default, each.name),
            help=HELP[each.name],
        )
        for each in fields(default)
    ]
    return gathered(name, type(default), *options)


def _type(kind: object) -> Any:  # noqa: ANN401 - as click names types
    if kind is Range:
        return RangeType()
    return int if kind is int else click.Choice(get_args(kind))


traits_option = made("traits", Traits())
headings_option = click.option(
    "--headings", is_flag=True, help="Split cells by heading, so that robots turn as in the League."
)


@click.group(epilog=examples("carproof generate grid -o town.json", "carproof generate warehouse -o hall.json"))
def command() -> None:
    """Make an instance: a map and robots.

    The document goes to standard output, or with -o to a file. Equal options and seeds give an equal
    document, on every machine. A range is LOW..HIGH, both included.

    With --headings a cell is split into a resource for each heading, and robots drive on or turn by a quarter, each
    in the duration of the cell: the model of the League of Robot Runners 2023 and 2024.
    """


@command.command(
    epilog=examples(
        "carproof generate grid -o town.json",
        "carproof generate grid --map 10 --map-seed 7 --seed 3 | carproof plan -",
        "carproof generate grid --width 6 --height 6 --robots 12 --after-goal park",
        "carproof generate grid --robots 20 --duration 1..3 --release 0..40",
        "carproof generate grid --robots 20 --headings --after-goal park",
    )
)
@made("grid", Grid())
@made("fleet", Fleet())
@traits_option
@headings_option
@output_options
def grid(grid: Grid, fleet: Fleet, traits: Traits, headings: bool, output: Output) -> Answer:
    """Make a map of the paper.

    Map 0 is a random minimum spanning tree of the grid; map i has i twentieths of the other edges too. The
    maps of one seed are nested. Robots start and end anywhere.
    """
    return _show(grid_instance(grid, fleet, traits), headings, output)


@command.command(
    epilog=examples(
        "carproof generate warehouse -o hall.json",
        "carproof generate warehouse --columns 8 --rows 10 --robots 60 --stations 12",
        "carproof generate warehouse --start-at stations --distinct goals --release 0..99",
        "carproof generate warehouse --orders pick-and-drop --service 2..5 --after-goal park",
    )
)
@made("warehouse", Warehouse())
@made("fleet", Fleet(robots=40, distinct="starts"))
@traits_option
@headings_option
@output_options
def warehouse(warehouse: Warehouse, fleet: Fleet, traits: Traits, headings: bool, output: Output) -> Answer:
    """Make a warehouse with racks, aisles and picking stations.

    Robots go from cells beside the racks to the stations, or the other way.
    """
    return _show(warehouse_instance(warehouse, fleet, traits), headings, output)


def _show(instance: Instance, headings: bool, output: Output) -> Answer:
    if headings:
        try:
            instance = with_headings(instance)
        except Refusal as refusal:
            raise Refusal("option", "$.headings", refusal.rule, refusal.message) from refusal
    return show_instance(instance, output)
