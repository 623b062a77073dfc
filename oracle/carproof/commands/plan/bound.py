"""`carproof bound`: a lower bound on the total cost, with a certificate."""

from time import perf_counter

import click

from carp_spec import Instance, judge, total_cost
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.decoding import write
from carp_spec.inputs.options import BOUND_SECONDS, require_limits
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, naming
from carproof.command_line.foreign import MovingAI, Problem, benchmark_options, from_option, read_solution_of
from carproof.command_line.options import listed, output_options
from carproof.command_line.tables import counted, print_line, print_table
from carproof.command_line.time_left import time_left, time_of_compiling
from carproof.extras import require
from carproof.progress import found_so_far, gap, search_progress

COLUMNS = ("robots", "shortest paths", "lower bound", "total cost", "gap", "steps", "time")


@listed(
    "Find a lower bound on the total cost.",
    "carproof bound town.json -o certificate.json",
    "carproof verify town.json certificate.json",
    "carproof plan town.json -o plans.json",
    "carproof bound town.json --seconds 60 --plans plans.json",
    "carproof bound town.json --steps 500 --json",
    "carproof bound --map town.map --scen town.scen --plans result.txt",
)
@click.argument("instance", type=InputFile(), required=False)
@benchmark_options
@click.option(
    "--seconds", type=click.IntRange(min=1), help=f"The time of the whole command.  [default: {BOUND_SECONDS}]"
)
@click.option("--steps", type=click.IntRange(min=0), help="End after this many steps, whatever time they take.")
@click.option(
    "--plans",
    metavar="SOLUTION",
    type=InputFile(),
    help="Plans in any format, whose total is set against the bound.",
)
@from_option
@output_options
@click.pass_context
def command(  # noqa: PLR0913 - one parameter for each argument and option
    context: click.Context,
    *,
    instance: str | None,
    benchmark: MovingAI | None,
    seconds: int | None,
    steps: int | None,
    plans: str | None,
    format: str | None,
    output: Output,
) -> Answer:
    """Find a lower bound on the total cost of any plans for all robots of INSTANCE.

    Robots pay prices for places that they contend for. The bound is the cheapest priced paths minus the most that
    the prices can collect. --output writes the prices as a certificate, which the command verify checks. With --plans
    the table shows the gap between their total and the bound. Robots whose shortest paths there is no time for count as
    0.

    Exit codes: 0 a bound is found, 1 a robot has no way to its goal (the bound is that of the others), 2 bad input.
    """
    require("pysat")
    from carp_optimum.bound import Progress, lower_bound  # noqa: PLC0415 - loads the planners

    if (instance is None) == (benchmark is None):
        raise click.UsageError("Give INSTANCE, or --map and --scen.")
    if format is not None and plans is None:
        raise click.UsageError("--from concerns the file of --plans.")
    require_limits(seconds=seconds, steps=steps)
    given = Problem(instance, benchmark)
    problem = given.read_instance()
    known = total_of(problem, plans, format)
    limit = BOUND_SECONDS if seconds is None and steps is None else seconds
    seen: list[Progress] = []

    def keep(progress: Progress) -> None:
        seen[1:] = [progress]
        show(progress.steps, found_so_far(known, progress.bound))

    compiling = time_of_compiling()
    started = perf_counter()
    with naming(given.name), search_progress("bounding", steps, limit) as show:
        certificate = lower_bound(problem, time_left(context, limit, compiling), steps, keep)
    took = perf_counter() - started
    lost = [problem.robot[robot] for robot, least in certificate.robots if least is None]
    if output.write(write(certificate)):
        unseen = _unseen(problem, certificate)
        shortest = "-" if unseen else seen[0].bound
        numbers = [len(problem.robots), shortest, certificate.bound, "-" if known is None else known]
        row = [*numbers, "-" if known is None else gap(known, certificate.bound), seen[-1].steps, f"{took:.2f} s"]
        print_table(COLUMNS, [row], numbers=COLUMNS)
        if unseen:
            print_line(f"there was no time for the shortest paths of {counted(unseen, 'robot')}, which count as 0")
        for robot in lost:
            print_line(f"unplanned: no way leads from {robot.start} to {robot.goal}, the goal of robot {robot.id}")
    return Answer.of(not lost)


def _unseen(instance: Instance, certificate: BoundDocument) -> int:
    """How many robots count as 0 though they have to move, and are in no cut: there was no time for them."""
    cut = {robot for each in certificate.cuts for robot in each.robots}
    still = [instance.robot[robot] for robot, least in certificate.robots if least == 0 and robot not in cut]
    return sum(any(stop.resource != each.start for stop in each.stops) for each in still)


def total_of(instance: Instance, plans: str | None, format: str | None) -> int | None:
    """The total of the plans given; `None` if there are none, or they leave a robot without a plan."""
    if plans is None:
        return None
    solution = read_solution_of(instance, plans, format)
    verdict = judge(instance, solution)
    if not verdict.valid:
        raise click.ClickException(f"{plans}: plans to compare with must break no rule: {verdict.violations[0]}")
    planned = {each.robot for each in solution.plans}
    return total_cost(instance, solution.plans) if planned == set(instance.robot) else None
