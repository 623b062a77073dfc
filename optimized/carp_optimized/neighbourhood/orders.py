"""The orders of a neighbourhood (`neighbourhood/orders`), one after the other in lexicographic order."""

from carp_optimized.draws import shuffle, swap
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, Numbers
from carp_optimized.state.arrays import Work

KEY_BITS = 62


@compiled
def key_of(row: Ints, size: int) -> int:
    """The first places of an order as one number: those of small neighbourhoods are all places."""
    bits = 1
    while size > 1 << bits:
        bits += 1
    key = 0
    for k in range(min(size, KEY_BITS // bits)):
        key = (key << bits) + int(row[k])
    return key


@compiled
def precedes(work: Work, one: int, other: int, size: int) -> int:
    """-1, 0 or 1 if the first order is before, the same as, or after the second."""
    if work.row_key[one] != work.row_key[other]:
        return -1 if work.row_key[one] < work.row_key[other] else 1
    rows = work.rows
    for k in range(size):
        if rows[one][k] != rows[other][k]:
            return -1 if rows[one][k] < rows[other][k] else 1
    return 0


@compiled
def sort_rows(work: Work, count: int, size: int) -> None:
    """Sort the indices of the rows by merging runs of growing length."""
    index = work.row_index
    width = 1
    while width < count:
        for start in range(0, count, 2 * width):
            i = start
            middle = min(start + width, count)
            j = middle
            end = min(start + 2 * width, count)
            for k in range(start, end):
                if j >= end or (i < middle and precedes(work, int(index[i]), int(index[j]), size) <= 0):
                    work.row_spare[k] = index[i]
                    i += 1
                else:
                    work.row_spare[k] = index[j]
                    j += 1
        for k in range(count):
            index[k] = work.row_spare[k]
        width *= 2


@compiled
def is_sampled(size: int, sample: int) -> bool:
    """Whether there are more permutations than the sample; a sample of 0 means that all are asked."""
    if sample == 0:
        return False
    count = 1
    for k in range(2, size + 1):
        count *= k
        if count > sample:
            return True
    return False


@compiled
def draw_orders(work: Work, size: int, sample: int, stream: Numbers) -> int:
    """Draw distinct shuffles of 0 .. size - 1 into rows, sorted; how many: 0 if all permutations are to be looked at.

    As many as are still missing are drawn at a time, so that none is drawn after the last distinct one.
    """
    if not is_sampled(size, sample):
        return 0
    rows = work.rows
    index = work.row_index
    for row in range(sample):
        index[row] = row
    distinct = 0
    while distinct < sample:
        for missing in range(distinct, sample):
            row = int(index[missing])
            for k in range(size):
                rows[row][k] = k
            shuffle(stream, rows[row], 0, size)
            work.row_key[row] = key_of(rows[row], size)
        sort_rows(work, sample, size)
        distinct = 1
        for row in range(1, sample):
            if precedes(work, int(index[distinct - 1]), int(index[row]), size) != 0:
                swap(index, distinct, row)
                distinct += 1
    return sample


@compiled
def next_permutation(order: Ints, size: int, shared: int) -> int:
    """Go to the next permutation that differs in the first `shared` places; the first place that changed, or -1."""
    place = shared - 1
    while place >= 0:
        largest = -1
        for k in range(place + 1, size):
            largest = max(largest, int(order[k]))
        if order[place] < largest:
            break
        place -= 1
    if place < 0:
        return -1
    for k in range(place + 2, size):  # sort what follows
        here = k
        while here > place + 1 and order[here - 1] > order[here]:
            swap(order, here, here - 1)
            here -= 1
    following = place + 1
    while order[following] < order[place]:
        following += 1
    swap(order, place, following)
    return place


@compiled
def next_row(work: Work, row: int, rows: int, shared: int) -> int:
    """The next row that differs from the order in the first `shared` places; the number of rows if none does."""
    while row < rows:
        for k in range(shared):
            if work.rows[work.row_index[row]][k] != work.order[k]:
                return row
        row += 1
    return row


@compiled
def take_row(work: Work, row: int, size: int) -> int:
    """Make a row the order; the first place that changed."""
    drawn = int(work.row_index[row])
    place = 0
    while place < size and work.order[place] == work.rows[drawn][place]:
        place += 1
    for k in range(size):
        work.order[k] = work.rows[drawn][k]
    return place


@compiled
def queries_after(order: Ints, shared: int, size: int) -> int:
    """The number of queries for the orders behind this one with its first places, if beginnings are shared."""
    below = 0
    for k in range(1, size - shared):
        below = k * (1 + below)
    queries = shared - size
    for k in range(shared, size):
        if order[k] >= order[shared]:
            queries += 1 + below
    return queries


@compiled
def queries_of_rows(work: Work, first: int, end: int, size: int) -> int:
    """The number of queries for the rows between two, both excluded, if beginnings are shared."""
    queries = 0
    for row in range(first + 1, end):
        one = work.rows[work.row_index[row - 1]]
        other = work.rows[work.row_index[row]]
        place = 0
        while one[place] == other[place]:
            place += 1
        queries += size - place
    return queries
