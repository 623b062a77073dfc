"""Robots that are added one after the other to a fleet that stays up get the reference's plans, whatever is reused."""

import pytest
from tests.optimized.neighbourhood.arrivals import CROWDED, ROOMS, arrivals, convoy, scaled
from tests.profiles import rest_in

from carp_optimized.state import room
from carproof.testing.random_instances import Mix

QUESTIONS = 600
PARTS = 6


@pytest.mark.parametrize("mix", [CROWDED, ROOMS], ids=["crowded", "more robots than resources"])
@pytest.mark.parametrize("part", rest_in("ci", range(PARTS), 0))
def test_robots_that_arrive_are_planned_alike_also_where_guides_end_early(
    monkeypatch: pytest.MonkeyPatch, part: int, mix: Mix
) -> None:
    for number in range(part, QUESTIONS, PARTS):
        question = arrivals(number, mix)
        expected = question.by_reference()
        for detour in (room.DETOUR, number // PARTS % 2):
            with monkeypatch.context() as patched:
                patched.setattr(room, "DETOUR", detour)
                assert question.by_fleet()[0] == expected, (number, detour)


@pytest.mark.parametrize(("space", "time"), [(2**11, 2**17), (2**26, 1), (2**26, 2**17)])
def test_nearest_robots_are_the_same_however_far_and_slow(space: int, time: int) -> None:
    for number in range(QUESTIONS, QUESTIONS + 40):
        question = scaled(arrivals(number), space, time)
        assert question.by_fleet()[0] == question.by_reference(), number


@pytest.mark.parametrize("part", rest_in("ci", range(4), 0))
def test_robots_of_a_convoy_are_planned_alike(part: int) -> None:
    for number in range(part, 40, 4):
        question = convoy(number)
        assert question.by_fleet()[0] == question.by_reference(), number
