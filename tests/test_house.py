"""The layout of the house: which package may import which, and what an import may load."""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MAY_IMPORT: dict[str, set[str]] = {
    "carp_spec": set(),
    "carp_reference": {"carp_spec"},
    "carp_optimized": {"carp_spec"},
    "carp_verify": {"carp_spec"},
    "carp_optimum": {"carp_spec", "carp_reference", "carp_optimized", "carp_verify"},
    "carproof": {"carp_spec", "carp_reference", "carp_optimized", "carp_verify", "carp_optimum"},
    "carp_experiments": {"carp_spec", "carp_reference", "carp_optimized", "carp_verify", "carp_optimum", "carproof"},
}
READ_IN_A_MINUTE = 238  # words of English non-fiction: Brysbaert 2019, https://doi.org/10.1016/j.jml.2019.104047
SLOW_TO_LOAD = {"z3", "numba", "numpy", "pysat", "matplotlib", "hypothesis", "networkx"}


def packages() -> dict[str, Path]:
    return {path.name: path for path in ROOT.glob("*/*") if path.name in MAY_IMPORT}


def imported(package: Path) -> Iterator[tuple[str, str]]:
    for file in sorted(package.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or "."]
            for name in names:
                yield str(file.relative_to(ROOT)), name.partition(".")[0]


@pytest.mark.parametrize("package", packages())
def test_packages_import_only_along_the_arrows(package: str) -> None:
    against = [
        (file, name)
        for file, name in imported(packages()[package])
        if name in MAY_IMPORT and name not in MAY_IMPORT[package] | {package}
    ]
    assert not against


@pytest.mark.parametrize("package", packages())
def test_each_top_folder_holds_one_package_and_its_readme(package: str) -> None:
    folder = packages()[package].parent
    assert (folder / "README.md").is_file()
    assert [path.name for path in folder.iterdir() if (path / "__init__.py").is_file()] == [package]
    assert (folder / package / "py.typed").is_file()


@pytest.mark.parametrize("package", packages())
def test_importing_a_package_loads_nothing_slow(package: str) -> None:
    loaded = f"import sys, {package}; print(' '.join(sys.modules))"
    modules = subprocess.run([sys.executable, "-c", loaded], check=True, capture_output=True, text=True).stdout.split()
    assert not SLOW_TO_LOAD & set(modules)


def readme(package: str) -> str:
    return (packages()[package].parent / "README.md").read_text()


def words(package: str) -> int:
    """The words of a package's Python, names and operators included; `inputs` says nothing about plans."""
    files = [file for file in packages()[package].rglob("*.py") if file.parent.name != "inputs"]
    return sum(len(file.read_text().split()) for file in files)


def test_the_law_and_the_planners_to_read_take_an_hour() -> None:
    assert words("carp_spec") + words("carp_reference") <= 60 * READ_IN_A_MINUTE


@pytest.mark.parametrize("package", ["carp_spec", "carp_reference"])
def test_a_readme_names_the_minutes_to_read_the_package(package: str) -> None:
    (minutes,) = re.findall(r"takes? about (\d+) minutes to read", readme(package))
    assert words(package) <= int(minutes) * READ_IN_A_MINUTE + READ_IN_A_MINUTE / 2


def test_tests_that_pages_name_are_there() -> None:
    pages = [page for pattern in ("*.md", "[a-z]*/README.md", "docs/**/*.md") for page in ROOT.glob(pattern)]
    named = {name for page in pages for name in re.findall(r"`(tests/[a-z_/.]+)`", page.read_text())}
    assert len(named) > 50
    assert {name for name in named if not (ROOT / name).exists()} == set()


@pytest.mark.parametrize("package", packages())
def test_a_readme_names_every_module(package: str) -> None:
    modules = {path.stem for path in packages()[package].glob("*.py")} - {"__init__", "__main__"}
    assert modules - set(re.findall(r"`(\w+)(?:\.py)?`", readme(package))) == set()
