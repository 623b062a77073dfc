"""The layout of the house: which package may import which, which room leads to which, and what an import may load."""

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
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
SLOW_TO_LOAD = {"z3", "numba", "numpy", "pysat", "matplotlib", "hypothesis", "networkx"}
MOST_MODULES = 17
"""Of a folder: about a dozen."""


def packages() -> dict[str, Path]:
    return {path.name: path for path in ROOT.glob("*/*") if path.name in MAY_IMPORT}


@cache
def modules() -> dict[str, Path]:
    """All modules, and the packages' own, by their dotted names."""
    found = {}
    for package in packages().values():
        for file in sorted(package.rglob("*.py")):
            parts = file.relative_to(package.parent).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = file
    return found


def imports(file: Path, known: Mapping[str, Path]) -> Iterator[str]:
    """The modules of the house that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(file.read_text())):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom):
            assert node.module, f"{file}: imports are absolute"
            inside = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if name in known else node.module for name in inside]
        yield from (name for name in names if name in known)


@cache
def arrows() -> dict[str, set[str]]:
    known = modules()
    return {name: {each for each in imports(file, known) if each != name} for name, file in known.items()}


def room(module: str, known: Mapping[str, Path]) -> str:
    """The folder of a module; in a folder that has rooms of its own, each module stands for itself."""
    folder = known[module].parent
    has_rooms = any(folder in file.parent.parents for file in known.values())
    return module if has_rooms else str(folder.relative_to(ROOT))


def circle(graph: Mapping[str, set[str]]) -> object:
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return None


@pytest.mark.parametrize("package", packages())
def test_packages_import_only_along_the_arrows(package: str) -> None:
    against = [
        (name, other)
        for name, others in arrows().items()
        for other in others
        if name.partition(".")[0] == package and other.partition(".")[0] not in MAY_IMPORT[package] | {package}
    ]
    assert not against


def test_no_modules_import_each_other() -> None:
    assert circle(arrows()) is None


def test_no_rooms_import_each_other() -> None:
    known = modules()
    rooms: dict[str, set[str]] = {}
    for name, others in arrows().items():
        here = room(name, known)
        rooms.setdefault(here, set()).update(there for other in others if (there := room(other, known)) != here)
    assert circle(rooms) is None


def test_a_folder_holds_few_modules_and_says_its_one_idea() -> None:
    sizes = Counter(file.parent for file in modules().values() if file.name != "__init__.py")
    assert [str(folder) for folder, size in sizes.items() if size > MOST_MODULES] == []
    for folder in sizes:
        assert ast.get_docstring(ast.parse((folder / "__init__.py").read_text())), folder


def test_a_folder_of_tests_holds_few_modules() -> None:
    sizes = Counter(file.parent for file in (ROOT / "tests").rglob("*.py"))
    assert [str(folder) for folder, size in sizes.items() if size > MOST_MODULES] == []


def test_what_must_be_trusted_imports_nothing_of_the_command_line() -> None:
    """The trusted judge: the law, the checkers, and what of the public face calls a verdict."""
    trusted = [name for name in modules() if name.startswith(("carp_spec", "carp_verify", "carproof.judging"))]
    assert len(trusted) > 30
    known = arrows()
    printing = {other for name in trusted for other in known[name] if "command" in other}
    assert not printing


@pytest.mark.parametrize("package", packages())
def test_each_top_folder_holds_one_package_and_its_readme(package: str) -> None:
    folder = packages()[package].parent
    assert (folder / "README.md").is_file()
    assert [path.name for path in folder.iterdir() if (path / "__init__.py").is_file()] == [package]
    assert (folder / package / "py.typed").is_file()


@pytest.mark.parametrize("package", packages())
def test_importing_a_package_loads_nothing_slow(package: str) -> None:
    loaded = f"import sys, {package}; print(' '.join(sys.modules))"
    names = subprocess.run([sys.executable, "-c", loaded], check=True, capture_output=True, text=True).stdout.split()
    assert not SLOW_TO_LOAD & set(names)


def readme(package: str) -> str:
    return (packages()[package].parent / "README.md").read_text()


def test_tests_that_pages_name_are_there() -> None:
    pages = [page for pattern in ("*.md", "[a-z]*/README.md", "docs/**/*.md") for page in ROOT.glob(pattern)]
    named = {name for page in pages for name in re.findall(r"`(tests/[a-z_/.]+)`", page.read_text())}
    assert len(named) > 50
    assert {name for name in named if not (ROOT / name).exists()} == set()


@pytest.mark.parametrize("package", packages())
def test_a_readme_names_every_room_and_every_module_outside_of_rooms(package: str) -> None:
    folder = packages()[package]
    names = {path.stem for path in folder.glob("*.py")} - {"__init__", "__main__"}
    names |= {path.parent.name for path in folder.glob("*/__init__.py")}
    assert names - set(re.findall(r"`(\w+)(?:\.py|/)?`", readme(package))) == set()
