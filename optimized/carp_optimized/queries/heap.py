"""A binary heap of 64-bit keys with a node each, in two arrays whose first `size` places it fills."""

from carp_optimized.jit.compiling import RoomExhausted, compiled
from carp_optimized.jit.kinds import Ints, Longs


@compiled
def push(keys: Longs, nodes: Ints, size: int, key: int, node: int) -> None:
    """Add an entry to a heap of `size` entries."""
    if size == keys.size:
        raise RoomExhausted
    here = size
    while here > 0:
        above = (here - 1) >> 1
        if keys[above] <= key:
            break
        keys[here] = keys[above]
        nodes[here] = nodes[above]
        here = above
    keys[here] = key
    nodes[here] = node


@compiled
def replace_root(keys: Longs, nodes: Ints, size: int, key: int, node: int) -> None:
    """Put an entry in the place of the smallest."""
    here = 0
    below = 1
    while below < size:
        if below + 1 < size and keys[below + 1] < keys[below]:
            below += 1
        if key <= keys[below]:
            break
        keys[here] = keys[below]
        nodes[here] = nodes[below]
        here = below
        below = 2 * here + 1
    keys[here] = key
    nodes[here] = node
