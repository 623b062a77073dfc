"""Compiled so that every index is checked, the planner makes the same plans, and none is out of bounds."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CACHE = Path(__file__).parents[2] / "build" / "bounds-checked"

CROSSCHECK = """
from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Resource, ResourceGraph, Robot
from carp_experiments.measuring.crosscheck import first_difference

fleet = PlannedFleet(Instance(ResourceGraph((Resource("a"),), ()), (Robot("r", "a", "a"),)))
try:
    passes.shortest(fleet.native, 1)
except IndexError:
    print("an index out of bounds is noticed")
print(first_difference(300, seed=5))
"""


@pytest.mark.nightly
def test_no_index_is_out_of_bounds() -> None:
    checked = {**os.environ, "NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": str(CACHE)}
    checked.pop("NUMBA_DISABLE_JIT", None)
    done = subprocess.run([sys.executable, "-c", CROSSCHECK], env=checked, capture_output=True, text=True, check=False)
    assert done.stdout == "an index out of bounds is noticed\nNone\n", done.stderr
