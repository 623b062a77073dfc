"""`carproof polish`: improve a solution by replanning neighbourhoods."""

from collections.abc import Callable
from itertools import takewhile
from math import inf
from time import perf_counter

import click

from carp_spec import Instance, Solution, check_update, total_cost, violations_of
from carp_spec.documents.solutions import write_solution
from carp_spec.inputs.options import require_polish_options
from carp_spec.polish_rules import ITERATIONS, last_round
from carp_spec.requests import require_tick, sound_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, naming, read_file
from carproof.command_line.foreign import Problem, solution_files
from carproof.command_line.options import gives_plans, listed, now_option
from carproof.command_line.output import show_not_found, show_unplanned
from carproof.command_line.tables import print_table
from carproof.command_line.time_left import HARDLY_ANY, time_left, time_of_compiling
from carproof.engines import engine_named, repaired, shortest_paths
from carproof.progress import found_so_far, gap, search_progress

AS_LONG = 2
"""Times that judging plans takes: what judging new ones, comparing them with those before and writing them takes."""
PARTS_FOR_BOUND = 4
"""The sum of shortest paths takes at most one of so many parts of the time."""
COLUMNS = ("plans", "unplanned", "total cost", "bound", "gap", "rounds", "time")


@listed(
    "Improve given plans.",
    "carproof polish town.json plans.json -o better.json",
    "carproof polish town.json plans.json --seconds 5 -o better.json",
    "carproof polish town.json plans.json --iterations 2000 --seed 7",
    "carproof polish town.json plans.json --now 12 -o better.json",
    "carproof polish town.json plans.json --bound certificate.json",
    "carproof polish --map town.map --scen town.scen result.txt -o better.json",
)
@solution_files
@click.option("--iterations", type=int, help=f"The number of rounds.  [default: {ITERATIONS}]", show_default=False)
@click.option("--seconds", type=float, help="The time of the whole command, in place of rounds.")
@click.option("--seed", type=int, default=0, help="The seed of all choices.")
@now_option
@click.option("--bound", type=InputFile(), help="The certificate of a lower bound, of `carproof bound`.")
@gives_plans
@click.pass_context
def command(  # noqa: PLR0913 - one parameter for each argument and option
    context: click.Context,
    *,
    problem: Problem,
    iterations: int | None,
    seconds: float | None,
    seed: int,
    now: int,
    bound: str | None,
    engine: str | None,
    output: Output,
) -> Answer:
    """Improve SOLUTION, plans for INSTANCE, round by round; robots without a plan get one, if it can be found.

    SOLUTION is in any format that check reads (--from); the result is carproof's document. This is large
    neighbourhood search: a round removes a few robots, replans them, and keeps the new plans if they are not worse.
    Equal --iterations and --seed give equal plans. The lower bound is the sum of the shortest paths, if there is time
    to find them, or that of --bound, which is verified first.

    With --now, robots are under way: all keep what they have done by that tick, those that have no plan get none, and
    the lower bound is about whole plans all the same.

    With --seconds, rounds may raise the total for a while (simulated annealing), and the best plans seen are the
    result; --engine keeps to rounds that never raise it. Robots that are left out are planned together with others, in
    small groups or in another order: before the annealing, or after the --iterations.

    Exit codes: 0 every robot has a plan, 1 some robot has none, 2 bad input.
    """
    require_polish_options(iterations, seconds, seed)
    require_tick(now)
    instance, given, _ = problem.read()
    judging = perf_counter()
    with naming(problem.solution or ""):
        before = sound_solution(instance, given)
    judging = perf_counter() - judging
    ending = AS_LONG * judging
    compiling = 0.0 if seconds is None else time_of_compiling()
    left = time_left(context, seconds, compiling, ending)
    until = inf if left is None else perf_counter() + left / PARTS_FOR_BOUND
    least = bound_of(instance, bound, lambda: perf_counter() < until)
    played = 0
    after = before
    started = perf_counter()
    with problem.naming(), search_progress("polishing", last_round(iterations, seconds), seconds) as show:

        def advance(rounds: int, unplanned: int, total: int) -> None:
            nonlocal played
            played = rounds
            show(rounds, found_so_far(total, least or 0, unplanned))

        polish = engine_named(engine).polish
        left = time_left(context, seconds, compiling, ending)
        if left is None or left > HARDLY_ANY:
            after = polish(instance, before, iterations=iterations, seconds=left, seed=seed, now=now, advance=advance)
        if seconds is None and now == 0:
            after = repaired(instance, after)
    time = perf_counter() - started
    if after is not before:
        for violation in (*violations_of(instance, after.plans), *check_update(before.plans, after.plans, now)):
            raise AssertionError(violation)
    if output.write(write_solution(after)):
        rows = [_row("given", instance, before, least), _row("polished", instance, after, least)]
        print_table(COLUMNS, [[*rows[0], "", ""], [*rows[1], played, f"{time:.2f} s"]], numbers=COLUMNS[1:])
        if seconds is None:
            show_unplanned(instance, after, after.unplanned)
        else:
            show_not_found(after.unplanned)
    return Answer.of(not after.unplanned)


def bound_of(instance: Instance, certificate: str | None, goes_on: Callable[[], bool]) -> int | None:
    """A lower bound on the total cost: that of the certificate, if there is one, else the sum of shortest paths.

    `None` if these are not all found while it goes on.
    """
    if certificate is None:
        if not goes_on():
            return None
        costs = [*takewhile(lambda _: goes_on(), shortest_paths(instance, instance.robot))]
        return sum(costs) if len(costs) == len(instance.robots) else None
    from carp_spec.documents.bounds import read_bound  # noqa: PLC0415 - only for those who have a certificate
    from carp_verify.bound.verify import verify_bound  # noqa: PLC0415

    return read_file(certificate, lambda data: verify_bound(instance, read_bound(data)))


def _row(name: str, instance: Instance, solution: Solution, bound: int | None) -> list[object]:
    total = total_cost(instance, solution.plans)
    near = "-" if bound is None or solution.unplanned else gap(total, bound)
    return [name, len(solution.unplanned), total, "-" if bound is None else bound, near]
