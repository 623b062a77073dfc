"""All rules, in the order in which they are listed."""

from typing import Any

from carp_spec import neighbourhood_rules
from carp_spec.documents.decoding import has_format, has_shape, is_json
from carp_spec.execution.execution_rules import EXECUTION_RULES, TRACE_RULES, is_acyclic
from carp_spec.inputs.options import options_are_right
from carp_spec.instance_rules import INSTANCE_RULES
from carp_spec.joint_rules import JOINT_RULES, SOLUTION_RULES
from carp_spec.plan_rules import PLAN_RULES, is_plan_cost, is_total_cost, plan_keeps_history
from carp_spec.polish_rules import POLISH_RULES
from carp_spec.query_rules import absence_is_true, expansion_key, plan_is_optimal, plan_is_sound
from carp_spec.rule import Rule
from carp_spec.windows import stay_fits, windows_are_free
from carproof.execution.giving_way import robot_is_first

RULES: tuple[Rule[..., Any], ...] = (
    is_json,
    has_format,
    has_shape,
    *INSTANCE_RULES,
    *SOLUTION_RULES,
    *PLAN_RULES,
    *JOINT_RULES,
    is_plan_cost,
    is_total_cost,
    windows_are_free,
    stay_fits,
    plan_is_sound,
    plan_is_optimal,
    absence_is_true,
    expansion_key,
    neighbourhood_rules.baseline_is_tried,
    neighbourhood_rules.nearest,
    neighbourhood_rules.distance,
    neighbourhood_rules.replanned_from,
    neighbourhood_rules.neighbourhood_orders,
    neighbourhood_rules.replaces_best,
    neighbourhood_rules.next_trajectory,
    *POLISH_RULES,
    plan_keeps_history,
    *TRACE_RULES,
    *EXECUTION_RULES,
    is_acyclic,
    robot_is_first,
    options_are_right,
)
