"""What commands share that read and write other planners' files: their options, and how the files are read."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import click

from carp_spec import AfterGoal, Instance, Solution
from carproof.adapters import ADAPTERS, read_foreign_solution
from carproof.files import InputFile, read_bytes, shown
from carproof.movingai import movingai_instance, read_map, read_scenario

F = TypeVar("F", bound=Callable[..., Any])
AGENTS_HELP = "The first N of the scenario's agents.  [default: all]"


def formats() -> str:
    """The formats, each with what it is."""
    return "; ".join(f"{each.name}: {each.description}" for each in ADAPTERS.values())


def from_option(function: F) -> F:
    """`--from`: the format of the solution."""
    help = f"The format of SOLUTION. {formats()}.  [default: the one that it looks like]"
    return click.option("--from", "format", type=click.Choice([*ADAPTERS]), metavar="FORMAT", help=help)(function)


def movingai_options(function: F) -> F:
    """`--map`, `--scen` and `--agents`: a benchmark in place of an instance."""
    for option in (
        click.option("--agents", type=click.IntRange(min=0), help=AGENTS_HELP),
        click.option("--scen", type=InputFile(), help="A MovingAI scenario, with --map."),
        click.option("--map", type=InputFile(), help="A MovingAI map, in place of INSTANCE; robots park."),
    ):
        function = option(function)
    return function


@dataclass(frozen=True, slots=True)
class MovingAI:
    """A MovingAI benchmark: the files' names, how many agents, and what they do after their goals."""

    map: str
    scen: str
    agents: int | None
    after_goal: AfterGoal = "park"

    @classmethod
    def of(cls, map: str | None, scen: str | None, agents: int | None) -> "MovingAI | None":
        """The benchmark of the options, `None` if they are not given; some of them alone are refused."""
        if map is None and scen is None and agents is None:
            return None
        if map is None or scen is None:
            raise click.UsageError("--map and --scen go together, and --agents with them.")
        return cls(map, scen, agents)

    @property
    def names(self) -> tuple[str, str]:
        """The files' names."""
        return (self.map, self.scen)


def read_movingai(benchmark: MovingAI) -> Instance:
    """Read an instance from a MovingAI map and scenario."""
    map, scen = benchmark.names
    grid = read_map(read_bytes(map), shown(map))
    robots = read_scenario(read_bytes(scen), grid, benchmark.agents, shown(scen))
    return movingai_instance(grid, robots, benchmark.after_goal, shown(map))


def read_solution_of(instance: Instance, name: str, format: str | None) -> Solution:
    """Read a solution in any planner's format from a file or standard input."""
    return read_foreign_solution(read_bytes(name), instance, shown(name), format)
