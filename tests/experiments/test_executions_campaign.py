"""The campaign of delayed executions: it finds wrong drivers and wrong judges, each planted here once."""

from collections.abc import Iterable, Mapping

import numpy as np
import pytest

from carp_experiments.beyond import executions
from carp_experiments.beyond.executions import ExecutionsCase, executions_cases, executions_report
from carp_experiments.beyond.many_executions import Flags, Longs, breaches, entered_in_order, random_numbers
from carp_reference.execution import Order, earliest
from carp_spec.execution.dependencies import Dependency, Node
from carp_spec.permutations import splitmix64
from carproof.execution.delays import Delay, delayed, in_order, is_last, on_the_clock


def wrong_ends(count: int = 2000) -> set[str]:
    """The faults that the campaign finds in that many executions."""
    block = ExecutionsCase(0, count, seed=7).run()
    report = executions_report([block])
    assert report.holds == (not report.lines)
    found = report.summary
    assert isinstance(found, Mapping)
    return {each["wrong"] for each in found["broken"]}


def test_executions_in_order_end_as_they_must_and_many_collide_on_the_clock() -> None:
    report = executions_report(case.run() for case in executions_cases(20_100, seed=7))
    assert report.holds
    total, cyclic, delays, _, solutions, collided = map(int, report.tables[0].rows[0])
    assert (total, cyclic, solutions) == (20_100, 500, 201)
    assert delays >= total
    assert collided > solutions // 3


def test_equal_numbers_are_equal_executions() -> None:
    assert ExecutionsCase(0, 400).run() == ExecutionsCase(0, 400).run() != ExecutionsCase(0, 400, seed=5).run()


def test_random_numbers_are_those_of_the_stream() -> None:
    stream = splitmix64(2**63 + 5)
    assert random_numbers(2**63 + 5, 20).tolist() == [next(stream) for _ in range(20)]


def test_a_driver_that_keeps_to_the_clock_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executions, "in_order", on_the_clock)
    assert "has other ticks" in wrong_ends()


def test_entries_that_do_not_wait_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def hasty(order: Order, delays: Longs) -> Longs:
        return entered_in_order(order, np.zeros_like(delays))

    monkeypatch.setattr(executions, "entered_in_order", hasty)
    assert "has other ticks" in wrong_ends()


def test_entries_that_are_too_early_collide(monkeypatch: pytest.MonkeyPatch) -> None:
    def early(order: Order, delays: Longs) -> Longs:
        return entered_in_order(order, delays) // 2

    monkeypatch.setattr(executions, "entered_in_order", early)
    assert {"does not follow the plans", "collides"} <= wrong_ends()


def test_entries_that_are_too_late_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(order: Order, delays: Longs) -> Longs:
        later: Longs = entered_in_order(order, delays) + delays.sum(axis=0) + 1
        return later

    monkeypatch.setattr(executions, "entered_in_order", late)
    assert "is too late" in wrong_ends()


@pytest.mark.parametrize("blind", [0, 1])
def test_a_judge_that_overlooks_a_breach_is_found(blind: int, monkeypatch: pytest.MonkeyPatch) -> None:
    def overlooking(order: Order, enters: Longs) -> tuple[Flags, Flags]:
        found = breaches(order, enters)
        return (found[0] & (blind != 0), found[1] & (blind != 1))

    monkeypatch.setattr(executions, "breaches", overlooking)
    assert wrong_ends() == {"is judged otherwise on the clock"}


def test_a_rotation_that_turns_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def turning(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
        return earliest(delayed(order, delays), {(robot.id, 0): robot.release for robot in order.instance.robots})

    monkeypatch.setattr(executions, "in_order", turning)
    assert wrong_ends(20_000) == {"turns"}


def test_a_robot_that_stops_without_a_reason_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopping(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
        return {node: tick for node, tick in in_order(order, delays).items() if not is_last(order, node)}

    monkeypatch.setattr(executions, "in_order", stopping)
    assert any("without a reason" in each for each in wrong_ends(20_000))


def test_a_rotation_that_the_analysis_misses_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(edges: Iterable[Dependency]) -> tuple[Dependency, ...]:
        del edges
        return ()

    monkeypatch.setattr(executions, "shortest_cycle", none)
    assert "has other ticks" in wrong_ends(20_000)
