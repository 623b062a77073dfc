"""`carproof execution untangle`: a solution that robots can follow in order."""

from pathlib import Path

import click

from carp_spec import total_cost
from carp_spec.documents.solutions import write_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import read_sound
from carproof.command_line.options import examples, gives_plans, instance_argument, solution_argument
from carproof.command_line.output import write_result
from carproof.command_line.tables import print_table, remark
from carproof.engines import engine_named
from carproof.execution.untangling import untangle


@click.command(
    short_help="Remove rotations from plans.",
    epilog=examples("carproof execution untangle town.json plans.json -o in-order.json"),
)
@instance_argument
@solution_argument
@gives_plans
def command(*, instance: str, solution: str, engine: str | None, output: Path | None, as_json: bool) -> Answer:
    """Replan robots of SOLUTION until no robots enter each other's places in a circle.

    In each such rotation, the robot is replanned whose plan becomes longer by the least; the others keep their plans.

    Exit codes: 0 no rotation is left, 1 no robot of a rotation finds another plan, and nothing is written, 2 bad input.
    """
    problem, sound = read_sound(instance, solution)
    found = untangle(problem, sound, engine_named(engine))
    if found.rotation:
        names = ", ".join(map(str, found.rotation))
        remark(f"Out of the rotation of the robots {names} none finds another plan.")
        return Answer.NO
    write_result(write_solution(found.solution), output, as_json)
    if not as_json:
        columns = ["robots", "rotations removed", "total cost", "extra"]
        row = [len(sound.plans), found.rounds, total_cost(problem, found.solution.plans), found.extra]
        print_table(columns, [row], numbers=columns)
    return Answer.YES
