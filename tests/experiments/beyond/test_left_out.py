"""The robots that a plan leaves out are counted before and after the repair."""

from carp_experiments.beyond.left_out import left_out_row
from carp_experiments.paper.map_cases import MapCase


def test_a_robot_that_the_planner_leaves_out_is_planned_by_the_repair() -> None:
    row = MapCase(left_out_row, 0, 0).run()
    assert row["before"]
    assert not row["left"]
