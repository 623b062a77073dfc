"""Mutants of the specification and the reference, against their own tests.

`python -m tests.mutation.specified` lists the mutants that no test notices; with names of packages or modules, of these
alone, and with a name and lines, `carp_spec.windows:89:91`, of these lines alone. A process forked from one that has
loaded pytest, but neither package, imports the mutant in place of its module and runs the tests.
"""

import os
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import pytest
from tests.mutation.forking import ROOT, Case, Changed, chosen, outcome, run_mutants
from tests.mutation.mutants import Mutant, mutants

MODULES = {
    ".".join(path.relative_to(folder.parent).with_suffix("").parts): path
    for folder in (ROOT / "spec/carp_spec", ROOT / "reference/carp_reference")
    for path in sorted(folder.rglob("*.py"))
    if path.name != "__init__.py"
}
OPTIONS = ["-x", "-q", "-pno:cacheprovider", "-pno:xdist", "-pno:cov", "-k", "not every_small_query"]
SECONDS = 60
DOCUMENTS = ("spec/documents/test_described_documents", "verify/test_documents", "oracle/protocol/test_schema")
ALSO = {
    "carp_spec.check": ("spec/test_quick_check", "oracle/api/test_malformed_values"),
    "carp_spec.instance_rules": ("spec/test_plan_rules", "oracle/api/test_assign"),
    "carp_spec.plan_rules": ("spec/test_check", "verify/lemmas/test_rules_as_properties"),
    "carp_spec.joint_rules": ("spec/test_check",),
    "carp_spec.query_rules": ("verify/lemmas/test_rules_as_properties",),
    "carp_spec.rule": ("spec/test_check",),
    "carp_spec.requests": ("oracle/api/test_assign",),
    "carp_spec.execution.logs": ("oracle/execution/test_check_log", "oracle/api/test_malformed_values"),
    "carp_spec.documents.fields": DOCUMENTS,
    "carp_spec.documents.instances": DOCUMENTS,
    "carp_spec.documents.solutions": DOCUMENTS,
    "carp_spec.documents.decoding": DOCUMENTS,
    "carp_reference.time_expanded": ("reference/test_twins",),
}
"""Files of tests beside that of a module's own name."""


def tests_of(name: str) -> Iterator[Path]:
    """The tests of the module's own name, of its rules, and those named; where it has none, all of its package's."""
    package, *rooms, module = name.split(".")
    folder = ROOT / "tests" / package.removeprefix("carp_")
    own, also = folder.joinpath(*rooms, f"test_{module}.py"), ALSO.get(name, ())
    if own.exists():
        yield own
    elif not also:
        yield folder
    yield from (ROOT / "tests" / f"{each}.py" for each in ("verify/test_vectors", *also))


def run(tests: Sequence[Path]) -> int:
    """Run tests, which must pass."""
    assert pytest.main([*OPTIONS, *map(str, tests)]) == 0
    return 0


def main(arguments: Sequence[str]) -> int:
    for name, lines in chosen(arguments, list(MODULES)).items():
        path = MODULES[name]
        cases = [Case(partial(run, list(tests_of(name))), SECONDS)]
        if outcome(lambda: None, cases).status:
            sys.exit(f"the tests of {name} fail without any mutation")

        def load(mutant: Mutant, name: str = name, path: Path = path) -> None:
            sys.meta_path.insert(0, Changed(name, path, mutant.source))

        run_mutants(name, mutants(path), lines, cases, load, 0)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
