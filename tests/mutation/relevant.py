"""Run the tests of the module that a mutation has changed: what cosmic-ray runs for each mutant.

The working directory is a copy of the project, and the environment's ORIGINAL is where it was copied from.
"""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

PLUGINS_LEFT_OUT = ["-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:cov"]
TOO_LONG = ["-k", "not every_small_query"]
ALSO: dict[str, list[str]] = {
    "carp_spec.plan_rules": ["test_check.py", "../verify/test_rules_as_properties.py"],
    "carp_spec.joint_rules": ["test_check.py"],
    "carp_spec.rule": ["test_check.py"],
    "carp_reference.time_expanded": ["test_twins.py"],
    "carp_spec.documents.instances": ["test_documents.py", "test_schema.py"],
    "carp_spec.documents.solutions": ["test_documents.py", "test_schema.py"],
    "carp_spec.documents.decoding": ["test_documents.py", "test_schema.py"],
}


def changed_modules(copy: Path, original: Path) -> list[Path]:
    """The modules, as paths in the project, in which the two differ."""
    modules = sorted(path.relative_to(copy) for path in copy.glob("*/carp_*/**/*.py"))
    return [module for module in modules if (copy / module).read_bytes() != (original / module).read_bytes()]


def tests_of(module: Path) -> Iterator[Path]:
    """The tests of the module's own name and of its rules; where it has none, all of its package's."""
    package, *inside = module.parts[1:-1]
    folder = Path("tests") / package.removeprefix("carp_")
    own = folder / f"test_{module.stem}.py"
    if not own.exists():
        yield folder
        return
    yield own
    for name in [
        "../verify/test_vectors.py",
        "test_frozen.py",
        *ALSO.get(".".join([package, *inside, module.stem]), []),
    ]:
        if (folder / name).exists() and name != own.name:
            yield folder / name


def main() -> int:
    modules = changed_modules(Path.cwd(), Path(os.environ["ORIGINAL"]))
    tests = [str(path) for module in modules for path in tests_of(module)]
    return pytest.main(["-x", "-q", *PLUGINS_LEFT_OUT, *TOO_LONG, *(tests or sys.argv[1:])])


if __name__ == "__main__":
    sys.exit(main())
