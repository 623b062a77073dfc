"""The documentation site: it builds strictly, needs no network, and leaves no public name or rule out."""

import os
import re
import subprocess
import sys
from pathlib import Path

import click
import pytest

import carproof
from carproof.cli import carproof as command
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


def test_every_public_name_is_on_the_page_of_the_api(site: Path) -> None:
    text = (site / "reference" / "python.html").read_text()
    assert [name for name in carproof.__all__ if f'id="carproof.{name}"' not in text] == []
