"""Shipped text is plain English: phrases that CONTRIBUTING.md asks to avoid do not occur in it."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
AVOIDED = (
    "tells",
    "told",
    "is said",
    "anew",
    "so many",
    "whoever",
    "that are there",
    "there is none",
    "is of",
    "goes on",
    "minds",
    "of which",
)
FOLDERS = ("spec", "reference", "optimized", "verify", "optimum", "oracle", "experiments", "docs", "tests")
KINDS = {".py", ".md", ".v", ".ml", ".js", ".css", ".html"}
BREAK = r"\s+(?:(?:#|//)\s+)?"
WHAT = re.compile(r"\bWhat\b[^.?]*(?:\.|\Z)")
"""A sentence that begins with What and asks nothing: it names no subject."""


def shipped() -> Iterator[Path]:
    """All text of the packages and the documentation, but not the stored results and the log of changes."""
    yield from (path for path in ROOT.glob("*.md") if path.name != "CHANGELOG.md")
    for folder in FOLDERS:
        files = (path for path in (ROOT / folder).rglob("*") if path.suffix in KINDS)
        yield from (
            path for path in files if path.parent != ROOT / "experiments" / "results" and path != Path(__file__)
        )


def phrase(words: str) -> re.Pattern[str]:
    """The phrase, also where a line breaks in it."""
    return re.compile(rf"\b{words.replace(' ', BREAK)}\b", re.IGNORECASE)


@pytest.mark.parametrize("words", AVOIDED)
def test_an_avoided_phrase_does_not_occur_in_shipped_text(words: str) -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in shipped()}
    assert len(texts) > 200
    assert [str(path.relative_to(ROOT)) for path, text in texts.items() if phrase(words).search(text)] == []


def test_no_sentence_begins_with_what_but_questions() -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in shipped() if path.suffix in {".py", ".md"}}
    assert [f"{path.relative_to(ROOT)}: {found}" for path, text in texts.items() for found in WHAT.findall(text)] == []


def test_readmes_are_short() -> None:
    words = {path: len(path.read_text(encoding="utf-8").split()) for path in ROOT.glob("[a-z]*/README.md")}
    assert len(words) == 7
    assert {path.parent.name: count for path, count in words.items() if count > 400} == {}
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 80


def test_a_question_may_begin_with_what() -> None:
    assert WHAT.search("It ends. What a plan\n    costs.")
    assert not WHAT.search("What does a plan cost? 3 ticks.")


def test_a_phrase_is_found_across_a_line_break_and_not_inside_a_word() -> None:
    assert phrase("there is none").search("if there\n    # is none")
    assert not phrase("told").search("untold_story")
