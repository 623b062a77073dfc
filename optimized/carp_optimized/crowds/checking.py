"""Whether paths of a crowd break no rule: sorting and comparing, which shares nothing with the searches.

It looks at whole arrays, so it takes a fraction of a second for a million visits, where the law's own predicates take
ten seconds.
"""

import numpy as np

from carp_optimized.crowds.crowd import Crowd
from carp_optimized.crowds.stays import Paths
from carp_optimized.jit.kinds import Flags, Longs
from carp_optimized.state.arrays import NEVER

TICKS = 25
"""The bits of a tick in a key, beside two places; paths are shorter than this by far."""


def require_lawful(crowd: Crowd, paths: Paths) -> None:
    """Raise `AssertionError` for paths that break a rule of the plan or the joint rules; empty rows are no plans."""
    rows = np.flatnonzero(paths.size > 0)
    sizes = paths.size[rows]
    taken = np.arange(paths.place.shape[1]) < sizes[:, np.newaxis]
    place = paths.place[rows][taken].astype(np.int64)
    enter = paths.enter[rows][taken].astype(np.int64)
    ends = np.cumsum(sizes) - 1
    begins = ends - sizes + 1
    is_last = np.zeros(place.size, np.bool_)
    is_last[ends] = True
    leave = np.roll(enter, -1)
    leave[is_last] = NEVER if crowd.parks else enter[is_last] + 1
    is_right = (
        np.array_equal(place[begins], crowd.start[rows])
        and np.array_equal(place[ends], crowd.goal[rows])
        and not enter[begins].any()
        and bool((leave > enter).all())
        and _are_apart(place, enter, leave)
        and _are_moves(crowd, place, leave, is_last)
    )
    if not is_right:
        raise AssertionError("paths of a crowd break a rule")


def _are_apart(place: Longs, enter: Longs, leave: Longs) -> bool:
    """Whether no two stays in one place overlap."""
    order = np.argsort((place << TICKS) + enter)
    same = place[order[1:]] == place[order[:-1]]
    return bool((leave[order[:-1]] <= enter[order[1:]])[same].all())


def _are_moves(crowd: Crowd, place: Longs, leave: Longs, is_last: Flags) -> bool:
    """Whether each visit is followed by one that a move leads to, and no two moves at a tick swap places.

    Of stays that do not overlap, no two begin in one place at one tick. So moves between the same two places at the
    same tick are a swap.
    """
    source = place[~is_last]
    target = np.roll(place, -1)[~is_last]
    size = crowd.queue.size
    moves = np.sort(np.repeat(np.arange(size), np.diff(crowd.first)) * size + crowd.target)
    made = source * size + target
    if made.size and not (moves.size and (moves.take(np.searchsorted(moves, made), mode="clip") == made).all()):
        return False
    low, high = np.minimum(source, target), np.maximum(source, target)
    pairs = np.sort((low * size + high << TICKS) + leave[~is_last])
    return not (pairs[1:] == pairs[:-1]).any()
