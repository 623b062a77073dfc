"""`carproof view`: a solution as a page or a picture."""

from functools import partial
from pathlib import Path

import click

from carp_spec.documents.solutions import read_trace
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, naming, read_file
from carproof.command_line.foreign import Problem, solution_files
from carproof.command_line.options import listed, output_option
from carproof.command_line.tables import print_table
from carproof.viewer.limits import refuse_tick
from carproof.viewer.page import view
from carproof.viewer.scene_builder import span
from carproof.viewer.stills import view_chart, view_map

PAGE, PICTURE = (".html", ".htm"), ".svg"


@listed(
    "Show plans on the map, in one HTML file.",
    "carproof view town.json plans.json -o plans.html",
    "carproof view town.json plans.json --at 12 -o tick-12.svg",
    "carproof view town.json plans.json --chart -o chart.svg",
    "carproof view town.json -o town.svg",
    "carproof view town.json plans.json --trace trace.json -o executed.html",
    "carproof plan town.json --json | carproof view town.json - -o plans.html",
    "carproof view --map town.map --scen town.scen result.txt -o result.html",
)
@partial(solution_files, needs_solution=False)
@click.option("--at", type=int, metavar="TICK", help="Draw the map at this tick, as a still SVG.")
@click.option("--chart", is_flag=True, help="Draw the chart of resources by time, as a still SVG.")
@click.option("--trace", type=InputFile(), help="Show what has happened beside the plans; page only.")
@output_option
def command(problem: Problem, at: int | None, chart: bool, trace: str | None, file: Path | None) -> Answer:
    """Show the plans of SOLUTION on the map of INSTANCE, in one HTML file that needs no network.

    SOLUTION is in any format that check reads (--from). The page has the map with its robots moving, the chart of
    resources by time with its free windows, all broken rules, and a list of its keys. A broken solution is shown like
    any other. With --trace, robots are where the trace has them, dashed rings show where they were planned to be, and
    the rules that the trace breaks are listed if SOLUTION breaks none. Resources without positions are laid out
    automatically. The file goes to standard output, or with -o to a file.

    Without SOLUTION, the map of INSTANCE is shown with the starts and goals of its robots, as a page or, in a file that
    ends in .svg, as a picture.

    Exit codes: 0 the picture is drawn, 2 bad input, or too large for a picture.
    """
    if at is not None and chart:
        raise click.UsageError("Only one of --at and --chart can be drawn.")
    if trace is not None and (chart or at is not None):
        raise click.UsageError("--trace is for the page, without --at and --chart.")
    is_still = chart or at is not None
    if problem.solution is None and (is_still or trace is not None):
        raise click.UsageError("--at, --chart and --trace show plans: give SOLUTION too.")
    refuse_suffix(file, is_still=is_still, is_alone=problem.solution is None)
    if problem.solution is None:
        instance, solution = problem.read_instance(), None
    else:
        instance, solution, _ = problem.read(as_named=True)
    happened = None if trace is None else read_file(trace, read_trace)
    title = problem.title
    with naming(problem.solution or problem.name):
        if solution is None:
            is_picture = file is not None and file.suffix.lower() == PICTURE
            drawn = view_map(instance, title=title) if is_picture else view(instance, title=title)
        elif chart:
            drawn = view_chart(instance, solution, title=title)
        elif at is not None:
            refuse_tick(at, "--at")
            refuse_tick_without_plans(at, *span(instance, solution))
            drawn = view_map(instance, solution, at=at, title=title)
        else:
            drawn = view(instance, solution, title=title, trace=happened)
    Output(file, as_json=file is None).write(drawn)
    if file is not None:
        print_table(["written", "bytes"], [[file, len(drawn)]], numbers=["bytes"])
    return Answer.YES


def refuse_suffix(output: Path | None, *, is_still: bool, is_alone: bool) -> None:
    """Refuse a file name that promises another format than it gets; one without a suffix promises none."""
    suffix = "" if output is None else output.suffix.lower()
    allowed = (PICTURE,) if is_still else (*PAGE, PICTURE) if is_alone else PAGE
    if suffix and suffix not in allowed:
        if is_still:
            raise click.UsageError(f"{output}: --at and --chart draw a picture, in a file that ends in .svg.")
        how = "" if is_alone else " with --at TICK or --chart"
        raise click.UsageError(f"{output}: view writes a page, .html, or a picture, .svg{how}.")


def refuse_tick_without_plans(at: int, first: int, last: int) -> None:
    """Refuse a tick before or after all plans."""
    if not first <= at <= last:
        raise click.BadParameter(
            f"the plans are from tick {first} to tick {last}; {at} is not among them.", param_hint="--at"
        )
