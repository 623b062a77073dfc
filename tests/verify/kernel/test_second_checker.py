"""A second verified checker, ACL2's, accepts the refutations of proofs of optima, of the kernel's own formulas."""

import subprocess
from pathlib import Path
from shutil import which

import pytest
from tests.verify.kernel.test_optimum import CORNERS, kernel_formula
from tests.verify.optimum.test_proof import drop_last_line, prove

PACKAGES = "acl2 and acl2-books"
BOOK = "projects/sat/lrat/stobj-based/run"

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(which("acl2") is None, reason=f"the second checker needs the Debian packages {PACKAGES}"),
]


def plain(formula: str) -> str:
    """The formula for ACL2, which refuses clauses with a literal twice, or with its contrary: copies replace these."""
    header, *lines = formula.splitlines()
    clauses = [list(dict.fromkeys(map(int, line.split()[:-1]))) for line in lines]
    telling = [clause for clause in clauses if not any(-literal in clause for literal in clause)]
    kept = [clause if clause in telling else telling[0] for clause in clauses]
    return "\n".join([header, *(" ".join(map(str, (*clause, 0))) for clause in kept)]) + "\n"


def is_verified(folder: Path, lrat: str) -> bool:
    """Whether ACL2's checker accepts a refutation of the kernel's formula of a proof directory."""
    (folder / "formula.cnf").write_text(plain(kernel_formula(folder)))
    (folder / "proof.lrat").write_text(lrat)
    asked = f'(include-book "{BOOK}" :dir :system)\n(lrat::lrat-check "formula.cnf" "proof.lrat")\n'
    program = which("acl2") or "acl2"
    done = subprocess.run([program], cwd=folder, input=asked, capture_output=True, text=True, check=False)
    return "s VERIFIED" in done.stdout


@pytest.mark.parametrize("name", CORNERS)
def test_a_refutation_is_accepted_by_acl2_too(name: str, tmp_path: Path) -> None:
    prove(CORNERS[name], tmp_path)
    lrat = (tmp_path / "beat.lrat").read_text()
    assert is_verified(tmp_path, lrat)
    assert not is_verified(tmp_path, drop_last_line(lrat))
