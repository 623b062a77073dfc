"""The classes that a package defines."""

import importlib
import pkgutil
from collections.abc import Iterator
from types import ModuleType
from typing import Any


def classes_of(package: ModuleType) -> Iterator[type[Any]]:
    """Every class of every module of the package, except those imported from elsewhere."""
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        for value in vars(importlib.import_module(module.name)).values():
            if isinstance(value, type) and value.__module__ == module.name:
                yield value
