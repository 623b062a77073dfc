"""Arguments and options that several commands share."""

from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any, TypeVar, cast

import click

from carp_spec import FixedPaths, Neighbourhood, Planner, Shuffled
from carp_spec.inputs.options import SEARCH_SECONDS
from carproof.command_line.files import InputFile, Output, OutputFile
from carproof.engines import ENGINES
from carproof.generate import Range
from carproof.planner_options import PLANNERS, planner_named

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


def gathered(name: str, kind: type[Any], *options: Callable[[Any], Any]) -> Callable[[F], F]:
    """Options, which a command gets as one dataclass; its fields have the names of their parameters."""

    def decorate(function: F) -> F:
        @wraps(function)
        def command(**given: Any) -> object:  # noqa: ANN401 - the command's own
            taken = {each.name: given.pop(each.name) for each in fields(kind)}
            return function(**{name: kind(**taken)}, **given)

        wrapped: Any = command
        for option in reversed(options):
            wrapped = option(wrapped)
        return cast("F", wrapped)

    return decorate


def first_given(options: Any) -> str | None:  # noqa: ANN401 - a dataclass of options
    """The first option of a dataclass that was given, if any."""
    return next((f"--{each.name}" for each in fields(options) if getattr(options, each.name) is not None), None)


def examples(*lines: str) -> str:
    """The end of a command's help: examples, printed as they are."""
    return "\n".join(["\b", "Examples:", *(f"  {line}" for line in lines)])


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
    "--json", "as_json", is_flag=True, help="Print the document on standard output, and nothing else."
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


def asks_for_a_robot(function: F) -> F:
    """INSTANCE, SOLUTION and ROBOT, and --now."""
    return instance_argument(solution_argument(click.argument("robot")(now_option(function))))


def gives_plans(function: F) -> F:
    """--engine, and where the new plans go."""
    return engine_option(output_options(function))


limit_option = click.option(
    "--limit", type=click.IntRange(min=1), default=SEARCH_SECONDS, help="The seconds to search."
)
planner_option = click.option(
    "--planner", metavar="NAME", default=Neighbourhood.name, help=f"One of {', '.join(PLANNERS)}."
)


def planner_options(*names: str) -> Callable[[F], F]:
    """The options of named planners, as in `carp_spec.planners`; options not given keep their defaults."""

    def decorate(function: F) -> F:
        for name in reversed(names):
            function = _PLANNER_OPTIONS[name](function)
        return function

    return decorate


def _option(flags: str, help: str, default: object, **settings: Any) -> Callable[[Any], Any]:  # noqa: ANN401 - click's
    """An option that is `None` where it is not given; the planner's default is shown."""
    return click.option(flags, default=None, help=f"{help}  [default: {default}]", **settings)


_PLANNER_OPTIONS: dict[str, Callable[[Any], Any]] = {
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
ADDING = ("m", "sample", "seed", "baseline", "fallback")
PLANNING = tuple(_PLANNER_OPTIONS)


def chosen_planner(name: str, options: dict[str, Any]) -> Planner:
    """The planner with the options that were given."""
    return planner_named(name, {option: value for option, value in options.items() if value is not None})
