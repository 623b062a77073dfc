"""How many examples hypothesis draws, by the environment's HYPOTHESIS_PROFILE; test where it names none.

quick is for `make quick`, test for `make test`, ci for `make ci`, thorough for `make thorough`, nightly for runs of
hours, mutation for one mutant.
"""

import os
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, settings

PROFILE = os.environ.get("HYPOTHESIS_PROFILE", "test")
EXAMPLES = {"quick": 20, "test": 60, "ci": 200, "thorough": 1000, "nightly": 50_000, "mutation": 25}


def draws(count: int) -> int:
    """How many examples a test draws that draws `count` in the profile thorough; a mutant meets as many."""
    return count if PROFILE == "mutation" else max(5, count * EXAMPLES[PROFILE] // EXAMPLES["thorough"])


def rest_in(marked: str, values: Sequence[Any], *now: int) -> list[Any]:
    """Parameters: those at the indices always run, the others only where tests with the mark run."""
    mark = getattr(pytest.mark, marked)
    return [
        value if position in now else pytest.param(*(value if isinstance(value, tuple) else [value]), marks=mark)
        for position, value in enumerate(values)
    ]


def load_profile() -> None:
    """Make the profile that of all tests. Only long runs draw other examples each time."""
    repeatable = settings(derandomize=True, database=None, print_blob=True)
    for name, examples in EXAMPLES.items():
        settings.register_profile(
            name,
            parent=settings() if name == "nightly" else repeatable,
            max_examples=examples,
            deadline=None,
            phases=[Phase.explicit, Phase.generate] if name == "mutation" else list(Phase),
            suppress_health_check=[HealthCheck.too_slow],
        )
    settings.load_profile(PROFILE)
