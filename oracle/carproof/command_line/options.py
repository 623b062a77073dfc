"""Arguments and options that several commands share."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields
from functools import wraps
from typing import Any, TypeVar, cast

import click

from carp_spec import FixedPaths, Instance, Neighbourhood, RobotId, Shuffled, Solution
from carp_spec.inputs.options import SEARCH_SECONDS
from carp_spec.requests import require_tick, sound_solution
from carproof.command_line.files import (
    STANDARD_OUTPUT,
    WRITTEN,
    InputFile,
    Output,
    OutputFile,
    naming,
    naming_documents,
    read_instance_file,
    read_solution_file,
)
from carproof.engines import ENGINES
from carproof.generate import Range
from carproof.planner_options import PLANNERS, planner_named
from carproof.requests import robot_called

F = TypeVar("F", bound=Callable[..., Any])


class RangeType(click.ParamType[Range]):
    """A whole number, or LOW..HIGH."""

    name = "range"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Range:  # noqa: ANN401 - click's own signature
        """Read `2` or `1..3`."""
        if isinstance(value, Range):
            return value
        low, dots, high = value.partition("..")
        try:
            return Range(int(low), int(high if dots else low))
        except ValueError:
            self.fail(f"{value!r} must be a whole number or LOW..HIGH, like 1..3.", param, ctx)


def gathered(name: str, make: Callable[..., Any], *options: Callable[[Any], Any]) -> Callable[[F], F]:
    """Arguments and options, which a command gets as the one value that is made of them."""

    def decorate(function: F) -> F:
        @wraps(function)
        def command(**given: Any) -> object:  # noqa: ANN401 - the command's own
            taken = {each.name: given.pop(each.name) for each in own}
            return function(**{name: make(**taken)}, **given)

        wrapped: Any = command
        for option in reversed(options):
            wrapped = option(wrapped)
        own = wrapped.__click_params__[-len(options) :]
        return cast("F", wrapped)

    return decorate


def options_given(**options: object) -> dict[str, Any]:
    """The options that were given, by name."""
    return {name: value for name, value in options.items() if value is not None}


def read_by(read: Callable[[str], object]) -> Callable[[click.Context, click.Parameter, str | None], object]:
    """The callback of an option whose text is read by a function, which may raise `Refusal`."""
    return lambda _, __, text: None if text is None else read(text)


def examples(*lines: str) -> str:
    """The end of a command's help: examples, printed as they are."""
    return "\n".join(["\b", "Examples:", *(f"  {line}" for line in lines)])


def listed(summary: str, *lines: str) -> Callable[[Callable[..., Any]], click.Command]:
    """The decorator of a command, which has a line in the list of commands, and examples at the end of its help."""
    return click.command(short_help=summary, epilog=examples(*lines))


def _alone(context: click.Context, param: click.Parameter, as_json: bool) -> bool:
    """Refuse --json where another option writes to standard output."""
    if as_json and context.meta.setdefault(WRITTEN, {}).setdefault(STANDARD_OUTPUT, param) is not param:
        raise click.BadParameter("another option writes to standard output too.", context, param)
    return as_json


instance_argument = click.argument("instance", type=InputFile())
solution_argument = click.argument("solution", type=InputFile())
trace_argument = click.argument("trace", type=InputFile())
output_option = click.option(
    "--output",
    "-o",
    "file",
    type=OutputFile(),
    help="Write the document to this file, whole or not at all; - is standard output.",
)
json_option = click.option(
    "--json",
    "as_json",
    is_flag=True,
    callback=_alone,
    help="Print the document on standard output, and nothing else.",
)
output_options = gathered("output", Output, output_option, json_option)
kernel_option = click.option("--kernel", is_flag=True, help="Let the proved kernel decide; `make kernel` builds it.")
engine_option = click.option(
    "--engine",
    type=click.Choice(ENGINES),
    help="The compiled planner, or the one to read; their plans are the same.  [default: optimized, and reference for "
    "planners that only it has]",
)
now_option = click.option(
    "--now",
    type=int,
    default=0,
    help="The tick at which the request is made; robots keep what they have done by then.",
)


@dataclass(frozen=True, slots=True)
class Asked:
    """A robot of an instance that is asked for beside plans, and the tick of the request."""

    instance: str
    solution: str
    robot: str
    now: int

    def read(self, *, for_query: bool = False) -> tuple[Instance, Solution, RobotId]:
        """The instance, its solution, which breaks no rule, and the robot.

        For a query, the plan of the robot itself may break rules together with those of others.
        """
        require_tick(self.now)
        problem, given = read_instance_file(self.instance), read_solution_file(self.solution)
        id = robot_called(problem, self.robot)
        with naming(self.solution):
            return problem, sound_solution(problem, given, id if for_query else None), id

    def naming(self) -> AbstractContextManager[None]:
        """Name the file that a planner refuses."""
        return naming_documents(self.instance, self.solution)


asks_for_a_robot = gathered("asked", Asked, instance_argument, solution_argument, click.argument("robot"), now_option)


def gives_plans(function: F) -> F:
    """--engine, and where the new plans go."""
    return engine_option(output_options(function))


limit_option = click.option(
    "--limit", type=click.IntRange(min=1), default=SEARCH_SECONDS, help="The seconds that it may take."
)
planner_option = click.option(
    "--planner", metavar="NAME", default=Neighbourhood.name, help=f"One of {', '.join(PLANNERS)}."
)


def _option(flags: str, help: str, default: object, **settings: Any) -> Callable[[Any], Any]:  # noqa: ANN401 - click's
    """An option that is `None` where it is not given; the planner's default is shown."""
    return click.option(flags, default=None, help=f"{help}  [default: {default}]", **settings)


PLANNER_OPTIONS: dict[str, Callable[[Any], Any]] = {
    "m": _option("--m", "neighbourhood: how many robots are replanned together.", Neighbourhood().m, type=int),
    "sample": _option("--sample", "neighbourhood: how many of their orders are tried.", "all", type=int),
    "seed": _option("--seed", "neighbourhood, shuffled: the seed of random orders.", Neighbourhood().seed, type=int),
    "baseline": _option(
        "--baseline/--no-baseline", "neighbourhood: try to keep all plans; without, as the paper.", "--baseline"
    ),
    "fallback": _option("--fallback", "neighbourhood: attempts of shuffled if nothing is found.", "none", type=int),
    "attempts": _option("--attempts", "shuffled: how many orders are tried.", Shuffled().attempts, type=int),
    "k": _option("--k", "fixed-paths: how many paths of each robot.", FixedPaths().k, type=int),
    "paths": _option("--paths", "fixed-paths: shortest or disjoint.", FixedPaths().paths, metavar="KIND"),
}
"""The options of all planners; one that is not given keeps its planner's default."""
planner_options = gathered("options", options_given, *PLANNER_OPTIONS.values())
neighbourhood_options = gathered(
    "planner",
    lambda **options: planner_named(Neighbourhood.name, options_given(**options)),
    *(PLANNER_OPTIONS[each.name] for each in fields(Neighbourhood)),
)
