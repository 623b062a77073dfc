"""The data of the reference cannot be changed, or given a field that they do not have."""

from dataclasses import is_dataclass
from typing import Any

import pytest
from tests.classes import classes_of

import carp_reference
from carp_reference.problem import Problem

DATACLASSES = [each for each in classes_of(carp_reference) if is_dataclass(each)]


@pytest.mark.parametrize("kind", DATACLASSES)
def test_data_are_frozen_and_slotted(kind: type[Any]) -> None:
    assert kind.__dataclass_params__.frozen
    assert "__slots__" in vars(kind)


def test_there_are_such_data() -> None:
    assert Problem in DATACLASSES
