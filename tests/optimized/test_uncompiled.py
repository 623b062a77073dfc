"""The same source runs uncompiled, and makes the same plans."""

import os
import subprocess
import sys

CROSSCHECK = "from carp_verify.crosscheck import first_difference; print(first_difference(60, seed=3))"


def test_the_engines_agree_with_compilation_switched_off() -> None:
    uncompiled = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "ignore", "-c", CROSSCHECK]
    done = subprocess.run(command, env=uncompiled, capture_output=True, text=True, check=False)
    assert done.stdout == "None\n", done.stderr
