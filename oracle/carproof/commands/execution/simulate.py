"""`carproof execution simulate`: simulations of a solution with delayed robots."""

import os
from pathlib import Path

import click

from carp_spec import Solution
from carp_spec.documents.decoding import write
from carp_spec.documents.solutions import write_solution, write_trace
from carp_spec.requests import require_tick
from carproof.command_line.answer import Answer
from carproof.command_line.files import OutputFile, print_document, read_file, read_sound, write_whole
from carproof.command_line.options import instance_argument, json_option, listed, solution_argument
from carproof.command_line.tables import print_line, print_table
from carproof.execution.delays import Delay, until
from carproof.execution.simulation import (
    DRIVERS,
    Driver,
    Execution,
    drawn_delays,
    execute,
    execution_document,
    read_delays,
)

COLUMNS = ("driver", "robots", "delays", "arrived", "late", "mean", "worst", "collisions", "standing", "switches")
MOST_SHOWN = 3


@listed(
    "Simulate robots that are delayed.",
    "carproof execution simulate town.json plans.json --delays 0.05:3",
    "carproof execution simulate town.json plans.json --driver order --trace t.json --now 9",
    "carproof execution simulate town.json plans.json --driver clock --delays delays.json",
)
@instance_argument
@solution_argument
@click.option("--driver", type=click.Choice(DRIVERS), help="How robots are driven.  [default: all three]")
@click.option("--delays", metavar="CHANCE[:TICKS]|FILE", default="0.05", help="Delays: a model, or a list in a file.")
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), default=0, help="The seed of the delays.")
@click.option("--trace", type=OutputFile(), help="Write the trace to this file; needs --driver.")
@click.option("--now", type=int, help="End the trace of --trace at this tick, while robots are under way.")
@click.option("--followed", type=OutputFile(), help="Write the solution whose order was kept; needs --driver.")
@json_option
def command(  # noqa: PLR0913 - one parameter for each argument and option
    *,
    instance: str,
    solution: str,
    driver: Driver | None,
    delays: str,
    seed: int,
    trace: Path | None,
    now: int | None,
    followed: Path | None,
    as_json: bool,
) -> Answer:
    """Execute SOLUTION with robots that need longer at some visits than planned.

    Driver `clock`: robots keep to the ticks of their own plans as well as they can. Driver `order`: a robot enters a
    resource when all have left it that are planned to leave first. Driver `switching`: a robot that waits for a late
    one may go first, where this is safe and makes the sum of arrivals smaller. --delays 0.05:3 delays each visit but a
    robot's last with a chance of 0.05 by 1 to 3 ticks; a file has a list of [robot, visit, ticks], visits counted from
    0.

    Mean and worst count the ticks by which robots arrive later than planned. Collisions are of too many robots in a
    resource or a group, and of robots that exchange places; where following is forbidden, following is none. --json
    prints the result of --driver, or without it a list of all three.

    After switches a plan of --followed may begin later than its release, which breaks plan/start; the trace is then one
    of SOLUTION no more.

    Exit codes: 0 nobody collides or stands for ever, 1 somebody does, 2 bad input.
    """
    if driver is None and not (trace is None and followed is None):
        raise click.UsageError("--trace and --followed need --driver.")
    if now is not None and trace is None:
        raise click.UsageError("--now needs --trace.")
    if now is not None:
        require_tick(now, "$.now")
    problem, sound = read_sound(instance, solution)
    chosen = delays_of(delays, sound, seed)
    executions = [execute(problem, sound, each, chosen) for each in ([driver] if driver else DRIVERS)]
    if trace is not None:
        whole = executions[0].trace
        write_whole(trace, write_trace(whole if now is None else until(whole, now)))
    if followed is not None:
        write_whole(followed, write_solution(executions[0].followed))
    if as_json:
        results = [execution_document(execution) for execution in executions]
        print_document(write(results if driver is None else results[0]))
    else:
        print_table(COLUMNS, [row_of(execution) for execution in executions], numbers=COLUMNS[1:])
        for execution in executions:
            for violation in execution.collisions[:MOST_SHOWN]:
                print_line(f"{execution.driver}: {violation}")
    return Answer.of(all(execution.is_safe for execution in executions))


def delays_of(text: str, solution: Solution, seed: int) -> tuple[Delay, ...]:
    """The delays in a file of that name, or those that a model like `0.05:3` draws."""
    if os.path.isfile(text):  # noqa: PTH113 - a long text is none
        return read_file(text, lambda data: read_delays(data, solution))
    return drawn_delays(text, solution, seed)


def row_of(execution: Execution) -> list[object]:
    """A row of the table."""
    late = [max(ticks, 0) for ticks in execution.late.values()]
    robots = len(execution.followed.plans)
    return [
        execution.driver,
        robots,
        len(execution.delays),
        robots - len(execution.standing),
        sum(ticks > 0 for ticks in late),
        f"{sum(late) / len(late):.2f}" if late else "-",
        max(late, default="-"),
        len(execution.collisions),
        len(execution.standing),
        execution.switches,
    ]
