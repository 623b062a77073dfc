"""Everything compiled, unless tests run uncompiled."""

import os

import pytest


@pytest.fixture(scope="session", autouse=True)
def _compiled() -> None:
    """Compile before the first test, whose output would tell of it."""
    if os.environ.get("NUMBA_DISABLE_JIT") != "1":
        from carp_optimum.__main__ import compile_all

        compile_all()
