"""Orders of many robots are sorted where their first places, as one number, are alike: see test_uncompiled.py."""

import os
from itertools import permutations

import numpy as np
import pytest

from carp_optimized.neighbourhood.orders import key_of, sort_rows
from carp_optimized.state.room import no_work
from carp_spec.permutations import shuffle, splitmix64

pytestmark = pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") != "1", reason="it runs uncompiled")

MEMBERS = 17
IN_THE_KEY = 12


def test_orders_with_a_long_beginning_in_common_are_sorted() -> None:
    behind = range(IN_THE_KEY, MEMBERS)
    orders = [(*range(IN_THE_KEY), *rest) for rest in permutations(behind)]
    drawn = [*shuffle(orders, splitmix64(3)), orders[5], orders[5]]
    work = no_work(MEMBERS, MEMBERS, len(drawn))
    work.rows[:] = drawn
    work.row_index[:] = np.arange(len(drawn))
    for row, order in enumerate(drawn):
        work.row_key[row] = key_of(work.rows[row], MEMBERS)
        assert work.row_key[row] == work.row_key[0], order
    sort_rows(work, len(drawn), MEMBERS)
    assert [tuple(row) for row in work.rows[work.row_index].tolist()] == sorted(drawn)
