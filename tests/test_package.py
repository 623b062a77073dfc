"""The package as an index shows it, and the versions of libraries that it takes."""

import re
import runpy
import sys
import tomllib
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from packaging.specifiers import SpecifierSet

ROOT = Path(__file__).parent.parent
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
README = (ROOT / "README.md").read_text()


@pytest.fixture
def description(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, str | None], str]:
    """The function of the build, without what builds."""
    interface = SimpleNamespace(MetadataHookInterface=object)
    monkeypatch.setitem(sys.modules, "hatchling.metadata.plugin.interface", interface)
    function: Callable[[str, str | None], str] = runpy.run_path(str(ROOT / "hatch_build.py"))["description"]
    return function


def test_the_description_has_no_link_that_leads_nowhere(description: Callable[[str, str | None], str]) -> None:
    without, described = (description(README, source) for source in (None, "https://example.org/carproof"))
    for text in (without, described):
        assert re.findall(r"\]\((?!https://)[^)]*\)", text) == []
        assert "[plan/start] resource 5,1 in [1,2): robot r2 (the first visit" in text
    assert "![" not in without
    assert "| try it for an hour | the tutorial |" in without
    assert "](https://example.org/carproof/raw/main/oracle/pictures/map.svg)" in described
    assert "[the tutorial](https://example.org/carproof/blob/main/docs/tutorial.md)" in described


def test_no_library_is_taken_in_an_untried_major_version() -> None:
    extras = PROJECT["optional-dependencies"]
    wanted = [*PROJECT["dependencies"], *extras["prove"], *extras["experiments"], *extras["test"]]
    assert [each for each in wanted if "<" not in each] == []


def test_every_pinned_library_runs_on_the_oldest_python_that_the_package_takes() -> None:
    oldest = f"{PROJECT['requires-python'].removeprefix('>=')}.0"
    refused = []
    for pin in (ROOT / "constraints.txt").read_text().splitlines():
        name = pin.partition("==")[0]
        try:
            known = metadata(name)
        except PackageNotFoundError:
            continue  # of another extra, or of another Python
        if "Requires-Python" in known and oldest not in SpecifierSet(known["Requires-Python"]):
            refused.append(f"{name} {known['Requires-Python']}")
    assert refused == []


def test_the_version_is_that_of_the_newest_changes() -> None:
    heading = next(line for line in (ROOT / "CHANGELOG.md").read_text().splitlines() if line.startswith("## "))
    number, _, state = heading.removeprefix("## ").partition(", ")
    assert PROJECT["version"].startswith(f"{number}.")
    assert ("dev" in PROJECT["version"]) == (state == "not released yet")


def test_the_page_of_versions_names_the_systems_that_an_index_shows() -> None:
    page = (ROOT / "docs" / "reference" / "versions.md").read_text()
    supported = page.partition("## Supported systems\n")[2].partition("\n## ")[0]
    systems = {each.rpartition(":: ")[2] for each in PROJECT["classifiers"] if each.startswith("Operating System")}
    assert systems == {system for system in ("Linux", "MacOS", "Windows") if system.lower() in supported.lower()}
    assert f"Python {PROJECT['requires-python'].removeprefix('>=')} or later" in supported
