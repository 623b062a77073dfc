"""The options of commands that read and write other planners' files, and the reading of these files."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import click

from carp_spec import AfterGoal, Instance, Solution
from carproof.command_line.files import InputFile, read_bytes, read_instance_file, refuse_two_standard_inputs, shown
from carproof.formats import ADAPTERS, format_of, named_as, read_foreign_solution
from carproof.formats.movingai import movingai_instance, read_map, read_scenario

F = TypeVar("F", bound=Callable[..., Any])
AGENTS_HELP = "The first N of the scenario's agents.  [default: all]"


def formats() -> str:
    """The formats with their descriptions."""
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
    """A MovingAI benchmark: the files' names, the number of agents, and the policy after their goals."""

    map: str
    scen: str
    agents: int | None
    after_goal: AfterGoal = "park"

    @classmethod
    def of(cls, map: str | None, scen: str | None, agents: int | None) -> "MovingAI | None":
        """The benchmark of the options, `None` without them; an incomplete set is refused."""
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


@dataclass(frozen=True, slots=True)
class Problem:
    """An instance, or a benchmark in its place, and perhaps a solution in any format."""

    instance: str | None
    benchmark: MovingAI | None
    solution: str | None = None
    format: str | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the files."""
        instances = (self.instance or "",) if self.benchmark is None else self.benchmark.names
        return (*instances, *([] if self.solution is None else [self.solution]))

    @property
    def title(self) -> str:
        """The names of instance and solution as people know them."""
        first = self.instance or (self.benchmark.scen if self.benchmark else "")
        names = [first] if self.solution is None else [first, self.solution]
        return " · ".join(Path(shown(name)).name for name in names)

    def read_instance(self) -> Instance:
        """Read the instance or the benchmark."""
        return read_movingai(self.benchmark) if self.benchmark else read_instance_file(self.instance or "")

    def read(self, *, as_named: bool = False) -> tuple[Instance, Solution]:
        """Read both; `as_named`: robots of a benchmark, which has no names for them, get the names in the solution."""
        instance, solution, _ = self.read_with_format(as_named=as_named)
        return instance, solution

    def read_with_format(self, *, as_named: bool = False) -> tuple[Instance, Solution, str]:
        """The same with the format of the solution."""
        refuse_two_standard_inputs(*self.names)
        instance = self.read_instance()
        assert self.solution is not None  # noqa: S101 - it is asked only where there is one
        data, file = read_bytes(self.solution), shown(self.solution)
        format = self.format or format_of(data, instance, file)
        if as_named and self.benchmark:
            instance = named_as(instance, format)
        return instance, read_foreign_solution(data, instance, file, format), format


def solution_files(function: F) -> F:
    """[INSTANCE] SOLUTION, and the options of benchmarks and formats; the command gets them as a `Problem`."""
    return _with_files(function, needs_solution=True)


def instance_and_perhaps_solution(function: F) -> F:
    """The same, where the solution may be left out."""
    return _with_files(function, needs_solution=False)


def _with_files(function: F, *, needs_solution: bool) -> F:
    @wraps(function)
    def command(
        *,
        files: Sequence[str],
        map: str | None,
        scen: str | None,
        agents: int | None,
        format: str | None,
        **others: Any,  # noqa: ANN401 - the command's own
    ) -> object:
        benchmark = MovingAI.of(map, scen, agents)
        instances, solutions = files[: benchmark is None], files[benchmark is None :]
        if len(instances) != (benchmark is None) or not needs_solution <= len(solutions) <= 1:
            perhaps = "" if needs_solution else ", which may be left out"
            raise click.UsageError(f"Give INSTANCE and SOLUTION, or --map, --scen and SOLUTION{perhaps}.")
        problem = Problem(instances[0] if instances else None, benchmark, solutions[0] if solutions else None, format)
        return function(problem=problem, **others)

    metavar = "[INSTANCE] SOLUTION" if needs_solution else "[INSTANCE] [SOLUTION]"
    files = click.argument("files", metavar=metavar, nargs=-1, required=needs_solution, type=InputFile())
    return cast("F", files(movingai_options(from_option(command))))
