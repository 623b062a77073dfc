"""The campaign of delayed executions: it finds a driver that breaks the order, stops, or turns a rotation."""

from collections.abc import Iterable

import pytest

from carp_experiments import executions
from carp_experiments.executions import ExecutionsCase, executions_cases, executions_report
from carp_experiments.store import Row
from carp_reference.execution import Delay, Order, earliest, in_order, on_the_clock
from carp_spec.dependencies import Dependency, Node


def wrong_ends(count: int = 1000) -> str:
    """What the campaign says of the wrong ends of that many executions."""
    report = executions_report([ExecutionsCase(0, count).run()])
    assert report.holds == (not report.lines)
    return " ".join(report.lines)


def test_executions_in_order_end_as_they_must_and_many_collide_on_the_clock() -> None:
    report = executions_report(case.run() for case in executions_cases(1240, seed=7))
    assert report.holds
    total, cyclic, delays, collided, _ = map(int, report.tables[0].rows[0])
    assert total == 1240
    assert cyclic == 40
    assert delays >= total
    assert collided > total // 3


def test_parts_of_a_block_are_those_of_the_whole() -> None:
    assert ExecutionsCase(0, 40).run() != ExecutionsCase(40, 40).run()
    assert ExecutionsCase(0, 40, seed=5).run() == ExecutionsCase(0, 40, seed=5).run()


def test_a_driver_that_keeps_to_the_clock_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executions, "in_order", on_the_clock)
    assert "joint/capacity" in wrong_ends()


def test_a_robot_that_waits_too_long_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
        delays = list(delays)
        total = sum(delay.ticks for delay in delays)
        return {node: tick + total + 1 for node, tick in in_order(order, delays).items()}

    monkeypatch.setattr(executions, "in_order", late)
    assert "is late" in wrong_ends()


def test_a_robot_that_stops_without_a_reason_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopping(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
        enters = in_order(order, delays)
        return {node: tick for node, tick in enters.items() if node != order.nodes[-1]}

    monkeypatch.setattr(executions, "in_order", stopping)
    assert "stands" in wrong_ends()
    assert "could go on" in wrong_ends()


def test_a_rotation_that_turns_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def turning(order: Order, delays: Iterable[Delay]) -> dict[Node, int]:
        return earliest(order, {(robot.id, 0): robot.release for robot in order.instance.robots}, delays)

    monkeypatch.setattr(executions, "in_order", turning)
    assert "does not stand" in wrong_ends(3000)


def test_a_rotation_that_the_analysis_misses_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(edges: Iterable[Dependency]) -> tuple[Dependency, ...]:
        del edges
        return ()

    monkeypatch.setattr(executions, "shortest_cycle", none)
    assert "stands" in wrong_ends(3000)


def test_wrong_ends_are_counted_over_all_blocks() -> None:
    blocks: list[Row] = [{"executions": 10}, {"executions": 5, "cyclic": 2, "broken": [{"number": 3}]}]
    report = executions_report(blocks)
    assert report.tables[0].rows == (("15", "2", "0", "0", "1"),)
    assert not report.holds
