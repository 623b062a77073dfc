"""The time of a whole command: from its start to the last line that it prints."""

from sys import float_info
from time import perf_counter
from typing import TypeVar

import click

from carproof.engines import warm

ENDING = 0.05
"""The seconds that it takes to print the answer, and to end."""
HARDLY_ANY = 1e-3
"""The seconds that a search gets where none are left, as it refuses 0."""
S = TypeVar("S", float, float | None)


def time_left(context: click.Context, seconds: S, compiling: float = 0.0, ending: float = 0.0) -> S:
    """What is left of the seconds of the command, not counting those of `compiling`; wrong ones stay, to be refused.

    What follows the search takes `ending` seconds, and some to print.
    """
    if not (seconds and 0 < seconds <= float_info.max):
        return seconds
    started: float = context.find_root().obj
    return max(seconds + compiling - (perf_counter() - started) - ending - ENDING, HARDLY_ANY)


def time_of_compiling() -> float:
    """The seconds that it takes to compile what runs, if that has not been done before."""
    started = perf_counter()
    return perf_counter() - started if warm() else 0.0
