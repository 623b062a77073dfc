"""The search for prices: the sizes of its tables, its aims while the prices stand still, and what a step changes."""

import pytest
from tests.verify.bound_examples import crossing

from carp_optimum.lagrangian.price_search import SPAN, PriceSearch
from carp_optimum.lagrangian.price_steps import LESS
from carp_spec import Instance, Resource, ResourceGraph, Robot

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
    monkeypatch.setattr("carp_optimum.lagrangian.price_search.LARGEST_TABLE", 10 * robots)
    monkeypatch.setattr("carp_optimum.lagrangian.price_search.DELAYS", 1000)
    cost, _, row, *_ = PriceSearch(crossing(), TICK).market.charges
    assert row.size <= 10 * robots
    assert cost.size <= 11 * robots  # with a column for delays that no node has


def test_a_step_changes_exchanges_less_than_resources_and_gains_what_it_is_to_gain() -> None:
    cells = ("north", "east", "south", "west", "middle", "left", "right")
    edges = (*((cell, "middle") for cell in cells[:4]), ("left", "right"))
    meeting = (Robot("down", "north", "south"), Robot("across", "west", "east"))
    exchanging = (Robot("to", "left", "right"), Robot("back", "right", "left"))
    search = PriceSearch(Instance(ResourceGraph(tuple(map(Resource, cells)), edges), meeting + exchanging), TICK)
    assert LESS > 1
    gain = (LESS + 2) * TICK
    assert search._step(gain)
    prices = search.prices()
    assert prices.resources == (("middle", 1, LESS * TICK),)
    assert sorted(prices.exchanges) == [("left", "right", 1, TICK), ("right", "left", 1, TICK)]
    assert sum(price for *_, price in prices.resources + prices.exchanges) == gain
