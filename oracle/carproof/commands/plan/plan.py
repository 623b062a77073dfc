"""`carproof plan`: plan all robots of an instance."""

from time import perf_counter
from typing import Any

import click

from carp_spec import Refusal, violations_of
from carp_spec.documents.solutions import write_solution
from carp_spec.inputs.options import require_polish_options
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, naming, read_instance_file
from carproof.command_line.options import (
    PLANNER_OPTIONS,
    gives_plans,
    instance_argument,
    listed,
    planner_option,
    planner_options,
)
from carproof.command_line.output import show_found, show_solution
from carproof.command_line.time_left import time_left, time_of_compiling
from carproof.engines import engine_named, fastest_with, plan_showing, repaired, repairs_by_default
from carproof.planner_options import planner_named
from carproof.progress import found_so_far, search_progress

FOR_FIRST_PLANS = 0.15
"""The seconds that the search for plans gets at least, however few are left."""


@listed(
    "Plan all robots of an instance.",
    "carproof plan town.json",
    "carproof plan town.json --seconds 10 -o plans.json",
    "carproof plan town.json --m 6 -o plans.json",
    "carproof plan town.json --planner shuffled --attempts 100 --seed 1",
    "carproof plan town.json --planner fixed-paths --k 5 --paths disjoint",
    "carproof generate grid --robots 50 | carproof plan - --json > plans.json",
)
@instance_argument
@planner_option
@planner_options
@click.option(
    "--repair/--no-repair",
    default=None,
    help="Plan robots that are left out together with others.  [default: after neighbourhood, if not --no-baseline]",
)
@click.option("--seconds", type=float, help="Give the best plans found in this time, by all means at hand.")
@click.option("--iterations", type=int, help="The same by first plans and this many rounds, in place of a time.")
@gives_plans
@click.pass_context
def command(  # noqa: PLR0913 - one parameter for each argument and option
    context: click.Context,
    /,
    *,
    instance: str,
    planner: str,
    repair: bool | None,
    seconds: float | None,
    iterations: int | None,
    engine: str | None,
    output: Output,
    options: dict[str, Any],
) -> Answer:
    """Plan all robots of INSTANCE, a document or - for standard input.

    An option that is not given keeps the planner's default; one that the planner does not have is refused. If the
    planner leaves robots out, rounds of a polish, joint plans of a few robots and other orders repair that. Robots that
    stay unplanned are listed with the reason.

    With --seconds, the first plans are those of CARP or of a search over the places of all robots (LaCAM), and large
    neighbourhood search improves them until the time is over; what the machine does in that time decides the plans.
    The time is that of the whole command, but for compiling the planner, which happens once. Robots for which it is
    too short are left out. Equal --iterations and --seed give equal plans on every machine.

    Exit codes: 0 every robot has a plan, 1 some robot has none, 2 bad input.
    """
    if seconds is not None or iterations is not None:
        _refuse_planner_options(context)
        return _plan_within(context, instance, seconds, iterations, options.get("seed", 0), output)
    chosen = planner_named(planner, options)
    problem = read_instance_file(instance)
    engine = engine or fastest_with(chosen)
    engine_named(engine)  # compiled before the clock starts
    started = perf_counter()
    with naming(instance):
        solution, fleet = plan_showing("planning", engine, problem, chosen)
        name = chosen.name
        if solution.unplanned and (repairs_by_default(chosen) if repair is None else repair):
            solution, fleet = repaired(problem, solution), None
            name += ", repaired"
            for violation in violations_of(problem, solution.plans):
                raise AssertionError(violation)
    seconds = perf_counter() - started
    if output.write(write_solution(solution)):
        show_solution(problem, solution, name, seconds, fleet)
    return Answer.of(not solution.unplanned)


def _refuse_planner_options(context: click.Context) -> None:
    """Refuse options that a search within a time does not have."""
    for name in (*(each for each in PLANNER_OPTIONS if each != "seed"), "planner", "repair", "engine"):
        source = context.get_parameter_source(name)
        if source is not None and source is not click.core.ParameterSource.DEFAULT:
            message = f"--seconds and --iterations choose among planners by themselves, so there is no --{name}"
            raise Refusal("option", f"$.{name}", "planner/options", message)


def _plan_within(
    context: click.Context,
    name: str,
    seconds: float | None,
    iterations: int | None,
    seed: int,
    output: Output,
) -> Answer:
    from carp_optimized.improve.anytime import plan_within  # noqa: PLC0415 - numba is slow to load

    require_polish_options(iterations, seconds, seed)
    compiling = time_of_compiling()
    problem = read_instance_file(name)
    played = 0
    with naming(name), search_progress("planning", iterations, seconds) as show:

        def advance(rounds: int, unplanned: int, total: int) -> None:
            nonlocal played
            played = rounds
            show(rounds, found_so_far(total, 0, unplanned))

        left = time_left(context, seconds, compiling)
        left = None if left is None else max(left, FOR_FIRST_PLANS)
        found = plan_within(
            problem, iterations=iterations, seconds=left, seed=seed, advance=advance, finish=write_solution
        )
    if output.write(write_solution(found.solution)):
        time = perf_counter() - context.find_root().obj - compiling
        show_found(problem, found, f"best of {played} rounds", time)
    return Answer.of(not found.solution.unplanned)
