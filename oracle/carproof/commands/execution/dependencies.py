"""`carproof execution dependencies`: the action dependency graph, and the effect of delays."""

from pathlib import Path

import click

from carp_reference.execution import order_of
from carp_spec.documents.decoding import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, OutputFile, naming, read_sound, shown, write_whole
from carproof.command_line.options import instance_argument, listed, output_options, solution_argument
from carproof.command_line.tables import print_line, print_table
from carproof.execution.delays import late_robots
from carproof.execution.simulation import DependenciesDocument, delay_named, dependencies_document, dot
from carproof.viewer.dependency_picture import dependency_still


@listed(
    "Show which visits wait, and what delays do.",
    "carproof execution dependencies town.json plans.json",
    "carproof execution dependencies town.json plans.json --delay r7:3:5",
    "carproof execution dependencies town.json plans.json --dot graph.dot",
    "carproof execution dependencies town.json plans.json --svg graph.svg",
)
@instance_argument
@solution_argument
@click.option("--delay", "delays", metavar="ROBOT:VISIT:TICKS", multiple=True, help="A delay at a visit, from 0 on.")
@click.option("--dot", "graph", type=OutputFile(), help="Write the graph for Graphviz to this file.")
@click.option("--svg", "picture", type=OutputFile(), help="Draw the graph: robots by time, with arrows between visits.")
@output_options
def command(
    *,
    instance: str,
    solution: str,
    delays: tuple[str, ...],
    graph: Path | None,
    picture: Path | None,
    output: Output,
) -> Answer:
    """Make the action dependency graph of SOLUTION: which visits wait for which if robots keep the planned order.

    The command prints the shortest cycle of the graph, if it has one; without a cycle, an execution in the planned
    order never stops. It also prints the delays of the least sum that make robots collide that keep to the clock and,
    with --delay, the robots that arrive late.

    Exit codes: 0 there is no cycle, 1 there is one, 2 bad input.
    """
    problem, sound = read_sound(instance, solution)
    asked = [delay_named(delay, problem, sound) for delay in delays]
    order = order_of(problem, sound)
    document = dependencies_document(order, late_robots(order, asked) if asked else None)
    if picture is not None:
        with naming(solution):
            drawn = dependency_still(order, f"{Path(shown(instance)).name} · {Path(shown(solution)).name}")
        write_whole(picture, drawn)
    if graph is not None:
        write_whole(graph, dot(order).encode())
    if output.write(write(document)):
        show(document)
    return Answer.of(document.acyclic)


def show(document: DependenciesDocument) -> None:
    """Print what matters to people."""
    spare = [visit.slack for visit in document.visits if visit.slack is not None]
    columns = ["visits", "dependencies", "least slack", "visits without slack", "cycle"]
    row = [len(document.visits), len(document.edges), min(spare, default="-"), spare.count(0)]
    print_table(columns, [[*row, "none" if document.acyclic else "yes"]], numbers=columns[:4])
    if document.cycle is not None:
        moves = zip(document.cycle.robots, document.cycle.resources, strict=True)
        ways = ", ".join(f"robot {robot} into {resource}" for robot, resource in moves)
        print_line(f"cycle at tick {document.cycle.tick}: {ways}")
    if document.collision is not None:
        delays = ", ".join(f"robot {robot} at visit {visit} by {ticks}" for robot, visit, ticks in document.collision)
        print_line(f"on the clock, robots collide by these delays: {delays}")
    for robot, ticks in document.late or ():
        print_line(f"robot {robot} is late by {ticks}")
    if document.late == ():
        print_line("nobody is late")
