"""Streams of pick-and-drop orders: what is drawn, and what the table says."""

import msgspec

from carp_experiments.beyond.lifelong import (
    PLANNERS,
    RATES,
    SERVICE,
    LifelongOf,
    lifelong_report,
    lifelong_row,
    order_instance,
)
from carp_experiments.paper.map_cases import MapCase
from carp_experiments.paper.sorting import sorting_instance
from carp_experiments.store import digest_of
from carp_spec import Stop
from carproof.generate import Fleet

CASE = MapCase(lifelong_row, 20, 1, 8)


def test_each_robot_picks_elsewhere_than_it_drops() -> None:
    instance = order_instance(CASE, RATES[0])
    assert all(robot.stops[-1] == Stop(robot.goal) for robot in instance.robots)
    picks = [robot.stops[0] for robot in instance.robots]
    assert [pick.service for pick in picks] == [SERVICE] * 8
    assert all(pick.resource != robot.goal for pick, robot in zip(picks, instance.robots, strict=True))


def test_each_planner_serves_all_orders_at_each_rate() -> None:
    row = CASE.run()
    summary = msgspec.convert(lifelong_report([row], 8).summary, tuple[LifelongOf, ...])
    assert [(each.rate, each.planner) for each in summary] == [(rate, name) for rate in RATES for name in PLANNERS]
    assert all(each.taken.estimate > SERVICE for each in summary)
    assert digest_of(row) == digest_of(CASE.run())


def test_the_sorting_centre_is_laid_out_as_published_and_all_its_cells_can_be_left() -> None:
    instance = sorting_instance(Fleet(robots=30, distinct="none"))
    graph = instance.graph
    assert (len(graph.resources), len(graph.moves)) == (2570, 3792)
    here, back = {graph.resources[0].id}, {graph.resources[0].id}
    for found, way in ((here, 1), (back, -1)):
        for _ in range(200):
            found |= {move[::way][1] for move in graph.moves if move[::way][0] in found}
    assert here == back == {*graph.index}
    assert {str(robot.start).partition(",")[2] for robot in instance.robots} == {"0", "36"}
