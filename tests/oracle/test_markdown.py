"""Sections of pages that programs write."""

from pathlib import Path

import pytest

from carproof.markdown import with_section, write_section


def test_writing_a_section_replaces_it_and_nothing_else(tmp_path: Path) -> None:
    page = tmp_path / "README.md"
    page.write_text("before\n<!-- rules: begin -->\nold\n<!-- rules: end -->\nafter\n")
    write_section(page, "rules", "new\n")
    assert page.read_text() == "before\n<!-- rules: begin -->\nnew\n<!-- rules: end -->\nafter\n"


@pytest.mark.parametrize("page", ["", "<!-- rules: begin -->\n", "<!-- rules: end -->\n<!-- rules: begin -->\n"])
def test_a_page_without_the_section_is_refused(page: str) -> None:
    with pytest.raises(ValueError, match="rules: begin"):
        with_section(page, "rules", "")
