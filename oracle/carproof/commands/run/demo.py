"""`carproof demo`: make, plan and check, on the paper's map and on a MovingAI one."""

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from time import perf_counter

import click

from carp_spec import Carp, Instance, Neighbourhood, Planner, judge, total_cost
from carp_spec.documents.instances import write_instance
from carp_spec.documents.solutions import write_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import OutputFile, write_whole
from carproof.command_line.options import listed
from carproof.command_line.tables import print_line, print_table
from carproof.engines import plan_showing, sum_of_shortest_paths
from carproof.formats.movingai import read_movingai
from carproof.generate import Fleet, Grid, grid_instance

COLUMNS = ("instance", "planner", "robots", "unplanned", "total\ncost", "shortest\npaths", "rules\nbroken", "time")
PLANNERS: dict[str, Planner] = {"carp": Carp(), "neighbourhood m=4": Neighbourhood(m=4)}


@listed("Make, plan and check two instances.", "carproof demo", "carproof demo /tmp/somewhere")
@click.argument("folder", type=click.Path(file_okay=False, path_type=Path), default=Path("demo"))
def command(folder: Path) -> Answer:
    """Make, plan and check two instances, in FOLDER (demo if none is named).

    One is the paper's 20 x 20 map number 20 with 100 robots, the other a small warehouse in MovingAI's format.
    Both are planned by CARP and by the paper's neighbourhood planner; a table compares the two.

    Exit codes: 0 no plan breaks a rule, 1 one does, 2 the folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise click.ClickException(f"{folder}: it cannot be made: {error.strerror}") from error
    instances = {"paper": grid_instance(Grid(), Fleet()), "depot": depot(folder)}
    for planner in PLANNERS.values():  # compile what is not compiled yet, before any time is measured
        plan_showing("", None, instances["depot"], planner)
    results: list[tuple[Sequence[object], bool]] = []
    for name, instance in instances.items():
        write_whole(_file(folder / f"{name}.json"), write_instance(instance))
        results += [planned(folder, name, instance, planner) for planner in PLANNERS]
    print_table(COLUMNS, [row for row, _ in results], numbers=COLUMNS[2:])
    click.echo()
    print_line(f"The instances and their plans are in {folder}. To look further:")
    print_line(f"  carproof check {folder}/paper.json {folder}/paper-carp.json")
    print_line(f"  carproof plan {folder}/depot.json --planner shuffled --attempts 100")
    return Answer.of(all(is_right for _, is_right in results))


def depot(folder: Path) -> Instance:
    """Copy the MovingAI files that carproof ships into the folder, and convert them."""
    map, scenario = ((files("carproof") / "examples" / name).read_bytes() for name in ("depot.map", "depot.scen"))
    write_whole(_file(folder / "depot.map"), map)
    write_whole(_file(folder / "depot.scen"), scenario)
    return read_movingai(map, scenario)


def planned(folder: Path, name: str, instance: Instance, planner: str) -> tuple[Sequence[object], bool]:
    """Plan an instance, check the plans and write them; a row of the table, and whether no rule is broken."""
    started = perf_counter()
    solution, fleet = plan_showing(f"{name}, {planner}", None, instance, PLANNERS[planner])
    seconds = perf_counter() - started
    write_whole(_file(folder / f"{name}-{planner.split(maxsplit=1)[0]}.json"), write_solution(solution))
    verdict = judge(instance, solution)
    counts = (len(instance.robots), verdict.unplanned, total_cost(instance, solution.plans))
    shortest = sum_of_shortest_paths(instance, (plan.robot for plan in solution.plans), fleet)
    return (name, planner, *counts, shortest, len(verdict.violations), f"{seconds:.2f} s"), verdict.valid


def _file(path: Path) -> Path:
    return OutputFile().convert(str(path), None, None)
