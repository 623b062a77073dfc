"""No data of the specification and the reference can be changed, or given a field that they do not have."""

import importlib
import pkgutil
from collections.abc import Iterator
from dataclasses import is_dataclass
from types import ModuleType
from typing import Any

import msgspec
import pytest

import carp_reference
import carp_spec
from carp_reference.problem import Problem
from carp_verify.documents import InstanceDocument


def classes_of(package: ModuleType) -> Iterator[type[Any]]:
    """Every class of every module of the package, except those imported from elsewhere."""
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        for value in vars(importlib.import_module(module.name)).values():
            if isinstance(value, type) and value.__module__ == module.name:
                yield value


DATACLASSES = [each for package in (carp_spec, carp_reference) for each in classes_of(package) if is_dataclass(each)]
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
    assert {carp_spec.Plan, carp_spec.Rule, carp_spec.Verdict, carp_spec.Neighbourhood, Problem} <= {*DATACLASSES}
    assert InstanceDocument in STRUCTS
