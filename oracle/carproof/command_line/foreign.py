"""The options of commands that read and write other planners' files, and the reading of these files."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import click

from carp_spec import AfterGoal, Instance, Solution
from carproof.command_line.files import InputFile, naming_documents, read_bytes, read_instance_file, shown
from carproof.command_line.options import gathered
from carproof.formats import ADAPTERS, format_of, named_as, read_foreign_solution
from carproof.formats.movingai import movingai_instance, read_map, read_scenario

F = TypeVar("F", bound=Callable[..., Any])
AGENTS_HELP = "The first N of the scenario's agents.  [default: all]"


def described(formats: Mapping[str, Any]) -> str:
    """The formats with their descriptions."""
    return "; ".join(f"{name}: {each.description}" for name, each in formats.items())


from_option = click.option(
    "--from",
    "format",
    type=click.Choice([*ADAPTERS]),
    metavar="FORMAT",
    help=f"The format of SOLUTION. {described(ADAPTERS)}.  [default: the one that it looks like]",
)


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

    def read(self) -> Instance:
        """Read an instance from the map and the scenario."""
        grid = read_map(read_bytes(self.map, map=True), shown(self.map))
        robots = read_scenario(read_bytes(self.scen), grid, self.agents, shown(self.scen))
        return movingai_instance(grid, robots, self.after_goal, shown(self.map))


benchmark_options = gathered(
    "benchmark",
    MovingAI.of,
    click.option("--map", type=InputFile(), help="A MovingAI map, in place of INSTANCE; robots park."),
    click.option("--scen", type=InputFile(), help="A MovingAI scenario, with --map."),
    click.option("--agents", type=click.IntRange(min=0), help=AGENTS_HELP),
)


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
    def name(self) -> str:
        """The name of the file of the instance, or of the map."""
        return self.benchmark.map if self.benchmark else self.instance or ""

    @property
    def title(self) -> str:
        """The names of instance and solution as people know them."""
        first = self.instance or (self.benchmark.scen if self.benchmark else "")
        names = [first] if self.solution is None else [first, self.solution]
        return " · ".join(Path(shown(name)).name for name in names)

    def naming(self) -> AbstractContextManager[None]:
        """Name the file that a planner refuses."""
        return naming_documents(self.name, self.solution or "")

    def read_instance(self) -> Instance:
        """Read the instance or the benchmark."""
        return self.benchmark.read() if self.benchmark else read_instance_file(self.instance or "")

    def read(self, *, as_named: bool = False) -> tuple[Instance, Solution, str]:
        """Read both, and the solution's format.

        With `as_named`, robots of a benchmark, which has no names for them, get the names in the solution.
        """
        instance = self.read_instance()
        assert self.solution is not None  # noqa: S101 - it is asked only where there is one
        data, file = read_bytes(self.solution), shown(self.solution)
        format = self.format or format_of(data, instance, file)
        if as_named and self.benchmark:
            instance = named_as(instance, format)
        return instance, read_foreign_solution(data, instance, file, format), format


def solution_files(function: F, *, needs_solution: bool = True) -> F:
    """[INSTANCE] SOLUTION, and the options of benchmarks and formats; the command gets them as a `Problem`."""

    @wraps(function)
    def command(
        *,
        files: Sequence[str],
        benchmark: MovingAI | None,
        format: str | None,
        **others: Any,  # noqa: ANN401 - the command's own
    ) -> object:
        instances, solutions = files[: benchmark is None], files[benchmark is None :]
        if len(instances) != (benchmark is None) or not needs_solution <= len(solutions) <= 1:
            perhaps = "" if needs_solution else ", which may be left out"
            raise click.UsageError(f"Give INSTANCE and SOLUTION, or --map, --scen and SOLUTION{perhaps}.")
        problem = Problem(instances[0] if instances else None, benchmark, solutions[0] if solutions else None, format)
        return function(problem=problem, **others)

    metavar = "[INSTANCE] SOLUTION" if needs_solution else "[INSTANCE] [SOLUTION]"
    files = click.argument("files", metavar=metavar, nargs=-1, required=needs_solution, type=InputFile())
    return cast("F", files(benchmark_options(from_option(command))))
