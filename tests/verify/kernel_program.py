"""The proved kernel, for tests."""

import fcntl
import os
import subprocess
from functools import cache
from pathlib import Path
from shutil import which

import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/kernel/carproof-kernel"
PACKAGES = "coq, ocaml, ocaml-findlib, libyojson-ocaml-dev and libzarith-ocaml-dev"


@cache
def program() -> str:
    """The kernel, made by `make kernel` if its sources have changed; for the first time only where all is required."""
    is_required = os.environ.get("CARPROOF_REQUIRE_ALL") == "1"
    if not all(map(which, ("coqc", "ocamlfind", "ocamlopt"))):
        reason = f"the kernel needs the Debian packages {PACKAGES}"
        if is_required:
            pytest.fail(reason)
        pytest.skip(reason)
    if not is_required and not PROGRAM.exists():
        pytest.skip("the kernel is not built yet, which takes Coq a minute: make kernel")
    PROGRAM.parent.mkdir(parents=True, exist_ok=True)
    with (PROGRAM.parent / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        made = subprocess.run(
            [which("make") or "make", "kernel"], cwd=ROOT, capture_output=True, text=True, check=False
        )
    assert made.returncode == 0, made.stderr
    return str(PROGRAM)
