"""The hook of pre-commit: checks the solutions that are committed."""

import sys
from collections.abc import Sequence
from pathlib import Path

import click

from carproof.entry import cli

SUFFIX = ".solution.json"


@click.command()
@click.option("--instance", metavar="FILE", help="The instance of all solutions.  [default: NAME.json of each]")
@click.argument("solutions", nargs=-1, metavar=f"NAME{SUFFIX} ...")
def main(instance: str | None, solutions: Sequence[str]) -> None:
    """Check each solution, and end with the highest exit code of carproof check."""
    sys.exit(max((_check(instance or instance_of(each), each) for each in solutions), default=0))


def _check(instance: str, solution: str) -> int:
    click.echo(f"{solution}:")
    return cli.main(["check", instance, solution])


def instance_of(solution: str) -> str:
    """The instance beside a solution: `NAME.json` beside `NAME.solution.json`."""
    path = Path(solution)
    return str(path.with_name(f"{path.name.removesuffix(SUFFIX)}.json"))


if __name__ == "__main__":
    main()
