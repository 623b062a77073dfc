"""Robots that are added one after the other to a fleet that stays up get the reference's plans, whatever is reused."""

import pytest
from tests.optimized.arrivals import arrivals

QUESTIONS = 600
PARTS = 6


@pytest.mark.parametrize("part", range(PARTS))
def test_robots_that_arrive_while_time_passes_are_planned_alike(part: int) -> None:
    for number in range(part, QUESTIONS, PARTS):
        question = arrivals(number)
        assert question.by_fleet()[0] == question.by_reference(), number
