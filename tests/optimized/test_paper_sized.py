"""100 robots on the paper's maps: the reference's plans, by their digests, and some by asking the reference."""

import pytest
from tests.optimized.paper_sized import FOUR, MAPS, Question, questions, read_digests
from tests.profiles import rest_in

import carp_optimized
import carp_reference

LEAST = 52


def optimised(question: Question) -> str:
    return question.answer(carp_optimized.plan, carp_optimized.add)


def test_the_plans_have_the_digests_of_the_reference() -> None:
    digests = read_digests()
    assert len(digests) >= LEAST, "the reference has been asked those at least"
    answers = {str(question): optimised(question) for question in questions() if str(question) in digests}
    assert answers == digests


@pytest.mark.parametrize("map", rest_in("ci", MAPS, 0))
def test_the_digests_are_those_of_the_reference_of_today(map: int) -> None:
    digests = read_digests()
    for options in FOUR:
        question = Question("add", map, 0, options)
        assert question.answer(carp_reference.plan, carp_reference.add) == digests[str(question)]
