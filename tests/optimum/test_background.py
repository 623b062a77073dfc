"""A search beside another one answers by its work, in a process of its own or without, and leaves nothing behind."""

from collections.abc import Iterator
from multiprocessing import active_children

import pytest
from tests.optimum.test_branching import nothing

from carp_optimum.background import BackgroundSearch, Look
from carproof import Refusal, TimeOver


@pytest.fixture(params=[False, True], ids=["here", "own process"])
def own_process(request: pytest.FixtureRequest) -> Iterator[bool]:
    """Whether the search has a process of its own; none is left in the end."""
    yield request.param
    assert active_children() == []


def doubling(look: Look) -> Iterator[tuple[int, int]]:
    for work in range(1, 6):
        look()
        yield 10 * work, 2**work


def refused(_: Look) -> Iterator[tuple[int, str]]:
    yield 1, "first"
    raise Refusal("request", "$", "optimum/size", "too large")


def faulty(_: Look) -> Iterator[tuple[int, str]]:
    yield 1, "first"
    raise ValueError("a fault")


def endless(look: Look) -> Iterator[tuple[int, str]]:
    yield 1, "first"
    while True:
        look()


def over() -> None:
    raise TimeOver


def test_the_answer_is_the_result_of_the_work_that_is_asked_for(own_process: bool) -> None:
    beside = BackgroundSearch(doubling, nothing, own_process=own_process)
    assert [beside.result(work) for work in (9, 10, 29, 30, 49, 1000)] == [None, 2, 4, 8, 16, 32]
    beside.close()


def test_a_refusal_ends_the_search_and_a_fault_is_raised_where_its_results_are_read(own_process: bool) -> None:
    beside = BackgroundSearch(refused, nothing, own_process=own_process)
    assert beside.result(5) == "first"
    beside.close()
    beside = BackgroundSearch(faulty, nothing, own_process=own_process)
    with pytest.raises(ValueError, match="a fault"):
        beside.result(5)
    beside.close()


def test_one_who_waits_looks_at_the_clock(own_process: bool) -> None:
    beside = BackgroundSearch(endless, over, own_process=own_process)
    with pytest.raises(TimeOver):
        beside.result(5)
    beside.close()


def test_results_after_the_work_asked_for_are_kept_for_later(own_process: bool) -> None:
    beside = BackgroundSearch(doubling, nothing, own_process=own_process)
    assert beside.result(10) == 2
    assert beside.latest() in {4, 8, 16, 32}
    assert beside.result(1000) == 32
    beside.close()
