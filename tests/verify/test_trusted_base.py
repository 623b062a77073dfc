"""The table of what must be trusted, in verify/README.md; run as a module it writes the table."""

import io
import re
import tokenize
from pathlib import Path

import pytest

from carp_spec.readme import markdown_table, with_section, write_section

ROOT = Path(__file__).parents[2]
README = ROOT / "verify" / "README.md"
LAW = ("check", "joint_rules", "plan_rules", "instance_rules", "documents", "model", "rule", "refusal")
BOUND = ("verify_bound", "bound_rules")
ENCODER = ("encoding", "robot_clauses", "clauses", "optimum_rules")
VERDICTS: dict[str, tuple[tuple[str, ...], str]] = {
    "`check`: no rule is broken": ((), ""),
    "`verify-bound`, without cuts": (BOUND, ""),
    "`verify-bound`, with cuts": ((*BOUND, "bound_cuts", *ENCODER, "refutation"), ""),
    "`verify-query` and `audit`": (("verify_query", "query_certificate_rules"), ""),
    "with `--kernel`": (("kernel",), "[the proved kernel](kernel/README.md), and not the law in Python"),
    "`verify-proof`, an optimum": (("proof", *ENCODER, "refutation"), ""),
    "`verify-proof`, unsolvable by clauses": (("proof", "unsolvable", *ENCODER, "refutation"), ""),
    "`verify-proof`, unsolvable otherwise": (("proof", "unsolvable", "joint_search", "optimum_rules"), ""),
    "`certify`: z3 agrees on capacity and exchange": (("certificate", "smt"), "z3"),
    "`theorems`: a lemma holds": (("engine", "smt", "vocabulary"), "z3, the argument by hand in the docstring"),
}


def lines_of_code(path: Path) -> int:
    """The lines that hold more than a comment or a docstring."""
    source = path.read_text()
    skipped = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
    lines: set[int] = set()
    begins = True
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        is_docstring = begins and token.type == tokenize.STRING
        if token.type not in skipped and not is_docstring:
            lines.update(range(token.start[0], token.end[0] + 1))
        if token.type not in {tokenize.COMMENT, tokenize.NL}:
            begins = token.type in {tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
    return len(lines)


def table() -> str:
    columns, rows = ("verdict", "beside the law, in `carp_verify`", "lines", "also"), []
    law = sum(lines_of_code(ROOT / "spec" / "carp_spec" / f"{name}.py") for name in LAW)
    for verdict, (modules, others) in VERDICTS.items():
        lines = sum(lines_of_code(ROOT / "verify" / "carp_verify" / f"{name}.py") for name in modules)
        named = ", ".join(f"`{name}`" for name in modules) or f"nothing; the law is {law} lines of `carp_spec`"
        rows.append((verdict, named, lines, others))
    return markdown_table(columns, rows, numbers=("lines",))


def test_the_page_lists_what_must_be_trusted_with_its_lines_of_code() -> None:
    page = README.read_text()
    assert page == with_section(page, "trusted base", table()), "make generated"


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


if __name__ == "__main__":
    write_section(README, "trusted base", table())
