"""The robots that a plan leaves out are counted before and after the repair."""

from carp_experiments.beyond.left_out import left_out_report, left_out_row
from carp_experiments.paper.map_cases import MapCase


def test_a_robot_that_the_planner_leaves_out_is_planned_by_the_repair() -> None:
    row = MapCase(left_out_row, 0, 0).run()
    assert row["before"]
    assert not row["left"]


def test_the_report_counts_assignments_and_names_those_with_somebody_left_out() -> None:
    row = {"map": 3, "assignment": 0, "before": 2, "left": [], "total": 90}
    rows = [row, {**row, "assignment": 1, "before": 0}, {**row, "assignment": 2, "left": ["r4", "r7"]}]
    report = left_out_report(rows)
    assert report.tables[0].rows == (("3", "3", "2", "1"),)
    assert report.lines == ("map 3, assignment 2: r4, r7",)
    assert not report.holds
    assert left_out_report(rows[:2]).holds
