"""The questions that a program is not asked, because it does not claim to plan their features."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from carp_spec import Carp, Instance
from carproof.conform.cases import Case
from carproof.conform.optimum import found_cost
from carproof.engines import engine_named

FEATURES: Mapping[str, Callable[[Instance], bool]] = {
    "capacities": lambda instance: any(resource.capacity > 1 for resource in instance.graph.resources),
    "durations": lambda instance: any(resource.duration > 1 for resource in instance.graph.resources),
    "paces": lambda instance: any(robot.pace > 1 for robot in instance.robots),
    "releases": lambda instance: any(robot.release > 0 for robot in instance.robots),
    "directed": lambda instance: instance.graph.directed,
    "park": lambda instance: instance.after_goal == "park",
    "vanish": lambda instance: instance.after_goal == "vanish",
}
"""The features of an instance beyond classical ones, and the policies after the goal."""
UNSOLVABLE = "robots without a plan"


def features(instance: Instance) -> frozenset[str]:
    """The features by which an instance is more than the simplest, in which robots vanish."""
    return frozenset(name for name, has in FEATURES.items() if name != "vanish" and has(instance))


@dataclass(frozen=True, slots=True)
class Claims:
    """The features that a program does not claim; `solvable`: nor instances in which robots cannot have plans."""

    without: frozenset[str] = frozenset()
    solvable: bool = False

    @property
    def left_out(self) -> list[str]:
        """The features that the program is not asked, in the order of `FEATURES`."""
        return [name for name in FEATURES if name in self.without] + [UNSOLVABLE] * self.solvable

    def why_not(self, case: Case) -> str | None:
        """The reason why the program is not asked a case, `None` if it is asked."""
        for name, has in FEATURES.items():
            if name in self.without and has(case.instance):
                return f"it does not claim {name}"
        return f"it does not claim {UNSOLVABLE}" if self.solvable and not is_solvable(case) else None


EVERYTHING = Claims()


def is_solvable(case: Case) -> bool:
    """Whether each robot that a case asks for has a plan; of whole instances, whether all can have plans together."""
    reference = engine_named("reference")
    if case.op == "check":
        return True
    if case.op in ("query", "add") and case.robot is not None:
        return reference.query(case.instance, case.solution.plans, case.robot, case.now) is not None
    if not reference.plan(case.instance, Carp()).unplanned:
        return True
    return case.planner is None and found_cost(case.instance)[1] is not None
