"""Sections of pages that programs write: `rules` stands between `<!-- rules: begin -->` and `<!-- rules: end -->`."""

from collections.abc import Iterable, Sequence
from pathlib import Path


def markdown_table(columns: Sequence[str], rows: Iterable[Sequence[object]], numbers: Sequence[str] = ()) -> str:
    """A table in Markdown; the columns of numbers are aligned to the right."""
    lines = (columns, ["---:" if column in numbers else "---" for column in columns], *rows)
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)


def write_section(file: Path, name: str, text: str) -> None:
    """Write the text into a page, as its section of that name; raises `ValueError` if it has no such section."""
    page = file.read_text(encoding="utf-8")
    begin, end = (f"<!-- {name}: {mark} -->\n" for mark in ("begin", "end"))
    before, has_begin, rest = page.partition(begin)
    _, has_end, after = rest.partition(end)
    if not (has_begin and has_end):
        raise ValueError(f"the page must have a section between {begin.strip()} and {end.strip()}")
    file.write_text(f"{before}{begin}{text}{end}{after}", encoding="utf-8")
