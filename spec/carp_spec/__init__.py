"""The specification of context-aware route planning: model, rules, checker."""

from carp_spec.check import Verdict, check_update, judge, violations_of
from carp_spec.inputs.costs import plan_cost, stops_served, total_cost
from carp_spec.model import (
    AfterGoal,
    Group,
    Instance,
    Move,
    Plan,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    Stop,
    Visit,
)
from carp_spec.plan_rules import has_ended
from carp_spec.planners import (
    Carp,
    FixedPaths,
    Greedy,
    LongestFirst,
    Neighbourhood,
    Planner,
    Shuffled,
    TimeExpanded,
)
from carp_spec.refusal import Refusal
from carp_spec.rule import Fault, Rule, Violation

__all__ = [
    "AfterGoal",
    "Carp",
    "Fault",
    "FixedPaths",
    "Greedy",
    "Group",
    "Instance",
    "LongestFirst",
    "Move",
    "Neighbourhood",
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
    "Stop",
    "TimeExpanded",
    "Verdict",
    "Violation",
    "Visit",
    "check_update",
    "has_ended",
    "judge",
    "plan_cost",
    "stops_served",
    "total_cost",
    "violations_of",
]
