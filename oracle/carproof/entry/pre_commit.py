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
    codes = [0]
    for each in solutions:
        click.echo(f"{each}:")
        codes.append(cli.main(["check", instance or instance_of(each), each]))
    sys.exit(max(codes))


def instance_of(solution: str) -> str:
    """The instance beside a solution: `NAME.json` beside `NAME.solution.json`."""
    path = Path(solution)
    return str(path.with_name(f"{path.name.removesuffix(SUFFIX)}.json"))


if __name__ == "__main__":
    main()
