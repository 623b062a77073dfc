"""Where the neighbourhood planner helps: kinds of instances, and polish in as much time."""

import pytest

from carp_experiments.beyond.neighbours import KINDS, NeighboursRow, helped, kind_instance, neighbours_row
from carp_experiments.paper.map_cases import FULL_MAP, MapCase
from carp_spec import violations_of

CASE = MapCase(neighbours_row, FULL_MAP, 0, 6)


def test_a_kind_has_what_it_says() -> None:
    instances = {kind: kind_instance(CASE, kind) for kind in KINDS}
    cells = {
        kind: [each for each in made.graph.resources if not str(each.id).startswith("dock")]
        for kind, made in instances.items()
    }
    assert {each.duration for each in cells["durations"]} == {1, 2, 3}
    assert {each.capacity for each in cells["capacities"]} == {1, 2}
    assert {robot.pace for robot in instances["paces"].robots} == {1, 2}
    assert all(len(robot.stops) == 2 for robot in instances["stops"].robots)
    members = [each for group in instances["groups"].graph.groups for each in group.resources]
    assert sorted(members) == sorted(each.id for each in cells["groups"])
    assert all(not violations_of(made, ()) for made in instances.values())


def test_polish_has_the_time_of_the_planner_and_no_more() -> None:
    def row(total: int) -> NeighboursRow:
        totals = {"CARP": (200,), "Proposed_4 + baseline": (total,), "polish": (190, 180, 150)}
        measured = {"CARP": (2,), "Proposed_4 + baseline": (20,), "polish": (10, 20, 21)}
        return NeighboursRow(5, 0, {"plain": totals}, {"plain": measured})

    found = helped(5, "plain", 4, [row(196), row(192)])
    assert (found.saved.estimate, found.polished.estimate, found.more.estimate) == pytest.approx((3, 10, 7))
    assert found.times == pytest.approx(10)
