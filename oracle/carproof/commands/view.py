"""`carproof view`: a solution as a page or a picture."""

from pathlib import Path

import click

from carp_verify.documents import read_trace
from carproof.answer import Answer
from carproof.files import InputFile, naming, read_file, refuse_two_standard_inputs
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
        "carproof view town.json plans.json --trace trace.json -o executed.html",
        "carproof plan town.json --json | carproof view town.json - -o plans.html",
        "carproof view --map town.map --scen town.scen result.txt -o result.html",
    ),
)
@solution_files
@click.option("--at", type=int, metavar="TICK", help="Draw the map at this tick, as a still SVG.")
@click.option("--chart", is_flag=True, help="Draw the chart of resources by time, as a still SVG.")
@click.option("--trace", type=InputFile(), help="Show what has happened beside the plans; page only.")
@output_option
def command(problem: Problem, at: int | None, chart: bool, trace: str | None, output: Path | None) -> Answer:
    """Show the plans of SOLUTION on the map of INSTANCE, in one HTML file that needs no network.

    SOLUTION is in any format that check reads (--from). The page has the map with its robots moving, the chart of
    resources by time with its free windows, all broken rules, and a list of its keys. A broken solution is shown like
    any other. With --trace, robots are where the trace has them, dashed rings show where they were planned to be, and
    the rules that the trace breaks are listed if SOLUTION breaks none. Resources without positions are laid out
    automatically. The file goes to standard output, or with -o to a file.

    Exit codes: 0 the picture is drawn, 2 bad input, or too large for a picture.
    """
    if at is not None and chart:
        raise click.UsageError("Only one of --at and --chart can be drawn.")
    if trace is not None and (chart or at is not None):
        raise click.UsageError("--trace is for the page, without --at and --chart.")
    refuse_two_standard_inputs(*problem.names, *([] if trace is None else [trace]))
    instance, solution = problem.read(as_named=True)
    happened = None if trace is None else read_file(trace, read_trace)
    title = problem.title
    with naming(problem.solution or ""):
        if chart:
            drawn = chart_still(instance, solution, title)
        elif at is not None:
            drawn = map_still(instance, solution, at, title)
        else:
            drawn = page(instance, solution, title, happened)
    write_result(drawn, output, as_json=output is None)
    if output is not None:
        print_table(["written", "bytes"], [[output, len(drawn)]], numbers=["bytes"])
    return Answer.YES
