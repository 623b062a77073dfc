"""Plans and answers beyond the memory of a round are asked for again: see test_uncompiled.py."""

import os

import pytest
from tests.optimized.arrivals import ROOMS, arrivals

from carp_optimized.neighbourhood import answers

pytestmark = pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") != "1", reason="it runs uncompiled")


def test_what_does_not_fit_into_the_memory_of_a_round_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compiled code has the numbers in it."""
    monkeypatch.setattr(answers, "PLANS", 3)
    monkeypatch.setattr(answers, "ANSWERS", 4)
    for number in range(60):
        question = arrivals(number, ROOMS)
        assert question.by_fleet()[0] == question.by_reference(), number
