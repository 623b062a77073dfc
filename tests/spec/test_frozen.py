"""Nothing that carp_spec hands out can be changed, or given a field that it does not have."""

from dataclasses import is_dataclass
from typing import Any

import msgspec
import pytest
from tests.classes import classes_of

import carp_spec
from carp_spec.documents import InstanceDocument

DATACLASSES = [each for each in classes_of(carp_spec) if is_dataclass(each)]
STRUCTS = [each for each in classes_of(carp_spec) if issubclass(each, msgspec.Struct)]


@pytest.mark.parametrize("kind", DATACLASSES)
def test_data_are_frozen_and_slotted(kind: type[Any]) -> None:
    assert kind.__dataclass_params__.frozen
    assert "__slots__" in vars(kind)


@pytest.mark.parametrize("kind", STRUCTS)
def test_documents_are_frozen_and_refuse_unknown_fields(kind: type[msgspec.Struct]) -> None:
    config = kind.__struct_config__
    assert config.frozen
    assert config.forbid_unknown_fields or kind.__name__.startswith("_")


def test_the_classes_that_everybody_uses_are_among_them() -> None:
    assert {carp_spec.Plan, carp_spec.Rule, carp_spec.Verdict, carp_spec.Neighbourhood} <= {*DATACLASSES}
    assert InstanceDocument in STRUCTS
