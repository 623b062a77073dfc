"""Rows of intervals: the windows of a resource, or the stays in it, in one pool of slots."""

from carp_optimized.jit.blocks import BLOCK, below, width
from carp_optimized.jit.compiling import RoomExhausted, compiled, inlined
from carp_optimized.jit.kinds import Ints
from carp_optimized.state.arrays import NEVER, NONE, Rows


@compiled
def last_by(rows: Rows, resource: int, tick: int) -> int:
    """The slot of the last interval of the resource that starts by the tick, or `NONE`."""
    first = int(rows.offset[resource])
    slot = skip_below(rows.start, first, first + int(rows.size[resource]), tick + 1)
    return slot - 1 if slot > first else NONE


@compiled
def skip_below(ticks: Ints, slot: int, row_end: int, limit: int) -> int:
    """From the first slot of a row to the first whose tick is not below the limit, or to the end of the row.

    Ticks are in order, and a block at a time is compared.
    """
    limit = min(limit, NEVER)
    while True:
        count = width(below(ticks, slot, limit))
        slot += count
        if count < BLOCK or slot >= row_end:
            return slot


@inlined
def copy(rows: Rows, slot: int, to: int) -> None:
    """Copy an interval."""
    rows.start[to] = rows.start[slot]
    rows.end[to] = rows.end[slot]
    rows.source[to] = rows.source[slot]
    rows.robot[to] = rows.robot[slot]
    rows.rank[to] = rows.rank[slot]


@inlined
def make_room(rows: Rows, resource: int) -> None:
    """Move the row to the end of the pool if it is full."""
    count = int(rows.size[resource])
    if count < rows.room[resource]:
        return
    room = 2 * count
    old = int(rows.offset[resource])
    new = int(rows.used[0])
    if new + room > rows.start.size:
        raise RoomExhausted
    for k in range(count):
        copy(rows, old + k, new + k)
    for k in range(room):
        rows.resource[new + k] = resource
    rows.offset[resource] = new
    rows.room[resource] = room
    rows.used[0] = new + room


@compiled
def clear_row(rows: Rows, resource: int) -> None:
    """Drop all intervals of the resource."""
    first = int(rows.offset[resource])
    for slot in range(first, first + int(rows.size[resource])):
        rows.start[slot] = NEVER
        rows.end[slot] = NEVER
    rows.size[resource] = 0
