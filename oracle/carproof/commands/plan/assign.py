"""`carproof assign`: give a robot under way or parked further stops."""

from pathlib import Path

import click

from carp_spec import Instance, Neighbourhood, Refusal, ResourceId, Stop
from carp_spec.documents.instances import write_instance
from carp_spec.documents.solutions import write_solution
from carp_spec.instance_rules import stops_are_places_to_serve
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, OutputFile, write_whole
from carproof.command_line.options import Asked, asks_for_a_robot, gives_plans, listed, neighbourhood_options
from carproof.command_line.output import show_addition
from carproof.command_line.tables import print_line
from carproof.engines import engine_named
from carproof.requests import whole_number


@listed(
    "Give a robot further stops.",
    "carproof assign hall.json plans.json r1 7,3:10 0,2 --now 12 -o next.json",
    "carproof assign hall.json plans.json r1 7,3 --now 12 --instance after.json",
)
@asks_for_a_robot
@click.argument("stops", nargs=-1, required=True, metavar="STOP...")
@click.option("--instance", "further", type=OutputFile(), help="Write INSTANCE with the further stops to this file.")
@neighbourhood_options
@gives_plans
def command(
    *,
    asked: Asked,
    stops: tuple[str, ...],
    further: Path | None,
    planner: Neighbourhood,
    engine: str | None,
    output: Output,
) -> Answer:
    """Give ROBOT further stops at the tick --now: a STOP is a resource, or RESOURCE:SERVICE with ticks of service.

    The robot is under way, or parked. It serves its stops of before first, and is planned again together with robots
    near it, as by carproof add: all keep the visits that they have made by --now. Plans with the stops belong to the
    instance with the stops, which --instance writes.

    Exit codes: 0 it got the stops, 1 no plan was found, and nothing changed, 2 bad input.
    """
    problem, before, id = asked.read()
    wanted = [stop_called(problem, each, f"$.stops[{place}].resource") for place, each in enumerate(stops)]
    with asked.naming():
        assigned, after = engine_named(engine).assign(problem, before, id, wanted, asked.now, planner)
    if further is not None:
        write_whole(further, write_instance(assigned))
    if output.write(write_solution(after)):
        if assigned is problem:
            print_line(f"robot {id} keeps its stops: no plan over further ones was found")
        else:
            show_addition(problem, before, after, id, asked.now)
    return Answer.of(assigned is not problem)


def stop_called(instance: Instance, name: str, path: str) -> Stop:
    """The stop that RESOURCE or RESOURCE:SERVICE names; if there is no such resource, a rule says so."""
    resource, _, service = name.rpartition(":")
    is_whole = any(str(id) == name for id in instance.graph.index)
    if is_whole or whole_number(service.removeprefix("-")) is None:
        return Stop(resource_called(instance, name, path))
    return Stop(resource_called(instance, resource, path), int(service))


def resource_called(instance: Instance, name: str, path: str) -> ResourceId:
    """The resource whose id prints like the name, or the name; raises `Refusal` if `1` and `"1"` both do."""
    called = [id for id in instance.graph.index if str(id) == name]
    if len(called) > 1:
        message = f"a resource's id must differ from the others when printed, and {len(called)} print as {name}"
        raise Refusal("request", path, stops_are_places_to_serve.id, message)
    return called[0] if called else name
