"""The search for prices: the sizes of its tables, and its aims while the prices stand still."""

import pytest
from tests.verify.bound_examples import crossing

from carp_optimum.price_search import SPAN, PriceSearch

TICK = 1 << 10


def test_large_aims_fall_to_a_tick_in_each_span_and_the_next_begins_with_half(monkeypatch: pytest.MonkeyPatch) -> None:
    gains: list[int] = []

    def stand_still(_: PriceSearch, gain: int) -> bool:
        gains.append(gain)
        return True

    monkeypatch.setattr(PriceSearch, "_step", stand_still)
    PriceSearch(crossing(), TICK).roam(4 * TICK, TICK // 2, lambda: None, lambda _, __: None)
    spans = [gains[first : first + SPAN] for first in range(0, len(gains), SPAN)]
    assert [span[0] for span in spans] == [4 * TICK, 2 * TICK, TICK, TICK // 2]
    assert [span[-1] for span in spans] == [TICK, TICK, TICK, TICK // 2]
    assert all(span == sorted(span, reverse=True) for span in spans)
    assert spans[0][SPAN // 2] == TICK


def test_many_robots_have_smaller_tables_of_charges(monkeypatch: pytest.MonkeyPatch) -> None:
    robots = len(crossing().robots)
    monkeypatch.setattr("carp_optimum.price_search.LARGEST_TABLE", 10 * robots)
    monkeypatch.setattr("carp_optimum.price_search.DELAYS", 1000)
    cost, _, row, *_ = PriceSearch(crossing(), TICK).market.charges
    assert row.size <= 10 * robots
    assert cost.size <= 11 * robots  # with a column for delays that no node has
