"""The documentation site: it builds strictly, needs no network, and leaves no public name or rule out."""

import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from html import unescape
from inspect import Parameter, isclass, signature
from pathlib import Path
from types import ModuleType

import click
import pytest

import carproof
import carproof.formats
import carproof.generate
import carproof.testing.strategies
from carproof.entry.cli import carproof as command
from carproof.rules import ALL_RULES

ROOT = Path(__file__).parents[2]
FETCHED = re.compile(r"""(src|srcset)=["']?(https?:)?//|<link[^>]*href=["']?(https?:)?//|@import|url\((https?:)?//""")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built as `make docs` builds it: a dead link, anchor or page left out of the menu is an error."""
    folder = tmp_path_factory.mktemp("site")
    build = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(folder)]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(build, cwd=ROOT, env=environment, check=False, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    return folder


def test_no_page_fetches_anything_from_the_network(site: Path) -> None:
    pages = [*site.rglob("*.html"), *site.rglob("*.css")]
    assert len(pages) > 30
    assert [page.name for page in pages if FETCHED.search(page.read_text())] == []


def test_the_search_runs_from_files(site: Path) -> None:
    assert (site / "assets" / "iframe-worker.js").is_file()
    assert (site / "search" / "search_index.js").read_text().startswith("var __index = ")


def test_every_rule_has_its_place_with_its_statement(site: Path) -> None:
    text = "".join((site / "reference" / page).read_text() for page in ("rules.html", "other-rules.html"))
    assert [rule.id for rule in ALL_RULES if f">{rule.id}<" not in text] == []


def test_every_command_has_its_place(site: Path) -> None:
    text = (site / "reference" / "commands.html").read_text()
    names = command.list_commands(click.Context(command))
    assert [name for name in names if f">{name}<" not in text] == []


def public() -> Iterator[tuple[str, object]]:
    """All public names, those of public modules too."""
    for module in (carproof, carproof.formats, carproof.generate, carproof.testing.strategies):
        for name in module.__all__:
            if not isinstance(getattr(module, name), ModuleType):
                yield f"{module.__name__}.{name}", getattr(module, name)


def test_the_page_of_the_api_shows_each_class_with_its_parameters_and_defaults(site: Path) -> None:
    sections = re.split(r'(?=<h\d id="carproof\.)', (site / "reference" / "python.html").read_text())
    texts = defaultdict[str, str](str)
    for section in sections:
        parts = section.partition('id="')[2].partition('"')[0].split(".")
        for length in range(2, len(parts) + 1):
            texts[".".join(parts[:length])] += unescape(re.sub(r"<[^>]+>", "", section))
    classes = {name: value for name, value in public() if isclass(value) and value.__init__ is not Exception.__init__}
    assert len(classes) > 20
    missing = [
        f"{name}: {parameter}"
        for name, kind in classes.items()
        for parameter in signature(kind).parameters.values()
        if not re.search(rf"\b{parameter.name}\b(: [^\n]+)?{_default_of(parameter)}", texts[name])
    ]
    assert missing == []
    assert [name for name, text in texts.items() if "ClassVar" in text] == []


def _default_of(parameter: Parameter) -> str:
    """The sign of a default: the value, or the name of a constant."""
    if parameter.default == "":
        return r"\s*=\s*(''|\"\")"
    is_plain = isinstance(parameter.default, int | str | None)
    return rf"\s*=\s*(['\"]?{re.escape(str(parameter.default))}\b|[A-Z_]+\b)" if is_plain else ""


def test_the_page_of_the_api_has_every_name_of_public_modules_and_no_private_one(site: Path) -> None:
    ids = set(re.findall(r'id="(carproof\.[^"]+)"', (site / "reference" / "python.html").read_text()))
    assert [name for name, _ in public() if name not in ids] == []
    assert [each for each in ids if "._" in each] == []
