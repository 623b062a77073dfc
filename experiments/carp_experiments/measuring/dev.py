"""`carproof dev`: measurements of carproof itself, for those who work on it."""

import click

from carproof.command_line.lazy import LazyGroup
from carproof.command_line.options import examples

HERE = __name__.rpartition(".")[0]
COMMANDS = {"bench": f"{HERE}.bench", "crosscheck": f"{HERE}.crosscheck"}


@click.group(
    cls=LazyGroup,
    sections={"Commands": COMMANDS},
    short_help="Measure and cross-check carproof itself.",
    epilog=examples("carproof dev bench", "carproof dev crosscheck --examples 10000"),
)
def command() -> None:
    """Measure the speed of the compiled planner, and compare it with the reference."""
