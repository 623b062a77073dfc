"""The planner to run: compiled code that makes the plans of `carp_reference`, visit for visit.

`query`, `plan`, `add`, `assign`, `polish` and `retime` are the same functions; `carp_optimized.fleet` has a fleet that
stays up. Importing this page loads neither numpy nor numba.
"""

from carp_optimized.neighbourhood.reuse import Queries, Reuse
from carp_optimized.planners import PLANNERS, add, assign, certifier, find, plan, polish, query, retime, steps

__all__ = [
    "PLANNERS",
    "Queries",
    "Reuse",
    "add",
    "assign",
    "certifier",
    "find",
    "plan",
    "polish",
    "query",
    "retime",
    "steps",
]
