"""`carproof execution untangle`: a solution that robots can follow in order."""

from time import perf_counter

import click

from carp_spec import total_cost
from carp_spec.documents.solutions import write_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, naming_documents, read_sound
from carproof.command_line.options import gives_plans, instance_argument, listed, solution_argument
from carproof.command_line.tables import print_table, remark
from carproof.command_line.time_left import time_left
from carproof.engines import engine_named
from carproof.execution.untangling import untangle
from carproof.requests import deadline


@listed("Remove rotations from plans.", "carproof execution untangle town.json plans.json -o in-order.json")
@instance_argument
@solution_argument
@click.option("--seconds", type=float, help="The time of the whole command.")
@gives_plans
@click.pass_context
def command(
    context: click.Context,
    *,
    instance: str,
    solution: str,
    seconds: float | None,
    engine: str | None,
    output: Output,
) -> Answer:
    """Replan robots of SOLUTION until no robots enter each other's places in a circle.

    In each such rotation, the robot is replanned whose plan becomes longer by the least; the others keep their plans.
    With --seconds, rotations that there is no time for stay in the plans.

    Exit codes: 0 no rotation is left, 1 no robot of a rotation finds another plan, and nothing is written, 2 bad input,
    3 the time was over, and rotations may be left.
    """
    reading = perf_counter()
    problem, sound = read_sound(instance, solution)
    reading = perf_counter() - reading
    chosen = engine_named(engine)
    until = deadline(time_left(context, seconds, ending=reading))  # a query takes no longer, nor does writing
    with naming_documents(instance, solution):
        found = untangle(problem, sound, chosen, lambda: perf_counter() < until)
    if found.rotation and not found.undecided:
        names = ", ".join(map(str, found.rotation))
        remark(f"Out of the rotation of the robots {names} none finds another plan.")
        return Answer.NO
    if output.write(write_solution(found.solution)):
        columns = ["robots", "rotations removed", "total cost", "extra"]
        row = [len(sound.plans), found.rounds, total_cost(problem, found.solution.plans), found.extra]
        print_table(columns, [row], numbers=columns)
    if found.undecided:
        remark("The time was over, and rotations may be left.")
        return Answer.UNDECIDED
    return Answer.YES
