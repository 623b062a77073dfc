"""Streams of robots: docks, arrivals, the plans of both planners, and the figures."""

import msgspec

from carp_experiments.beyond.streams import (
    PLANNERS,
    RATES,
    StreamOf,
    StreamRow,
    stream_figures,
    stream_instance,
    stream_report,
    stream_row,
    streamed,
)
from carp_experiments.paper.map_cases import FULL_MAP, WAREHOUSE, MapCase
from carp_spec.instance_rules import instance_faults

SMALL = MapCase(stream_row, FULL_MAP, 1, 120)


def test_robots_come_at_the_rate_in_docks_that_nobody_enters() -> None:
    for place in (10, WAREHOUSE):
        instance = stream_instance(MapCase(stream_row, place, 3, 200), 400)
        assert instance_faults(instance) == ()
        releases = [robot.release for robot in instance.robots]
        assert releases == sorted(releases)
        assert 0 <= releases[0] < releases[-1] < 50
        docks = {robot.start for robot in instance.robots}
        assert all(instance.graph.resource[dock].capacity == 200 for dock in docks)
        assert not docks & {target for _, target in instance.graph.moves}


def test_every_robot_gets_a_plan_and_a_higher_rate_makes_robots_wait() -> None:
    for name in PLANNERS:
        slow, fast = streamed(SMALL, name, 100), streamed(SMALL, name, 2000)
        assert slow.shortest == fast.shortest
        assert slow.shortest <= slow.taken < fast.taken
        assert slow.half > fast.half


def test_the_report_has_the_throughput_of_each_rate() -> None:
    found = [{"half": 50, "taken": 300, "shortest": 200} for _ in RATES]
    rows = [{"map": 10, "planners": dict.fromkeys(PLANNERS, found)} for _ in range(2)]
    assert msgspec.convert(rows[0], StreamRow).map == 10
    report = stream_report(rows, 100)
    first = msgspec.convert(report.summary, tuple[StreamOf, ...])[0]
    assert (first.streams, first.rate) == (2, RATES[0])
    assert (first.throughput.estimate, first.taken.estimate, first.waited.estimate) == (100, 3, 1)
    assert report.tables[0].rows[0][:4] == ("map 10", "CARP", "100", "100 ± 0")
    throughput, waiting = stream_figures(msgspec.convert(report.summary, tuple[StreamOf, ...]))
    assert (throughput.name, waiting.name) == ("stream-throughput", "stream-waiting")
    assert [*throughput.lines] == ["CARP + map 10", "Proposed_4 + map 10"]
