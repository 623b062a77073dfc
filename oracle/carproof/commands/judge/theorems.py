"""`carproof theorems`: the theorems proved in Coq, and the lemmas that z3 checks, by the rules that they support."""

import json
from collections.abc import Sequence
from difflib import get_close_matches
from time import perf_counter
from typing import TYPE_CHECKING

import click

from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document
from carproof.command_line.options import json_option, listed
from carproof.command_line.tables import print_line, print_table
from carproof.progress import progress

if TYPE_CHECKING:
    from carp_verify.lemmas.engine import LemmaReport
    from carp_verify.theorems import Theorem

COLUMNS = ("lemma", "rules", "formulas", "mutants refuted", "result")
RESULTS = {True: "checked", False: "FAILED"}
PROVED = ("theorem, proved in Coq", "file", "rules")


@listed(
    "List the theorems of the rules, and have z3 check lemmas.",
    "carproof theorems",
    "carproof theorems earliest_entry_dominates",
    "carproof theorems freed_stays_come_too_late",
    "carproof theorems --json > theorems.json",
)
@click.argument("name", required=False)
@json_option
def command(name: str | None, as_json: bool) -> Answer:
    """List the theorems and have z3 check all lemmas, or print the one called NAME in full.

    The theorems are those of the proved kernel: `make kernel` has Coq check their proofs, this command does not.

    A lemma has formulas about whole numbers of any size: z3 shows that their premises can hold and that their claims
    cannot fail. It also has mutants with one planted error, which z3 must refute by an example. The lemmas are not
    theorems about the planners: each names, after "By hand:", the induction and the link to the program that z3 does
    not check.

    Exit codes: 0 all are checked, 1 some fail (or z3 could not tell), 2 bad input.
    """
    from carp_verify.lemmas import MODULES, lemma_named  # noqa: PLC0415
    from carp_verify.lemmas.engine import examine  # noqa: PLC0415 - loads z3
    from carp_verify.theorems import THEOREMS  # noqa: PLC0415

    asked = None if name is None else known(name, (*MODULES, *(theorem.name for theorem in THEOREMS)))
    modules = [module for module in MODULES if asked in {None, module}]
    theorems = [theorem for theorem in THEOREMS if asked in {None, theorem.name}]
    started = perf_counter()
    reports: dict[str, LemmaReport] = {}
    with progress("checking", len(modules)) as advance:
        for module in modules:
            reports[module] = examine(lemma_named(module))
            advance()
    checked = all(report.checked for report in reports.values())
    if as_json:
        print_document(document(reports, theorems, checked))
    elif name is not None:
        for theorem in theorems:
            print_theorem(theorem)
        for report in reports.values():
            print_report(report)
    else:
        print_table(PROVED, [(each.name, each.file, ", ".join(each.rules)) for each in theorems])
        print_line("")
        rows = [
            (name, ", ".join(each.lemma.rules), len(each.formulas), len(each.refuted), RESULTS[each.checked])
            for name, each in reports.items()
        ]
        print_table(COLUMNS, rows, numbers=COLUMNS[2:4])
        for report in reports.values():
            print_failures(report)
        count = sum(report.checked for report in reports.values())
        print_line(f"\n{count} of {len(reports)} lemmas checked by z3 in {perf_counter() - started:.1f} s".strip())
    return Answer.of(checked)


def known(name: str, names: Sequence[str]) -> str:
    """The lemma or theorem of that name; an unknown name is refused with the nearest ones."""
    asked = name.replace("-", "_")
    if asked not in names:
        near = get_close_matches(asked, names, cutoff=0.4)
        hint = f"the nearest are {', '.join(near)}" if near else "carproof theorems lists them all"
        raise click.BadParameter(f"there is no lemma or theorem {name!r}; {hint}.", param_hint="NAME")
    return asked


def print_theorem(theorem: "Theorem") -> None:
    """Print a theorem: its statement, the rules that it supports, and where its proof is."""
    click.echo(f"{theorem.name}\n\n{theorem.statement}\n")
    print_line(f"Supports: {', '.join(theorem.rules) or 'no rule by itself'}")
    print_line(f"proved in Coq: {theorem.file}, checked by `make kernel`")


def print_report(report: "LemmaReport") -> None:
    """Print a lemma in full: its statement, its proved formulas, and the examples that refute its mutants."""
    click.echo(f"{report.lemma.name}\n\n{report.lemma.statement.strip()}\n")
    print_line(f"Supports: {', '.join(report.lemma.rules)}")
    print_table(["formula", "result"], [(formula, "proved by z3") for formula in report.formulas])
    print_table(["mutant", "refuted by"], report.refuted)
    print_failures(report)
    print_line("checked by z3, but for what is left by hand" if report.checked else "FAILED")


def print_failures(report: "LemmaReport") -> None:
    """Print why a lemma fails, if it does."""
    for failure in report.failures:
        print_line(f"{report.lemma.name}: {failure}")


def document(reports: "dict[str, LemmaReport]", theorems: "Sequence[Theorem]", checked: bool) -> bytes:
    """All reports and theorems as one JSON document."""
    lemmas = [
        {
            "lemma": module,
            "name": report.lemma.name,
            "statement": report.lemma.statement.strip(),
            "rules": report.lemma.rules,
            "checked": report.checked,
            "formulas": report.formulas,
            "mutants": [{"error": error, "refuted_by": model} for error, model in report.refuted],
            "failures": report.failures,
        }
        for module, report in reports.items()
    ]
    proved = [
        {"theorem": each.name, "statement": each.statement, "rules": each.rules, "file": each.file} for each in theorems
    ]
    return json.dumps({"checked": checked, "lemmas": lemmas, "theorems": proved}).encode() + b"\n"
