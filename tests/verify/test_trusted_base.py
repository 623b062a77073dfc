"""The trusted base: the modules that the documentation lists, and the lines of code that it counts."""

import re
from pathlib import Path

import pytest
from docs.trusted_base import ROOT, VERDICTS, lines_of_code


def test_docstrings_and_comments_are_no_lines_of_code(tmp_path: Path) -> None:
    path = tmp_path / "page.py"
    text = '"""A page.\n\nOf three lines.\n"""\n\n# why\nNUMBER = (\n    1\n)\n\n\n'
    path.write_text(text + 'def one() -> int:\n    """One."""\n    return 1\n')
    assert lines_of_code(path) == 5


@pytest.mark.parametrize("verdict", VERDICTS)
def test_what_a_trusted_module_imports_is_trusted_too(verdict: str) -> None:
    """A proof directory has one of three claims, and each needs a part of what `proof` imports."""
    named = {*VERDICTS[verdict][0]}
    of_proofs = {name for modules, _ in VERDICTS.values() if "proof" in modules for name in modules}
    known = of_proofs if "proof" in named else named
    for name in named:
        source = (ROOT / "verify" / "carp_verify" / f"{name}.py").read_text()
        assert set(re.findall(r"^from carp_verify\.(\w+) import", source, re.MULTILINE)) <= known


@pytest.mark.parametrize("name", sorted({name for modules, _ in VERDICTS.values() for name in modules}))
def test_what_is_trusted_imports_no_search(name: str) -> None:
    source = (ROOT / "verify" / "carp_verify" / f"{name}.py").read_text()
    assert not any(package in source for package in ("carp_optimum", "carp_optimized", "carp_reference", "pysat"))
