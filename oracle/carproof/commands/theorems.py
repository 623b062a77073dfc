"""`carproof theorems`: have z3 check the lemmas behind the rules."""

import json
from collections.abc import Sequence
from difflib import get_close_matches
from time import perf_counter
from typing import TYPE_CHECKING

import click

from carproof.answer import Answer
from carproof.files import print_document
from carproof.options import examples, json_option
from carproof.progress import progress
from carproof.tables import print_line, print_table

if TYPE_CHECKING:
    from carp_verify.engine import LemmaReport

COLUMNS = ("lemma", "rules", "formulas", "mutants refuted", "result")


@click.command(
    short_help="Have z3 check the lemmas behind the rules.",
    epilog=examples(
        "carproof theorems",
        "carproof theorems earliest_entry_dominates",
        "carproof theorems --json > theorems.json",
    ),
)
@click.argument("name", required=False)
@json_option
def command(name: str | None, as_json: bool) -> Answer:
    """Have z3 check all lemmas, or check the one called NAME and print it in full.

    A lemma has formulas about whole numbers of any size: z3 shows that their premises can hold and that their
    claims cannot fail. It has mutants too, with one planted error, which z3 must refute by an example. The lemmas
    are no theorems about the planners: each says, after "By hand:", which induction and which link to the
    program z3 does not check.

    Exit codes: 0 all are checked, 1 some fail (or z3 could not tell), 2 bad input.
    """
    from carp_verify.engine import examine  # noqa: PLC0415 - loads z3
    from carp_verify.lemmas import MODULES, lemma_named  # noqa: PLC0415

    modules = MODULES if name is None else (known(name, MODULES),)
    started = perf_counter()
    reports: dict[str, LemmaReport] = {}
    with progress("checking", len(modules)) as advance:
        for module in modules:
            reports[module] = examine(lemma_named(module))
            advance()
    checked = all(report.checked for report in reports.values())
    if as_json:
        print_document(document(reports, checked))
    elif name is not None:
        print_report(reports[modules[0]])
    else:
        print_table(COLUMNS, [row(module, report) for module, report in reports.items()], numbers=COLUMNS[2:4])
        for report in reports.values():
            print_failures(report)
        count = sum(report.checked for report in reports.values())
        print_line(f"\n{count} of {len(reports)} lemmas checked by z3 in {perf_counter() - started:.1f} s".strip())
    return Answer.of(checked)


def known(name: str, modules: Sequence[str]) -> str:
    """The lemma of that name; an unknown name is refused with the nearest ones."""
    asked = name.replace("-", "_")
    if asked not in modules:
        near = get_close_matches(asked, modules, cutoff=0.4)
        hint = f"the nearest are {', '.join(near)}" if near else "carproof theorems lists them all"
        raise click.BadParameter(f"there is no lemma {name!r}; {hint}.", param_hint="NAME")
    return asked


def row(module: str, report: "LemmaReport") -> Sequence[object]:
    """A row of the columns."""
    result = "checked" if report.checked else "FAILED"
    return (module, ", ".join(report.lemma.rules), len(report.formulas), len(report.refuted), result)


def print_report(report: "LemmaReport") -> None:
    """Print a lemma in full: its statement, what z3 proved, and what refutes its mutants."""
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


def document(reports: "dict[str, LemmaReport]", checked: bool) -> bytes:
    """All reports as one JSON document."""
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
    return json.dumps({"checked": checked, "lemmas": lemmas}).encode() + b"\n"
