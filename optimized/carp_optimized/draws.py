"""Random numbers (`polish/draws`), those of the specification."""

import numpy as np

from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, Numbers

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
FIRST_MIX = np.uint64(0xBF58476D1CE4E5B9)
SECOND_MIX = np.uint64(0x94D049BB133111EB)
SURE = 1 << 16  # a chance is in parts of this


@compiled
def next_number(stream: Numbers) -> np.uint64:
    """The next number of a SplitMix64 stream, whose state is `stream[0]`."""
    stream[0] += GOLDEN
    mixed = stream[0]
    mixed = (mixed ^ (mixed >> np.uint64(30))) * FIRST_MIX
    mixed = (mixed ^ (mixed >> np.uint64(27))) * SECOND_MIX
    return np.uint64(mixed ^ (mixed >> np.uint64(31)))


@compiled
def choice(stream: Numbers, among: int) -> int:
    """A choice among that many (`polish/draws`)."""
    return int(np.int64(next_number(stream) % np.uint64(among)))


@compiled
def swap(row: Ints, one: int, other: int) -> None:
    """Swap two entries."""
    swapped = row[one]
    row[one] = row[other]
    row[other] = swapped


@compiled
def shuffle(stream: Numbers, row: Ints, first: int, size: int) -> None:
    """Shuffle the entries from the first on, up to that size."""
    for k in range(size - 1, first, -1):
        swap(row, k, first + choice(stream, k - first + 1))


@compiled
def draw_raise(stream: Numbers, chance: int) -> int:
    """Draw by how much a round may raise the total: each further tick by the chance, which is below `SURE`."""
    ticks = 0
    while chance > 0 and choice(stream, SURE) < chance:
        ticks += 1
    return ticks
