"""`carproof generate`: instances to try planners on."""

from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, TypeVar, get_args

import click

from carp_spec import AfterGoal
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output
from carproof.command_line.options import RangeType, examples, output_options
from carproof.command_line.output import show_instance
from carproof.generate import Fleet, Grid, Traits, Warehouse, grid_instance, warehouse_instance, with_headings
from carproof.generate.options import JUST_ONE, Distinct, Orders, Side

T = TypeVar("T", Fleet, Grid, Traits, Warehouse)
F = TypeVar("F", bound=Callable[..., Any])


def fleet_options(default: Fleet) -> Callable[[F], F]:
    """The options of robots and resources, which all maps share."""
    options = [
        click.option("--robots", type=int, default=default.robots, help="How many robots."),
        click.option("--seed", type=int, default=default.seed, help="The seed of the robots."),
        click.option("--map-seed", type=int, default=0, help="The seed of the map."),
        click.option(
            "--after-goal",
            type=click.Choice(get_args(AfterGoal)),
            default=default.after_goal,
            help="Robots vanish or park after their goals.",
        ),
        click.option(
            "--distinct",
            type=click.Choice(get_args(Distinct)),
            default=default.distinct,
            help="Which ends of the robots are distinct.",
        ),
        click.option("--release", type=RangeType(), default=default.release, help="Release ticks, like 0..50."),
        click.option(
            "--orders",
            type=click.Choice(get_args(Orders)),
            default=default.orders,
            help="Robots go to their goals, or pick something up before.",
        ),
        click.option("--service", type=RangeType(), default=default.service, help="Ticks to pick it up, like 2..5."),
        click.option("--pace", type=RangeType(), default=default.pace, help="Paces, like 1..2."),
        click.option("--capacity", type=RangeType(), default=JUST_ONE, help="Capacities of resources, like 1..2."),
        click.option("--duration", type=RangeType(), default=JUST_ONE, help="Durations of resources, like 1..3."),
        click.option("--headings", is_flag=True, help="Split cells by heading, so that robots turn as in the League."),
        output_options,
    ]

    def decorate(function: F) -> F:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


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
@click.option("--width", type=int, default=20, help="Cells from left to right.")
@click.option("--height", type=int, default=20, help="Cells from top to bottom.")
@click.option("--map", type=int, default=20, help="0 is a spanning tree, 20 the full grid.")
@fleet_options(Fleet())
def grid(output: Output, headings: bool, **options: Any) -> Answer:  # noqa: ANN401 - dataclasses check them
    """Make a map of the paper.

    Map 0 is a random minimum spanning tree of the grid; map i has i twentieths of the other edges too. The
    maps of one seed are nested. Robots start and end anywhere.
    """
    instance = grid_instance(made_of(Grid, options), made_of(Fleet, options), made_of(Traits, options))
    return show_instance(with_headings(instance) if headings else instance, output)


@command.command(
    epilog=examples(
        "carproof generate warehouse -o hall.json",
        "carproof generate warehouse --columns 8 --rows 10 --robots 60 --stations 12",
        "carproof generate warehouse --start-at stations --distinct goals --release 0..99",
        "carproof generate warehouse --orders pick-and-drop --service 2..5 --after-goal park",
    )
)
@click.option("--columns", type=int, default=4, help="Racks from left to right.")
@click.option("--rows", type=int, default=5, help="Racks from top to bottom.")
@click.option("--rack-length", type=int, default=8, help="Cells of a rack from left to right.")
@click.option("--rack-depth", type=int, default=2, help="Cells of a rack from top to bottom.")
@click.option("--aisle", type=int, default=2, help="Cells across an aisle.")
@click.option("--stations", type=int, default=6, help="Picking stations at the left side.")
@click.option("--start-at", type=click.Choice(get_args(Side)), default="racks", help="Where robots start.")
@fleet_options(Fleet(robots=40, distinct="starts"))
def warehouse(output: Output, headings: bool, **options: Any) -> Answer:  # noqa: ANN401 - dataclasses check them
    """Make a warehouse with racks, aisles and picking stations.

    Robots go from cells beside the racks to the stations, or the other way.
    """
    instance = warehouse_instance(made_of(Warehouse, options), made_of(Fleet, options), made_of(Traits, options))
    return show_instance(with_headings(instance) if headings else instance, output)


def made_of(kind: type[T], options: Mapping[str, Any]) -> T:
    """Make a dataclass of options from those of the command line that it names."""
    return kind(**{each.name: options[each.name] for each in fields(kind)})
