"""The published surface: every line of `surface.txt` is there, and more may be.

`python -m tests.test_surface` adds what is new. A line leaves the file by hand alone.
"""

import inspect
import json
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

import click
import pytest

import carproof as public
from carp_spec.documents.schema import FOLDER
from carproof.entry.cli import carproof
from carproof.protocol.ops import OPS
from carproof.rules import ALL_RULES

ROOT = Path(__file__).parent.parent
SURFACE = Path(__file__).with_name("surface.txt")
MODULES = ("carproof.formats", "carproof.generate", "carproof.testing.strategies")
FORMAT = re.compile(r'"(carproof-[a-z]+/\d+)"')


def commands(group: click.Group, name: str = "") -> Iterator[str]:
    """Every command with its options."""
    context = click.Context(group)
    for each in group.list_commands(context):
        command = group.get_command(context, each)
        assert command is not None
        path = f"{name}{each}"
        yield f"command {path}"
        for parameter in command.params:
            flags = (*parameter.opts, *parameter.secondary_opts) if isinstance(parameter, click.Option) else ()
            yield from (f"command {path} {flag}" for flag in flags)
        if isinstance(command, click.Group):
            yield from commands(command, f"{path} ")


def formats() -> Iterator[str]:
    """Every document format that a package names, and the fields of those with a schema."""
    for source in ROOT.glob("*/car*/**/*.py"):
        yield from (f"format {found}" for found in FORMAT.findall(source.read_text()))
    for schema in FOLDER.glob("*.json"):
        for name, definition in json.loads(schema.read_text())["$defs"].items():
            yield from (f"field {name}.{field}" for field in definition.get("properties", ()))


def names(module: ModuleType) -> Iterator[str]:
    """Every public name of a module, with the parameters of functions, and the fields and methods of classes."""
    for name in module.__all__:
        value = getattr(module, name)
        yield f"python {module.__name__}.{name}"
        if inspect.isfunction(value):
            yield from (f"python {module.__name__}.{name}({each})" for each in inspect.signature(value).parameters)
        if inspect.isclass(value):
            members = {*vars(value), *getattr(value, "__dataclass_fields__", ())}
            yield from (f"python {module.__name__}.{name}.{each}" for each in members if not each.startswith("_"))


def surface() -> set[str]:
    """Whatever there is now, a line each."""
    ops = (f"op {name}" for name in OPS)
    modules = (public, *map(import_module, MODULES))
    python = (line for module in modules for line in names(module))
    return {*commands(carproof), *formats(), *ops, *python, *(f"rule {rule.id}" for rule in ALL_RULES)}


def published() -> set[str]:
    return set(SURFACE.read_text().splitlines())


def test_nothing_published_is_missing() -> None:
    assert sorted(published() - surface()) == []


@pytest.mark.parametrize(
    "line",
    [
        "command plan --planner",
        "field PlanDocument.visits",
        "format carproof-bound/1",
        "op query",
        "python carproof.plan(instance)",
        "python carproof.Verdict.violations",
        "rule plan/move",
    ],
)
def test_a_line_of_each_kind_is_published(line: str) -> None:
    assert line in published()


if __name__ == "__main__":
    before = published() if SURFACE.exists() else set()
    SURFACE.write_text("".join(f"{line}\n" for line in sorted(before | surface())))
