"""The trusted base of each verdict of carproof, with its lines of code."""

import io
import tokenize
from pathlib import Path

from carp_verify.theorems import THEOREMS
from carproof.markdown import markdown_table

ROOT = Path(__file__).parents[1]
KERNEL = ROOT / "verify" / "kernel"
LAW = ("check", "joint_rules", "plan_rules", "instance_rules", "model", "rule", "refusal")
BOUND = (
    *(f"bound/{each}" for each in ("verify", "least", "network", "tariff", "rules")),
    "documents/bounds",
    "routes",
)
FOOTPRINT = ("apart", "cells", "floor", "meeting", "rules")
ENCODER = ("optimum/encoding", "optimum/robot_clauses", "optimum/clauses", "optimum/rules", "routes")
CHECK = "`check`: no rule is broken"
VERDICTS: dict[str, tuple[tuple[str, ...], str]] = {
    CHECK: (("documents/decoding", "documents/fields", "documents/instances", "documents/solutions"), ""),
    "`check --footprint`: vehicles keep apart": (tuple(f"footprint/{each}" for each in FOOTPRINT), ""),
    "`verify`: a bound without cuts": (BOUND, ""),
    "`verify`: a bound with cuts": ((*BOUND, "bound/cuts", *ENCODER[:-1], "optimum/refutation"), ""),
    "`verify`: a query; `audit`": (("query/verify", "query/rules", "documents/query_certificates"), ""),
    "with `--kernel`": (
        ("kernel", "documents/bounds"),
        "[the proved kernel](#the-proved-kernel), and not the law in Python",
    ),
    "`verify`: the proof of an optimum": (("optimum/proof", "plain_files", *ENCODER, "optimum/refutation"), ""),
    "`verify`: unsolvable, by clauses": (
        ("optimum/proof", "plain_files", "optimum/unsolvable", *ENCODER, "optimum/refutation"),
        "",
    ),
    "`verify`: unsolvable, otherwise": (
        ("optimum/proof", "optimum/unsolvable", "optimum/joint_search", "optimum/rules"),
        "",
    ),
    "`check --z3`: z3 agrees on capacity and exchange": (("certificate", "lemmas/smt"), "z3"),
    "`theorems`: a lemma holds": (
        ("lemmas/engine", "lemmas/smt", "lemmas/vocabulary", "lemmas/derivation"),
        "z3, the argument by hand in the docstring",
    ),
}


def module_file(name: str) -> Path:
    """The file of a module of `carp_verify` or, for documents and limits, of `carp_spec`."""
    places = (ROOT / package / f"{name}.py" for package in ("verify/carp_verify", "spec/carp_spec"))
    return next(path for path in places if path.exists())


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
    """The verdicts as a table in Markdown."""
    columns, rows = ("verdict", "beside the law, in `carp_verify` or `carp_spec`", "lines", "also"), []
    law = sum(lines_of_code(ROOT / "spec" / "carp_spec" / f"{name}.py") for name in LAW)
    for verdict, (modules, others) in VERDICTS.items():
        lines = sum(lines_of_code(module_file(name)) for name in modules)
        named = ", ".join(f"`{name}`" for name in modules)
        if verdict == CHECK:
            named += f", as in all that follow; the law is {law} lines of `carp_spec`"
        rows.append((verdict, named, lines, others))
    return markdown_table(columns, rows, numbers=("lines",))


def theorems() -> str:
    """The theorems of the kernel as a table in Markdown."""
    rows = [
        (each.statement, f"`{each.name}`", f"`{each.module}.v`", ", ".join(f"`{rule}`" for rule in each.rules))
        for each in THEOREMS
    ]
    return markdown_table(("claim", "theorem", "file", "rules"), rows)
