"""Tables are legible on a terminal of 40 columns and in a pipe: no word is broken, and none is lost."""

import re

import pytest
from tests.oracle.running import Run

WIDTH = 40
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")
TIME = re.compile(r"\d+(\.\d+)? (m?s|s)\b")
TABLES = [
    "rules",
    "check town.json broken.json",
    "plan town.json --engine reference --planner carp",
    "bound town.json --steps 3",
    "optimum town.json",
    "audit town.json plans.json",
    "execution dependencies town.json plans.json",
    "execution simulate town.json plans.json --delays 0.5:2",
    "gap town.json --limit 5",
    "theorems",
]


def lines_of(text: str) -> list[str]:
    return [line for line in ESCAPE.sub("", text).splitlines() if line.strip("─ ")]


def words(lines: list[str]) -> set[str]:
    """The words but those that are broken because no line holds them, and times, which differ."""
    return {word for line in lines for word in TIME.sub("", line).split() if len(word) <= WIDTH // 2}


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("command", TABLES)
def test_a_narrow_terminal_shows_every_word_of_a_table_whole(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    piped = carproof(*command.split())
    assert piped.code in (0, 1, 3), piped
    assert piped.stdout
    monkeypatch.setenv("COLUMNS", str(WIDTH))
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    narrow = carproof(*command.split())
    shown = " ".join(lines_of(narrow.stdout)).replace(":", " ").split()
    missing = {word for word in words(lines_of(piped.stdout)) if word not in shown and word.rstrip(":") not in shown}
    assert missing == set(), narrow.stdout
