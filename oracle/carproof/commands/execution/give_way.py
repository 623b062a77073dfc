"""`carproof execution give-way`: a robot with priority goes first, and the others give way."""

import click
import msgspec

from carp_spec import Refusal, ResourceId, Visit
from carp_spec.documents.solutions import write_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import InputFile, Output, naming, read_bytes
from carproof.command_line.options import Asked, asks_for_a_robot, gives_plans, listed
from carproof.command_line.tables import print_line, print_table, remark
from carproof.engines import engine_named
from carproof.execution.giving_way import give_way


@listed(
    "Let one robot go first, and plan the others around it.",
    "carproof execution give-way town.json plans.json person --now 12 -o after.json",
    "carproof execution give-way town.json plans.json person --now 12 --route route.json",
)
@asks_for_a_robot
@click.option("--route", type=InputFile(), help="A list of visits [resource, enter, leave] that ROBOT keeps to.")
@gives_plans
def command(*, asked: Asked, route: str | None, engine: str | None, output: Output) -> Answer:
    """Give ROBOT the earliest plan that the histories of the others allow, and plan the others around it.

    Robots keep the visits that they have made by --now. The command tries to change few plans of others. A robot that
    finds no plan around the earliest one keeps its own, and ROBOT goes as early as that allows.

    Exit codes: 0 no lawful update (with --route: on that route) lets ROBOT arrive earlier, 1 it goes, but perhaps not
    first, or there is no plan and nothing is written, 2 bad input.
    """
    problem, sound, id = asked.read()
    visits = None if route is None else _read_route(route)
    with asked.naming():
        found = give_way(problem, sound, id, asked.now, engine_named(engine), visits)
    for each in found.stuck:
        remark(f"Robot {each} finds no plan around the earliest one of robot {id}.")
    if found.solution is None:
        remark(f"Robot {id} gets no plan, and no other plan has changed.")
        return Answer.NO
    if output.write(write_solution(found.solution)):
        least = "no lawful update is earlier" if found.is_first else f"none is earlier than {found.least}"
        proved = least if visits is None else "on its route"
        print_line(f"robot {id} arrives at tick {found.arrival}: {proved}")
        print_table(["replanned", "later by"], found.extra.items(), numbers=["later by"])
    return Answer.of(found.is_first)


def _read_route(name: str) -> tuple[Visit, ...]:
    with naming(name):
        try:
            visits = msgspec.json.decode(read_bytes(name), type=tuple[tuple[ResourceId, int, int | None], ...])
        except msgspec.DecodeError as error:
            message = f"a route must be a list of [resource, enter, leave]: {error}"
            raise Refusal("document", "$", "document/shape", message) from error
    return tuple(Visit(*visit) for visit in visits)
