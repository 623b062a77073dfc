"""No data of the specification and the reference can be changed, or given a field that they do not have."""

import importlib
import pkgutil
from collections.abc import Iterable, Iterator
from dataclasses import is_dataclass
from types import ModuleType
from typing import Any

import msgspec
import pytest

import carp_reference
import carp_spec
from carp_reference.problem import Problem
from carp_spec import documents
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.instances import InstanceDocument


def modules_of(package: ModuleType) -> Iterator[ModuleType]:
    """Every module of the package."""
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        yield importlib.import_module(module.name)


def classes_of(modules: Iterable[ModuleType]) -> Iterator[type[Any]]:
    """Every class of the modules, except those imported from elsewhere."""
    for module in modules:
        for value in vars(module).values():
            if isinstance(value, type) and value.__module__ == module.__name__:
                yield value


MODULES = [*modules_of(carp_spec), *modules_of(carp_reference)]
DATACLASSES = [each for each in classes_of(MODULES) if is_dataclass(each)]
STRUCTS = [each for each in classes_of([*MODULES, *modules_of(documents)]) if issubclass(each, msgspec.Struct)]


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
    assert {InstanceDocument, BoundDocument} <= {*STRUCTS}
