"""The public face of carproof, for authors of planners.

    from carproof import check, plan, read_instance

    instance = read_instance(Path("town.json").read_bytes())
    verdict = check(instance, plan(instance))

It has the model (`Instance`, `ResourceGraph`, `Resource`, `Robot`, `Solution`, `Plan`, `Visit`) and its documents
(`read_...`, `write_...`); the checker (`check`, with a `Verdict` of `Violation`s by the rules in `RULES`); the planners
(`plan`, `plan_within`, `query`, `add`, `polish`) with their options (`Carp`, `Neighbourhood`, ...); and bounds and
optima (`bound`, `verify_bound`, `optimum`). `carproof.formats` reads and writes other tools' formats,
`carproof.generate` makes instances, and `carproof.testing.strategies` draws them for hypothesis.

A name is loaded when it is first used, so that importing this page costs nothing.
"""

from importlib import import_module

TYPE_CHECKING = False  # typing is slow to load, and type checkers know the name
if TYPE_CHECKING:
    from typing import Any

    from carp_optimized import add, plan, query
    from carp_optimized.improve.annealing import polish
    from carp_optimized.improve.anytime import plan_within
    from carp_optimum.bound import lower_bound as bound
    from carp_optimum.optimum import optimum
    from carp_optimum.sat.core_guided import Optimum
    from carp_spec import (
        AfterGoal,
        Carp,
        Fault,
        FixedPaths,
        Greedy,
        Instance,
        LongestFirst,
        Move,
        Neighbourhood,
        Plan,
        Planner,
        Refusal,
        Resource,
        ResourceGraph,
        ResourceId,
        Robot,
        RobotId,
        Rule,
        Shuffled,
        Solution,
        TimeExpanded,
        Verdict,
        Violation,
        Visit,
        check_update,
        plan_cost,
        total_cost,
    )
    from carp_spec import judge as check
    from carp_spec.documents.bounds import BoundDocument, read_bound
    from carp_spec.documents.instances import read_instance, write_instance
    from carp_spec.documents.solutions import read_solution, write_solution
    from carp_spec.documents.verdicts import write_verdict
    from carp_verify.bound.verify import verify_bound
    from carproof.planner_options import planner_named
    from carproof.registry import RULES

_ELSEWHERE = {
    "add": "carp_optimized",
    "plan": "carp_optimized",
    "plan_within": "carp_optimized.improve.anytime",
    "polish": "carp_optimized.improve.annealing",
    "query": "carp_optimized",
    "check": "carp_spec:judge",
    "BoundDocument": "carp_spec.documents.bounds",
    "read_bound": "carp_spec.documents.bounds",
    "read_instance": "carp_spec.documents.instances",
    "read_solution": "carp_spec.documents.solutions",
    "write_instance": "carp_spec.documents.instances",
    "write_solution": "carp_spec.documents.solutions",
    "write_verdict": "carp_spec.documents.verdicts",
    "RULES": "carproof.registry",
    "planner_named": "carproof.planner_options",
    "bound": "carp_optimum.bound:lower_bound",
    "Optimum": "carp_optimum.sat.core_guided",
    "optimum": "carp_optimum.optimum",
    "verify_bound": "carp_verify.bound.verify",
}
"""The module of each name and its name there; all other names come from `carp_spec`."""

__all__ = [
    "RULES",
    "AfterGoal",
    "BoundDocument",
    "Carp",
    "Fault",
    "FixedPaths",
    "Greedy",
    "Instance",
    "LongestFirst",
    "Move",
    "Neighbourhood",
    "Optimum",
    "Plan",
    "Planner",
    "Refusal",
    "Resource",
    "ResourceGraph",
    "ResourceId",
    "Robot",
    "RobotId",
    "Rule",
    "Shuffled",
    "Solution",
    "TimeExpanded",
    "Verdict",
    "Violation",
    "Visit",
    "add",
    "bound",
    "check",
    "check_update",
    "optimum",
    "plan",
    "plan_cost",
    "plan_within",
    "planner_named",
    "polish",
    "query",
    "read_bound",
    "read_instance",
    "read_solution",
    "total_cost",
    "verify_bound",
    "write_instance",
    "write_solution",
    "write_verdict",
]


def __getattr__(name: str) -> "Any":  # noqa: ANN401 - any of the names above
    """Load a name of this page when it is first used."""
    if name == "__version__":
        return import_module("importlib.metadata").version("carproof")
    if name not in __all__:
        raise AttributeError(f"module 'carproof' has no attribute {name!r}")
    module, _, original = _ELSEWHERE.get(name, "carp_spec").partition(":")
    return getattr(import_module(module), original or name)


def __dir__() -> list[str]:
    """The names of this page."""
    return [*__all__, "__version__"]
