"""`import carproof`: what an author of a planner finds there."""

import subprocess
import sys
from importlib import import_module
from inspect import getdoc, isroutine

import pytest
from tests.oracle.client import cost_of, lane

import carproof


def test_a_client_plans_and_checks_by_the_public_names_alone() -> None:
    assert cost_of(lane()) == 3


@pytest.mark.parametrize("name", carproof.__all__)
def test_each_name_is_there_and_documented(name: str) -> None:
    value = getattr(carproof, name)
    assert not (isroutine(value) or isinstance(value, type)) or getdoc(value)
    assert name in dir(carproof)


@pytest.mark.parametrize("module", ["formats", "generate", "testing.strategies"])
def test_the_rest_is_in_its_modules(module: str) -> None:
    assert import_module(f"carproof.{module}").__doc__


def test_another_name_is_refused() -> None:
    with pytest.raises(AttributeError, match="module 'carproof' has no attribute 'warehouse'"):
        carproof.warehouse  # noqa: B018 - the look-up is what is tested


def test_the_name_of_a_planner_is_refused_in_place_of_the_planner() -> None:
    with pytest.raises(carproof.Refusal, match="has no 'carp', only values of Carp, "):
        carproof.plan(lane(), "carp")  # type: ignore[arg-type]


def test_the_version_is_that_of_the_installation() -> None:
    shown = subprocess.run([sys.executable, "-m", "carproof", "--version"], check=True, capture_output=True, text=True)
    assert shown.stdout == f"carproof {carproof.__version__}\n"


def test_importing_the_face_loads_none_of_the_packages() -> None:
    program = "import sys, carproof; print(*(name for name in sys.modules if name.startswith('carp')))"
    loaded = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout
    assert loaded.split() == ["carproof"]
