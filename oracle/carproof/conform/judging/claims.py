"""The questions that a program is not asked, because it does not claim to plan their features."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from carp_spec import Carp
from carp_spec.limits import goals_stand_alone
from carproof.conform.cases import NUMBERS, Case, NumberOf, engine_for
from carproof.conform.judging.optimum import found_cost


def _has_more(of: NumberOf, case: Case) -> bool:
    return bool(of.values(case.instance))


FEATURES: Mapping[str, Callable[[Case], bool]] = {
    **{each.number.feature: partial(_has_more, each) for each in sorted(NUMBERS, key=lambda each: each.name)},
    "directed": lambda case: case.instance.graph.directed,
    "park": lambda case: case.instance.after_goal == "park",
    "vanish": lambda case: case.instance.after_goal == "vanish",
    "now": lambda case: case.now > 0 or any(plan.robot == case.robot for plan in case.solution.plans),
}
"""The features of a case beyond classical ones, the policies after the goal, and robots that are under way."""
UNSOLVABLE = "robots without a plan"


def features(case: Case) -> frozenset[str]:
    """The features by which a case is more than the simplest, in which robots vanish."""
    return frozenset(name for name, has in FEATURES.items() if name != "vanish" and has(case))


@dataclass(frozen=True, slots=True)
class Claims:
    """The features that a program does not claim; `solvable`: nor instances in which robots cannot have plans.

    Only with `groups` it claims groups, and only with `stops` robots with several stops or with service.
    """

    without: frozenset[str] = frozenset()
    solvable: bool = False
    groups: bool = False
    stops: bool = False

    @property
    def left_out(self) -> list[str]:
        """The features that the program is not asked, in the order of `FEATURES`, and what else it does not claim."""
        others = {UNSOLVABLE: self.solvable, "groups": not self.groups, "stops and service": not self.stops}
        return [
            *(name for name in FEATURES if name in self.without),
            *(name for name, is_out in others.items() if is_out),
        ]

    def why_not(self, case: Case) -> str | None:
        """The reason why the program is not asked a case, `None` if it is asked."""
        if case.instance.graph.groups and not self.groups:
            return "it does not claim groups"
        if not (self.stops or goals_stand_alone(case.instance)):
            return "it does not claim stops"
        for name, has in FEATURES.items():
            if name in self.without and has(case):
                return f"it does not claim {name}"
        return f"it does not claim {UNSOLVABLE}" if self.solvable and not is_solvable(case) else None


EVERYTHING = Claims()


def is_solvable(case: Case) -> bool:
    """Whether each robot that a case asks for has a plan; of whole instances, whether all can have plans together."""
    engine = engine_for(case.instance)
    if case.op == "check":
        return True
    if case.op in ("query", "add") and case.robot is not None:
        return engine.query(case.instance, case.solution.plans, case.robot, case.now) is not None
    if not engine.plan(case.instance, Carp()).unplanned:
        return True
    return case.planner is None and found_cost(case.instance)[1] is not None
