"""Late robots, rotations and people: what the experiments measure and how they sum it up."""

from collections.abc import Iterable

import msgspec
import pytest

from carp_experiments.beyond.delayed import (
    PLANNERS,
    DriverOf,
    ExecutionRow,
    execution_figures,
    execution_report,
    execution_row,
)
from carp_experiments.beyond.following import FollowingOf, following_figures, following_report, following_row
from carp_experiments.beyond.people import PeopleRow, people_row
from carp_experiments.paper.map_cases import FULL_MAP, WAREHOUSE, MapCase
from carp_experiments.store import Row, digest_of


def test_late_robots_collide_on_the_clock_alone_and_nobody_stands() -> None:
    row = MapCase(execution_row, FULL_MAP, 1, 30).run()
    reported = msgspec.convert(row, ExecutionRow)
    for driven in reported.planners.values():
        on_clock, in_order, switching = (driven.drivers[name] for name in ("clock", "order", "switching"))
        assert on_clock[0].collisions == on_clock[0].late == 0
        assert on_clock[-1].collisions > 0
        assert all(each.collisions == each.standing == 0 for each in (*in_order, *switching))
        assert switching[-1].switches > 0
        assert switching[-1].late <= in_order[-1].late
    summary = msgspec.convert(execution_report([row, row], 30).summary, tuple[DriverOf, ...])
    assert {each.executions for each in summary} == {2}
    assert all(each.worst.estimate >= each.late.estimate for each in summary)
    figures = {figure.name: figure for figure in execution_figures(summary)}
    assert [*figures] == ["execution-late", "execution-worst", "execution-arrivals", "execution-collisions"]
    (last,) = (each for each in summary if (each.planner, each.driver, each.share) == ("CARP", "order", 20))
    ends = [figure.lines["CARP + order"][-1] for figure in figures.values()]
    assert ends == [(20, value) for value in (last.late, last.worst, last.arrivals, last.collisions)]


def following_of_places(rows: Iterable[Row]) -> tuple[FollowingOf, ...]:
    return msgspec.convert(following_report(rows, 60).summary, tuple[FollowingOf, ...])


def test_without_following_there_is_no_rotation_and_plans_cost_more() -> None:
    row = MapCase(following_row, FULL_MAP, 0, 60).run()
    summary = following_of_places([row])
    assert all(each.forbidden.estimate > 0 for each in summary)
    assert all(each.unplanned[0].estimate < each.unplanned[1].estimate for each in summary)
    priced = {"unplanned": [0, 1], "totals": [100, 110], "whole": 150, "rotations": 2, "extra": 3, "left": False}
    rows = [
        {"map": 7, "planners": {name: {**priced, **other} for name in PLANNERS}}
        for other in ({}, {"totals": [100, 120], "rotations": 0, "extra": 0})
    ]
    (line, _) = following_report(rows, 60).tables[0].rows
    assert (line[3], line[4][:5], line[5:7]) == ("1.0 ± 0.0", "15.00", ("1/2", "0"))
    assert line[8].startswith("1.000")
    (figure,) = following_figures(following_of_places(rows))
    assert [point[1].estimate for point in figure.lines["CARP + forbidden"] if point[1]] == [pytest.approx(15)]
    assert following_figures(following_of_places([{**each, "map": WAREHOUSE} for each in rows])) == ()


def test_people_are_first_and_robots_pay() -> None:
    row = MapCase(people_row, FULL_MAP, 3, 60).run()
    assert digest_of(row) == digest_of(MapCase(people_row, FULL_MAP, 3, 60).run())
    reported = msgspec.convert(row, PeopleRow)
    assert len(reported.people) == 10
    assert all(person.proved and person.delay == 0 for person in reported.people)
    assert any(person.replanned for person in reported.people)
