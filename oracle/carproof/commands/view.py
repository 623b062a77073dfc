"""`carproof view`: a solution as a page or a picture."""

from pathlib import Path

import click

from carproof.answer import Answer
from carproof.files import naming
from carproof.foreign import Problem, solution_files
from carproof.options import examples, output_option
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
        "carproof view --map town.map --scen town.scen result.txt -o result.html",
    ),
)
@solution_files
@click.option("--at", type=int, metavar="TICK", help="Draw the map at this tick, as a still SVG.")
@click.option("--chart", is_flag=True, help="Draw the chart of resources by time, as a still SVG.")
@output_option
def command(problem: Problem, at: int | None, chart: bool, output: Path | None) -> Answer:
    """Show the plans of SOLUTION on the map of INSTANCE, in one HTML file that needs no network.

    SOLUTION is in any format that check reads (--from). The page has the map with its robots moving, the chart of
    resources by time with its free windows, all broken rules, and a list of its keys. A broken solution is shown like
    any other. Resources without positions are laid out automatically. The file goes to standard output, or with -o to a
    file.

    Exit codes: 0 the picture is drawn, 2 bad input, or too large for a picture.
    """
    if at is not None and chart:
        raise click.UsageError("Only one of --at and --chart can be drawn.")
    instance, solution = problem.read(as_named=True)
    title = problem.title
    with naming(problem.solution or ""):
        if chart:
            drawn = chart_still(instance, solution, title)
        else:
            drawn = page(instance, solution, title) if at is None else map_still(instance, solution, at, title)
    write_result(drawn, output, as_json=output is None)
    if output is not None:
        print_table(["written", "bytes"], [[output, len(drawn)]], numbers=["bytes"])
    return Answer.YES
