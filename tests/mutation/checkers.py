"""Mutants of the modules that call something proved, verified or conforming, against their own tests.

`python -m tests.mutation.checkers` lists the mutants that no test notices; with names of modules, of these alone, and
with a name and lines, `carp_verify.optimum.refutation:89:91`, of these lines alone. The tests are the gate's, but
random ones draw at most `EXAMPLES`, and tests that take more than `LONGEST` seconds or start programs are left out. A
mutant takes the place of its module in a process forked after all tests have passed once, so that what they remember,
certificates for one, was made by the module as it is.
"""

import ast
import os
import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from time import process_time
from types import ModuleType

os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import pytest
from _pytest.runner import runtestprotocol
from tests.mutation.forking import ROOT, Case, chosen, outcome, run_mutants
from tests.mutation.mutants import Mutant, mutants

PIN = "verify/optimum/test_kept_formulas"
SEARCH = ("verify/optimum/test_joint_search", "verify/optimum/test_unsolvable")
FORMULAS = ("verify/optimum/test_encoding", PIN)
BOUNDS = (
    "verify/bound/test_bound",
    "verify/bound/test_groups",
    "verify/bound/test_formulas_of_sights",
    "verify/bound/test_refusals",
    "verify/bound/test_seen",
    "verify/test_forgery",
)
QUERIES = (
    "verify/query/test_query_certificate",
    "verify/test_forgery",
    "verify/test_vectors",
    "oracle/judging/test_audit",
)
ANSWERS = ("oracle/conform/judging/test_one_answer",)
REPORT = ("oracle/conform/reporting/test_report", *ANSWERS)
FOOTPRINTS = (
    "oracle/layouts/test_footprint_check",
    "oracle/layouts/test_footprints",
    "oracle/layouts/test_footprints_in_cells",
)
RELEASES = ("verify/release/test_witness", "oracle/execution/test_release")
AUDITS = ("oracle/judging/test_audit", "oracle/judging/test_reasons")
OUTCOMES = ("oracle/conform/judging/test_outcome",)
LEMMAS = ("verify/lemmas/test_lemmas", "verify/lemmas/test_formulas")
TESTS: Mapping[str, Sequence[str]] = {
    "carp_verify.bound.verify": (*BOUNDS, "verify/bound/test_stops"),
    "carp_verify.bound.least": (*BOUNDS, "verify/bound/test_stops"),
    "carp_verify.bound.network": (*BOUNDS, "verify/bound/test_stops"),
    "carp_verify.bound.tariff": BOUNDS,
    "carp_verify.bound.rules": (*BOUNDS, "optimum/test_gap", "oracle/api/test_bound"),
    "carp_verify.bound.cuts": BOUNDS,
    "carp_verify.optimum.refutation": ("verify/optimum/test_refutation", "verify/test_forgery"),
    "carp_verify.optimum.proof": (
        "verify/optimum/test_proof",
        PIN,
        "verify/test_forgery",
        "verify/optimum/test_unsolvable",
        "oracle/api/test_optimum",
    ),
    "carp_verify.optimum.unsolvable": ("verify/optimum/test_unsolvable", "verify/optimum/test_optimum"),
    "carp_verify.certificate": ("verify/test_certificate",),
    "carp_verify.lemmas.smt": (*LEMMAS, "verify/test_certificate"),
    "carp_verify.lemmas.engine": ("verify/lemmas/test_lemmas",),
    "carp_verify.lemmas.vocabulary": LEMMAS,
    "carp_verify.lemmas.derivation": LEMMAS,
    "carp_verify.footprint.apart": FOOTPRINTS,
    "carp_verify.footprint.cells": FOOTPRINTS,
    "carp_verify.footprint.floor": FOOTPRINTS,
    "carp_verify.footprint.meeting": ("verify/test_footprint_meeting", *FOOTPRINTS),
    "carproof.layouts.footprint": ("oracle/layouts/test_footprint_check", "oracle/layouts/test_footprints"),
    "carproof.layouts.turning": ("oracle/layouts/test_footprints", "oracle/layouts/test_layouts"),
    "carp_verify.kernel": ("verify/kernel/test_asking",),
    "carp_verify.query.verify": QUERIES,
    "carp_verify.query.rules": QUERIES,
    "carp_verify.optimum.joint_search": SEARCH,
    "carp_verify.optimum.rules": (
        "verify/optimum/test_proof",
        "verify/optimum/test_unsolvable",
        "verify/optimum/test_joint_search",
    ),
    "carp_verify.optimum.clauses": FORMULAS,
    "carp_verify.optimum.encoding": FORMULAS,
    "carp_verify.optimum.robot_clauses": FORMULAS,
    "carp_verify.release.verify": RELEASES,
    "carp_verify.release.holding": RELEASES,
    "carp_verify.release.rules": RELEASES,
    "carp_verify.routes": (*BOUNDS, "verify/bound/test_stops", *FORMULAS),
    "carp_verify.plain_files": ("verify/test_plain_files",),
    "carproof.judging.audit": AUDITS,
    "carproof.judging.unplanned": AUDITS,
    "carproof.judging.verdicts": (*AUDITS, "oracle/judging/test_kernel_option"),
    "carproof.conform.judging.judges": ANSWERS,
    "carproof.conform.judging.optimum": ANSWERS,
    "carproof.conform.judging.gave_up": ANSWERS,
    "carproof.conform.answers": ("oracle/conform/programs/test_replies",),
    "carproof.conform.levels": REPORT,
    "carproof.conform.judging.deciding": REPORT,
    "carproof.conform.run": (*REPORT, "oracle/conform/reporting/test_saving"),
    "carproof.conform.judging.outcome": (*OUTCOMES, *REPORT),
    "carproof.conform.programs.function": OUTCOMES,
    "carproof.conform.findings": (
        "oracle/conform/reporting/test_report",
        "oracle/conform/judging/test_one_answer",
        "oracle/conform/programs/test_replies",
        "oracle/conform/programs/test_executors",
        "oracle/conform/programs/test_hostile",
    ),
    "carproof.conform.judging.claims": ("oracle/conform/asking/test_claims",),
    "carproof.conform.judging.by_kernel": ("oracle/conform/judging/test_kernel",),
    "carproof.conform.shrinking": ("oracle/conform/asking/test_shrinking",),
    "carproof.conform.smaller": ("oracle/conform/asking/test_large", "oracle/conform/asking/test_shrinking"),
    "carproof.conform.asking.ladder": ("oracle/conform/asking/test_large",),
    "carproof.conform.judging.driving": ("oracle/conform/programs/test_executors",),
}
TINY = 80
"""The number of instances of test_tiny_optima.py, one by one, for modules that make or check formulas."""
PLANTED: Mapping[str, Sequence[tuple[str, str]]] = {
    "carp_verify.bound.verify": (
        ("is_weight(0, -left[robot])", "is_weight(certificate.scale, cut.multiplier)"),  # per cut, not per robot
        ("is_weight(0, -left[robot])", "True"),
    ),
    "carp_verify.bound.least": (
        ("apart(place) < most", "apart(place) < most - 1"),
        ("ticks + each * takes[place]", "ticks + 2 * each * takes[place]"),
        ("tick >= self.horizon", "tick >= self.horizon - 1"),
        ("min(cost, at.get(place, cost))", "cost"),  # the last to come, not the cheapest
    ),
    "carp_verify.bound.network": (
        ("map(sub, marks[place], of_source)", "map(sub, of_source, marks[place])"),
        (" - network.duration[each] for each", " for each"),
    ),
    "carp_verify.bound.tariff": (
        ("price * graph.resource[source].capacity", "price"),
        ("(self.across.get(resource), enter + 1)", "(None, 0)"),  # only movers pay for exchanges
        ("max(self.horizon, tick + 1)\n            for", "max(self.horizon, tick)\n            for"),
        ("max(self.horizon, tick + 1)\n            if", "max(self.horizon, tick)\n            if"),
    ),
    "carp_verify.bound.cuts": (("0 <= horizon <= cut.least", "0 <= horizon"),),
    "carp_verify.optimum.refutation": (
        (
            "for literal in known[hint] if -literal not in true]",
            "for literal in known[hint] if -literal not in true][:1]",
        ),
        ("    last = len(known)\n", "    last = 0\n"),
        ("        last = step.number\n        known[last]", "        known[step.number]"),
    ),
    "carp_verify.optimum.proof": (
        ("if answer == wrong:", 'if answer == wrong and name == "reach.cnf":'),  # z3's verdict on the other is ignored
        ("if answer == wrong:", 'if answer == wrong and name == "beat.cnf":'),
        ("!= manifest.sha256[name]", "is None"),
        ("if verdict.violations:", "if not verdict:"),
    ),
    "carp_verify.optimum.robot_clauses": (
        (
            "if target in self._rest and (self._drives_on or target != self.routes.there)",
            "if target in self._rest and target != self.routes.there",
        ),
    ),
}
"""Errors that an audit planted, some unnoticed by every test: texts of the modules, and their replacements."""
LEFT_OUT = (
    "on_a_large_map",
    "undecided_search",
    "keep_a_robot_waiting",
    "large_formula",
    "with_the_first_look",
    "in_a_time_that_hardly_grows",
)
LONGEST = 0.7
EXAMPLES = 40


class Tests:
    """A plugin of pytest that runs the collected tests against mutants, in place of running them once."""

    def __init__(self, lines: Mapping[str, Sequence[int]]) -> None:
        self.lines = lines

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Pass all tests once, then run the mutants of each module."""
        for item in session.items:
            draw_less(item)
        cases = {item: measured(item) for item in session.items}
        for name, lines in self.lines.items():
            own = [item for item in session.items if in_tests(item, TESTS[name])]
            found = [cases[item] for item in own] + (tiny_cases() if TESTS[name] in (FORMULAS, SEARCH) else [])
            ordered = sorted(found, key=lambda case: (case.is_pin, case.seconds))
            kept = [Case(case.run, 3 * case.seconds + 1, case.is_pin) for case in ordered if case.seconds <= LONGEST]
            module = sys.modules[name]
            path = Path(str(module.__file__))

            def load(mutant: Mutant, module: ModuleType = module) -> None:
                replace(module, mutant.source)

            if outcome(partial(replace, module, path.read_text(encoding="utf-8")), kept).status:
                sys.exit(f"the tests of {name} fail in a forked process without any mutation")
            print(f"{name}: {len(kept)} tests, {sum(case.seconds for case in ordered):.0f} s", flush=True)  # noqa: T201
            run_mutants(name, mutants(path, planted=PLANTED.get(name, ())), lines, kept, load, 0)
        return True


def tiny_cases() -> list[Case]:
    """The search for optima and both formulas, beside the joint search."""
    from tests.verify.optimum.test_tiny_optima import faults

    def ask(number: int) -> int:
        assert not list(faults(number))
        return 0

    return [Case(partial(ask, number), 0.1) for number in range(TINY)]


def draw_less(item: pytest.Item) -> None:
    """Let a random test draw no more than `EXAMPLES`."""
    from hypothesis import settings  # pytest wants to load it itself

    function = getattr(item, "function", None)
    own = getattr(function, "_hypothesis_internal_use_settings", None)
    if own is not None and own.max_examples > EXAMPLES:
        function._hypothesis_internal_use_settings = settings(own, max_examples=EXAMPLES)  # type: ignore[union-attr]


def measured(item: pytest.Item) -> Case:
    """A test with the seconds of the processor that it takes once all is loaded; ends the run if it fails."""
    seconds = 0.0
    for _ in range(2):
        started = process_time()
        run(item)
        seconds = process_time() - started
        if seconds < LONGEST or seconds > 3 * LONGEST:
            break
    return Case(partial(run, item), seconds, in_tests(item, [PIN]))


def run(item: pytest.Item) -> int:
    """Run a test."""
    item._initrequest()  # type: ignore[attr-defined]
    for report in runtestprotocol(item, log=False):
        if report.failed:
            raise AssertionError(f"{item.nodeid}: {report.longreprtext}")
    return 0


def in_tests(item: pytest.Item, files: Sequence[str]) -> bool:
    return any(item.path == ROOT / "tests" / f"{name}.py" for name in files)


def replace(module: ModuleType, source: str) -> None:
    """Run a source as the module, and give what it defines to all modules that have imported it.

    A class stays the same object if its text does: constants, other modules' classes and cases of tests refer to it.
    """
    before = dict(vars(module))
    path = Path(str(module.__file__))
    texts = {each.name: ast.dump(each) for each in classes(ast.parse(path.read_text(encoding="utf-8")))}
    tree = ast.parse(source)
    kept = [each for each in classes(tree) if texts.get(each.name) == ast.dump(each)]
    tree.body = [each for each in tree.body if each not in kept]
    for name in before.keys() - {each.name for each in kept}:
        if not name.startswith("__"):
            delattr(module, name)
    exec(compile(tree, str(path), "exec"), vars(module))  # noqa: S102 - a mutant is to be run
    for other in list(sys.modules.values()):
        names = vars(other) if str(getattr(other, "__file__", "")).startswith(str(ROOT)) else {}
        for name in [name for name in names if name in before and other is not module and not name.startswith("__")]:
            if names[name] is before[name]:
                setattr(other, name, getattr(module, name, None))


def classes(tree: ast.Module) -> Sequence[ast.ClassDef]:
    return [each for each in tree.body if isinstance(each, ast.ClassDef)]


def main(arguments: Sequence[str]) -> int:
    modules = chosen(arguments, list(TESTS))
    files = sorted({f"tests/{file}.py" for name in modules for file in TESTS[name]})
    plugins = ("cacheprovider", "xdist", "cov")
    left_out = " and ".join(f"not {name}" for name in LEFT_OUT)
    options = ["-qqs", "-k", left_out, *(f"-pno:{name}" for name in plugins)]
    return pytest.main([*options, *files], plugins=[Tests(modules)])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
