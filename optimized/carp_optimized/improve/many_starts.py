"""A polish with many starts: copies of a solution are polished with other choices each, and the worse half is dropped.

A polish ends where no small change helps any more, and where that is depends on its choices: on the paper's maps, the
totals of short polishes of one solution differ by more than a long one gains. So all copies get a first part of the
rounds, the better half of them a second part of the same size, and so on; the last copy gets the last part. Source: the
sequential halving of Karnin, Koren and Somekh 2013.
"""

from collections.abc import Callable
from typing import Protocol

from carp_spec import Instance, Solution, total_cost
from carp_spec.polish_rules import last_round


class Polish(Protocol):
    """The `polish` of an engine."""

    def __call__(
        self,
        instance: Instance,
        solution: Solution,
        *,
        iterations: int | None = None,
        seconds: float | None = None,
        seed: int = 0,
        advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
    ) -> Solution:
        """Improve a solution for that many rounds or seconds."""


def polish_many(
    polish: Polish,
    starts: int,
    instance: Instance,
    solution: Solution,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """Improve a solution for that many rounds or seconds of all starts; `advance` gets the rounds and the best so far.

    Equal iterations, starts and seed give an equal solution. Raises what `polish` raises.
    """
    last = last_round(iterations, seconds)
    copies = [solution] * starts
    parts = starts.bit_length()
    played = own = 0
    best: tuple[int, int] | None = None

    def watch(rounds: int, unplanned: int, total: int) -> None:
        nonlocal best, own
        own = rounds
        best = min(best or (unplanned, total), (unplanned, total))
        advance(played + rounds, *best)

    for part in range(parts):
        rounds = None if last is None else (last - played) // (len(copies) * (parts - part))
        time = None if seconds is None else seconds / (len(copies) * parts)
        for number, copy in enumerate(copies):
            other = (seed * parts + part) * starts + number
            copies[number] = polish(instance, copy, iterations=rounds, seconds=time, seed=other, advance=watch)
            played, own = played + own, 0
        copies.sort(key=lambda each: (len(each.unplanned), total_cost(instance, each.plans)))
        del copies[max(len(copies) // 2, 1) :]
    return copies[0]
