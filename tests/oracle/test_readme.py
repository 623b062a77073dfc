"""The commands in the READMEs and in the documentation are run here, and print what the pages say.

A block of `console` is run line by line; times are the only thing that may differ. A block with a `title` is a file of
that name, and one of `python` without a title is run. `make generated` takes over new output.
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from tests.profiles import rest_in
from tests.programs import require_programs

ROOT = Path(__file__).parent.parent.parent
READMES = [str(path.relative_to(ROOT)) for path in [*ROOT.glob("*.md"), *ROOT.glob("[a-z]*/README.md")]]
BLOCK = re.compile(r'^```(\w+)(?: title="(\S+)")?\n(.*?)^```', re.DOTALL | re.MULTILINE)
PAGES = [
    str(path.relative_to(ROOT))
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    if any(kind in {"console", "python"} for kind, _, _ in BLOCK.findall(path.read_text()))
]
TIME = re.compile(r" +\d+\.\d\d s$", re.MULTILINE)
WIDTH = re.compile(r"(?<=[ ─])[ ─]+")


def comparable(page: str) -> str:
    """The page without times, and without the widths that they give to tables."""
    return WIDTH.sub("", TIME.sub("", page))


def run_console(text: str, folder: Path) -> str:
    commands = [line.removeprefix("$ ") for line in text.splitlines() if line.startswith("$ ")]
    script = "status=0\n" + "".join(
        f"printf '%s\\n' {shlex.quote('$ ' + command)}; (exit $status); {command}\nstatus=$?\n" for command in commands
    )
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", "COLUMNS": "80"}
    return subprocess.run(
        ["/bin/sh", "-c", script],
        cwd=folder,
        env=environment,
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ).stdout


def run_page(text: str, folder: Path) -> str:
    """The page with the output that its commands give."""

    def run_block(block: re.Match[str]) -> str:
        kind, name, content = block.groups()
        if kind == "console":
            return f"```console\n{run_console(content, folder)}```"
        if name:
            (folder / name).write_text(content)
        elif kind == "python":
            subprocess.run([sys.executable, "-c", content], cwd=folder, check=True, stdout=subprocess.PIPE)
        return block[0]

    return BLOCK.sub(run_block, text)


@pytest.mark.parametrize("page", rest_in("ci", PAGES, 0))
def test_every_command_prints_what_the_page_says(page: str, tmp_path: Path) -> None:
    text = (ROOT / page).read_text()
    if page.endswith("other-language.md"):
        require_programs("go")
    assert comparable(run_page(text, tmp_path)) == comparable(text)


@pytest.mark.parametrize("page", READMES)
def test_every_link_leads_somewhere(page: str) -> None:
    links = re.findall(r"\]\(([^)#]+)", (ROOT / page).read_text())
    assert [link for link in links if not ((ROOT / page).parent / link).exists()] == []


if __name__ == "__main__":
    for page in sys.argv[1:] or PAGES:
        text = (ROOT / page).read_text()
        with tempfile.TemporaryDirectory() as folder:
            new = run_page(text, Path(folder))
        if comparable(new) != comparable(text):
            (ROOT / page).write_text(new)
