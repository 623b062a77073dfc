"""The tables of certified gaps: what is counted, and what is left out."""

from carp_experiments.measuring import gap_table
from carp_experiments.measuring.gap_table import Found, Task

TASK = Task(10, 100, 2, 1)


def test_a_gap_is_that_of_the_plans_above_the_bound_and_robots_left_out_have_none() -> None:
    found = [Found(80, 100, 110, None), Found(80, 100, None, None), Found(100, 100, 105, None)]
    assert gap_table.gap_row(TASK, found) == ("10", "3", "2/3", "16.67 ± 16.33", "7.50 ± 4.90", "10.00")
    assert gap_table.gap_row(TASK, found[1:2])[2:] == ("0/1", "25.00 ± 0.00", "-", "-")


def test_a_gap_is_split_at_the_optimum_where_that_is_found() -> None:
    found = [Found(80, 100, 210, 200), Found(80, 200, 200, 200), Found(80, 100, 120, None)]
    assert gap_table.split_row(TASK, found) == ("10", "100", "2/3", "2.50 ± 4.90", "50.00 ± 98.00", "1")
    assert gap_table.split_row(TASK, found[2:])[2:] == ("0/1", "-", "-", "-")


def test_a_measurement_of_a_few_robots_is_bracketed_by_bound_and_plans() -> None:
    found = gap_table.measure(Task(20, 6, 1, 0.3, limit=5), 1)
    assert found.plans is not None
    assert found.optimum is not None
    assert found.shortest <= found.bound <= found.optimum <= found.plans
