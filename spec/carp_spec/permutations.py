"""Random numbers and orders that every program can repeat."""

from collections.abc import Iterator, Sequence
from itertools import permutations
from math import factorial
from typing import TypeAlias, TypeVar

T = TypeVar("T")
Order: TypeAlias = tuple[int, ...]

_WORD = (1 << 64) - 1


def splitmix64(seed: int) -> Iterator[int]:
    """Yield the 64-bit numbers of the SplitMix64 stream of a seed, without end.

    Source: Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators".
    """
    state = seed & _WORD
    while True:
        state = (state + 0x9E3779B97F4A7C15) & _WORD
        mixed = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & _WORD
        mixed = ((mixed ^ (mixed >> 27)) * 0x94D049BB133111EB) & _WORD
        yield mixed ^ (mixed >> 31)


def shuffle(items: Sequence[T], stream: Iterator[int]) -> tuple[T, ...]:
    """Shuffle by Fisher-Yates: for i from the last position down to 1, swap it with the next number mod (i + 1)."""
    shuffled = list(items)
    for i in range(len(shuffled) - 1, 0, -1):
        j = next(stream) % (i + 1)
        shuffled[i], shuffled[j] = shuffled[j], shuffled[i]
    return tuple(shuffled)


def orders(size: int, sample: int | None, stream: Iterator[int]) -> Iterator[Order]:
    """Permutations of the positions 0 .. size - 1, in lexicographic order.

    All of them, or a smaller sample of distinct shuffles.
    """
    if sample is None or factorial(size) <= sample:
        return permutations(range(size))
    drawn: set[Order] = set()
    while len(drawn) < sample:
        drawn.add(shuffle(range(size), stream))
    return iter(sorted(drawn))
