"""Arrays are handed to compiled functions only if they are as these take them to be."""

from typing import Any

import numpy as np
import pytest

from carp_optimized.jit.references import Native
from carp_optimized.state.room import empty_rows, no_search


def test_an_array_of_another_kind_is_refused() -> None:
    search = no_search(8, 8)
    others: list[Any] = [search.parent.astype(np.int64), search.parent.reshape(2, 4), search.parent[::2]]
    for parent in others:
        with pytest.raises(TypeError, match=r"^Search\.parent is an array of another kind$"):
            Native(search._replace(parent=parent))


def test_an_array_of_two_fields_is_refused_unless_it_is_empty() -> None:
    rows = empty_rows(np.ones(3, np.bool_), filled=True, places=32)
    with pytest.raises(TypeError, match=r"^Rows\.rank is also the array of Rows\.robot$"):
        Native(rows._replace(rank=rows.robot))
    empty = np.zeros(0, np.int32)
    Native(rows._replace(robot=empty, rank=empty))
