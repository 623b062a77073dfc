"""`carproof execution`: commands about late robots."""

import click

from carproof.command_line.lazy import LazyGroup
from carproof.command_line.options import examples
from carproof.commands import EXECUTION


@click.group(
    cls=LazyGroup,
    sections={"Commands": EXECUTION},
    short_help="Simulate late robots, and plan for the rest of their way.",
    epilog=examples(
        "carproof execution simulate town.json plans.json --seed 1",
        "carproof execution dependencies town.json plans.json",
        "carproof execution retime town.json plans.json trace.json -o new.json",
    ),
)
def command() -> None:
    """Simulate robots that are late, check what they have done, and make plans for the rest of the way."""
