"""Everything compiled."""

import pytest


@pytest.fixture(scope="session", autouse=True)
def _compiled() -> None:
    """Compile before the first test, whose output would tell of it."""
    from carp_optimum.__main__ import compile_all

    compile_all()
