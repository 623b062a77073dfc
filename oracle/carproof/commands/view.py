"""`carproof view`: a solution to look at."""

from pathlib import Path

import click

from carproof.answer import Answer
from carproof.files import (
    naming,
    read_instance_file,
    read_solution_file,
    refuse_two_standard_inputs,
    shown,
)
from carproof.options import examples, instance_argument, output_option, solution_argument
from carproof.results import write_result
from carproof.tables import print_table
from carproof.viewer.page import page
from carproof.viewer.stills import chart_still, map_still


@click.command(
    short_help="Show plans on the map, in one HTML file.",
    epilog=examples(
        "carproof view town.json plans.json -o plans.html",
        "carproof view town.json plans.json --at 12 -o tick-12.svg",
        "carproof view town.json plans.json --chart -o chart.svg",
        "carproof plan town.json --json | carproof view town.json - -o plans.html",
    ),
)
@instance_argument
@solution_argument
@click.option("--at", type=int, metavar="TICK", help="Draw the map at this tick, as a still SVG.")
@click.option("--chart", is_flag=True, help="Draw the chart of resources by time, as a still SVG.")
@output_option
def command(instance: str, solution: str, at: int | None, chart: bool, output: Path | None) -> Answer:
    """Show the plans of SOLUTION on the map of INSTANCE, in one HTML file that needs no network.

    The page has the map with its robots moving, the chart of resources by time with its free windows, and all
    broken rules; a broken solution is shown like any other. Its keys are listed in it. Resources without
    positions of their own are laid out. The file goes to standard output, or with -o to a file.

    Exit codes: 0 it is drawn, 2 bad input, or more than a picture can show.
    """
    if at is not None and chart:
        raise click.UsageError("Only one of --at and --chart can be drawn.")
    refuse_two_standard_inputs(instance, solution)
    problem, plans = read_instance_file(instance), read_solution_file(solution)
    title = f"{Path(shown(instance)).name} · {Path(shown(solution)).name}"
    with naming(solution):
        if chart:
            drawn = chart_still(problem, plans, title)
        else:
            drawn = page(problem, plans, title) if at is None else map_still(problem, plans, at, title)
    write_result(drawn, output, as_json=output is None)
    if output is not None:
        print_table(["written", "bytes"], [[output, len(drawn)]], numbers=["bytes"])
    return Answer.YES
