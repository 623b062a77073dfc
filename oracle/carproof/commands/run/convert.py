"""`carproof convert`: instances of benchmarks and layouts, and solutions in the formats of other tools."""

from pathlib import Path
from typing import get_args

import click

from carp_spec import AfterGoal
from carproof.command_line.answer import Answer
from carproof.command_line.files import (
    STANDARD_INPUT,
    InputFile,
    print_document,
    read_bytes,
    read_instance_file,
    refuse_two_standard_inputs,
    write_whole,
)
from carproof.command_line.foreign import AGENTS_HELP, MovingAI, formats, read_movingai, read_solution_of
from carproof.command_line.layouts import LayoutOptions, layout_formats, layout_options, show_layout
from carproof.command_line.options import examples, json_option, output_option
from carproof.command_line.output import show_instance
from carproof.formats import ADAPTERS, write_foreign_solution
from carproof.layouts import READERS


@click.command(
    short_help="Convert layouts, MovingAI files and solutions.",
    epilog=examples(
        "carproof convert plant.xml --robots 10 --tick 0.5s -o plant.json",
        "carproof convert demo/depot.map demo/depot.scen -o depot.json",
        "carproof convert town.map town.scen --agents 40 | carproof plan -",
        "carproof convert town.json plans.json --to lacam -o result.txt",
        "carproof convert town.json result.txt --to carproof -o plans.json",
    ),
)
@click.argument("first", metavar="LAYOUT|MAP|INSTANCE", type=InputFile())
@click.argument("second", metavar="[SCEN|SOLUTION]", type=InputFile(), required=False)
@click.option("--agents", type=click.IntRange(min=0), help=AGENTS_HELP)
@click.option(
    "--after-goal",
    type=click.Choice(get_args(AfterGoal)),
    help="Robots vanish or park after their goals.  [default: park]",
)
@click.option("--to", type=click.Choice([*ADAPTERS]), metavar="FORMAT", help="Convert a solution to this format.")
@click.option(
    "--from",
    "format",
    type=click.Choice([*READERS, *ADAPTERS]),
    metavar="FORMAT",
    help=f"The format of LAYOUT or SOLUTION. {layout_formats()}; {formats()}.  [default: the one that it looks like]",
)
@layout_options
@output_option
@json_option
def command(  # noqa: PLR0913 - one parameter for each argument and option
    *,
    first: str,
    second: str | None,
    agents: int | None,
    after_goal: AfterGoal | None,
    to: str | None,
    format: str | None,
    output: Path | None,
    as_json: bool,
    layout: LayoutOptions,
) -> Answer:
    """Make an instance of a layout or of a MovingAI .map and .scen file, or convert a solution of an instance by --to.

    Points and lanes of a layout become resources, and what only one vehicle may use becomes a group. What the instance
    does not express is listed on standard error, or by --json beside -o, with the lines of the file.

    With --after-goal park, the default, an instance is classical multi-agent path finding: 4-connected, capacities and
    durations of one, and the cost is the sum of costs. The scenario's lengths are for octile moves and are not used.

    With --to, the files are INSTANCE and SOLUTION. Other planners' formats hold plans of robots that are present from
    tick 0 and park, on resources with positions. A solution that breaks a rule, or that the format cannot express, is
    refused.

    The result goes to standard output, or with -o to a file.
    """
    if second is None:
        if agents is not None or to is not None:
            raise click.UsageError("--agents concerns a scenario and --to a solution: give a second file.")
        return show_layout(first, format, layout, after_goal or "park", output, as_json=as_json)
    if layout.given:
        raise click.UsageError(f"{layout.given} concerns a layout, which is one file.")
    refuse_two_standard_inputs(first, second)
    if to is None:
        if format is not None:
            raise click.UsageError("--from and --to concern a solution.")
        if first != STANDARD_INPUT and read_bytes(first).lstrip().startswith(b"{"):
            raise click.UsageError(f"{first} is no map; to convert a solution of an instance, name a format by --to.")
        return show_instance(read_movingai(MovingAI(first, second, agents, after_goal or "park")), output, as_json)
    if agents is not None or after_goal is not None or as_json:
        raise click.UsageError("--agents, --after-goal and --json concern instances, and --to concerns a solution.")
    instance = read_instance_file(first)
    data = write_foreign_solution(instance, read_solution_of(instance, second, format), to)
    if output is None:
        print_document(data)
    else:
        write_whole(output, data)
    return Answer.YES
