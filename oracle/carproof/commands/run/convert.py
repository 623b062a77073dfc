"""`carproof convert`: instances of benchmarks and layouts, and solutions in the formats of other tools."""

from typing import Any, get_args

import click

from carp_spec import AfterGoal
from carproof.command_line.answer import Answer
from carproof.command_line.files import STANDARD_INPUT, InputFile, Output, read_bytes, read_instance_file
from carproof.command_line.foreign import AGENTS_HELP, MovingAI, described, read_solution_of
from carproof.command_line.layouts import layout_options, order_options, show_layout
from carproof.command_line.options import listed, output_options
from carproof.command_line.output import show_instance
from carproof.formats import ADAPTERS, write_foreign_solution
from carproof.formats.plans.vda5050 import VERSIONS, OrderSettings, write_orders
from carproof.layouts import READERS

FORMATS = {**READERS, **ADAPTERS}
TO_HELP = (
    "Convert a solution to this format, one of those of --from; or vda5050-2 or vda5050-3: an order of VDA 5050 for "
    "each robot, on a line of its own."
)


@listed(
    "Convert layouts, MovingAI files and solutions.",
    "carproof convert plant.xml --robots 10 --tick 0.5s -o plant.json",
    "carproof convert demo/depot.map demo/depot.scen -o depot.json",
    "carproof convert town.map town.scen --agents 40 | carproof plan -",
    "carproof convert town.json plans.json --to lacam -o result.txt",
    "carproof convert town.json result.txt --to carproof -o plans.json",
    "carproof convert plant.json plans.json --to vda5050-3 --at 12 --since 9",
)
@click.argument("first", metavar="LAYOUT|MAP|INSTANCE", type=InputFile())
@click.argument("second", metavar="[SCEN|SOLUTION]", type=InputFile(), required=False)
@click.option("--agents", type=click.IntRange(min=0), help=AGENTS_HELP)
@click.option(
    "--after-goal",
    type=click.Choice(get_args(AfterGoal)),
    help="Robots vanish or park after their goals.  [default: park]",
)
@click.option("--to", type=click.Choice([*ADAPTERS, *VERSIONS]), metavar="FORMAT", help=TO_HELP)
@click.option(
    "--from",
    "format",
    type=click.Choice([*FORMATS]),
    metavar="FORMAT",
    help=f"The format of LAYOUT or SOLUTION. {described(FORMATS)}.  [default: the one that it looks like]",
)
@order_options
@layout_options
@output_options
def command(  # noqa: PLR0913 - one parameter for each argument and option
    *,
    first: str,
    second: str | None,
    agents: int | None,
    after_goal: AfterGoal | None,
    to: str | None,
    format: str | None,
    output: Output,
    layout: dict[str, Any],
    orders: dict[str, Any],
) -> Answer:
    """Make an instance of a layout or of a MovingAI .map and .scen file, or convert a solution of an instance by --to.

    Points and lanes of a layout become resources, and what only one vehicle may use becomes a group. What the instance
    does not express is listed on standard error, or by --json beside -o, with the lines of the file.

    With --after-goal park, the default, an instance is classical multi-agent path finding: 4-connected, capacities and
    durations of one, and the cost is the sum of costs. The scenario's lengths are for octile moves and are not used.

    With --to, the files are INSTANCE and SOLUTION. Other planners' formats hold plans of robots that are present from
    tick 0 and park, on resources with positions; carproof's own documents and tables (csv) hold all plans. A solution
    that breaks a rule, or that the format cannot express, is refused.

    Orders of VDA 5050 release what a robot may enter by the planned order at the tick --at, if all robots have kept to
    their plans so far. With --since they are updates of the orders of that tick.

    The result goes to standard output, or with -o to a file.
    """
    version = VERSIONS.get(to or "")
    if version is not None and "tick" in layout:
        orders["tick"] = layout.pop("tick")
    if orders and version is None:
        raise click.UsageError(f"--{next(iter(orders))} concerns orders: --to {' or '.join(VERSIONS)}.")
    if second is None:
        if agents is not None or to is not None:
            raise click.UsageError("--agents concerns a scenario and --to a solution: give a second file.")
        return show_layout(first, format, layout, after_goal or "park", output)
    if layout:
        raise click.UsageError(f"--{next(iter(layout))} concerns a layout, which is one file.")
    if to is None:
        if format is not None:
            raise click.UsageError("--from and --to concern a solution.")
        return _show_benchmark(MovingAI(first, second, agents, after_goal or "park"), output)
    if agents is not None or after_goal is not None or output.as_json:
        raise click.UsageError("--agents, --after-goal and --json concern instances, and --to concerns a solution.")
    instance = read_instance_file(first)
    solution = read_solution_of(instance, second, format)
    if version is None:
        data = write_foreign_solution(instance, solution, to)
    else:
        data = write_orders(instance, solution, OrderSettings(version=version, **orders))
    Output(output.file, as_json=output.file is None).write(data)
    return Answer.YES


def _show_benchmark(benchmark: MovingAI, output: Output) -> Answer:
    first = benchmark.map
    if first != STANDARD_INPUT and read_bytes(first, map=True).lstrip().startswith(b"{"):
        raise click.UsageError(f"{first} is no map; to convert a solution of an instance, name a format by --to.")
    return show_instance(benchmark.read(), output)
