"""A search beside another one answers by its work, in a process of its own or without, and leaves nothing behind."""

import os
import sys
from collections.abc import Iterator

import pytest

from carp_optimum.background import Beside, Look
from carp_optimum.sat.solver import TimeOver
from carp_spec import Refusal


@pytest.fixture(params=[1, 2], ids=["one core", "two cores"])
def cores(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A machine with so few cores; no process that is started on it is left in the end."""
    started: list[int] = []
    fork = os.fork

    def noted() -> int:
        process = fork()
        started.append(process)
        return process

    monkeypatch.setattr(os, "fork", noted)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {*range(request.param)}, raising=False)
    yield
    assert bool(started) == (sys.platform == "linux" and request.param > 1)
    for process in started:
        with pytest.raises(ChildProcessError):
            os.waitpid(process, os.WNOHANG)


def never() -> None:
    """Let the one who waits wait."""


def doubling(look: Look) -> Iterator[tuple[int, int]]:
    for work in range(1, 6):
        look()
        yield 10 * work, 2**work


@pytest.mark.usefixtures("cores")
def test_the_answer_is_the_result_of_the_work_that_is_asked_for() -> None:
    beside = Beside(doubling, never)
    assert [beside.result(work) for work in (9, 10, 29, 30, 49, 1000)] == [None, 2, 4, 8, 16, 32]
    beside.close()


@pytest.mark.usefixtures("cores")
def test_a_refusal_ends_the_search_and_a_fault_is_raised_where_its_results_are_read() -> None:
    def refused(_: Look) -> Iterator[tuple[int, str]]:
        yield 1, "first"
        raise Refusal("request", "$", "optimum/size", "too large")

    def faulty(_: Look) -> Iterator[tuple[int, str]]:
        yield 1, "first"
        raise ValueError("a fault")

    beside = Beside(refused, never)
    assert beside.result(5) == "first"
    beside.close()
    beside = Beside(faulty, never)
    with pytest.raises(ValueError, match="a fault"):
        beside.result(5)
    beside.close()


@pytest.mark.usefixtures("cores")
def test_one_who_waits_looks_at_the_clock() -> None:
    def endless(look: Look) -> Iterator[tuple[int, str]]:
        yield 1, "first"
        while True:
            look()

    def over() -> None:
        raise TimeOver

    beside = Beside(endless, over)
    with pytest.raises(TimeOver):
        beside.result(5)
    beside.close()


@pytest.mark.usefixtures("cores")
def test_results_after_the_work_asked_for_are_kept_for_later() -> None:
    beside = Beside(doubling, never)
    assert beside.result(10) == 2
    assert beside.latest() in {4, 8, 16, 32}
    assert beside.result(1000) == 32
    beside.close()
