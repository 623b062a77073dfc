"""Every rule has evidence of each kind: vectors that keep it and that break it, a property, a lemma or a reason."""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from tests.verify.support import UNSUPPORTED, support_of_rules

from carproof.registry import RULES
from carproof.testing.vectors import vectors

TESTS = Path(__file__).parent.parent
_FAULTS = "verify/test_rules_as_properties.py::test_a_fault_planted_in_an_instance_is_found_and_no_other"
_BROKEN = "verify/test_strategies.py::test_broken_solutions_break_the_rules_they_name"
_PLANS = "spec/test_check.py::test_the_checker_agrees_with_the_rules_spelt_out_plan_by_plan"
_TICKS = "spec/test_check.py::test_the_checker_agrees_with_the_rules_spelt_out_tick_by_tick"
_RULES = "verify/test_rules_as_properties.py"
_TWINS = "reference/test_twins.py"
_NEIGHBOURS = "reference/test_neighbourhood_properties.py"
_EXECUTION = "spec/test_execution_properties.py"
_POLISH = "spec/test_polish_rules.py"
PROPERTIES: Mapping[str, str] = {
    "document/json": f"{_RULES}::test_a_document_cut_short_is_no_json",
    "document/format": f"{_RULES}::test_any_other_format_is_refused",
    "document/shape": f"{_RULES}::test_a_fraction_anywhere_in_a_document_has_not_the_shape",
    "instance/resource-id": _FAULTS,
    "instance/capacity": _FAULTS,
    "instance/duration": _FAULTS,
    "instance/position": _FAULTS,
    "instance/edge": _FAULTS,
    "instance/group": _FAULTS,
    "instance/robot-id": _FAULTS,
    "instance/endpoint": _FAULTS,
    "instance/stops": _FAULTS,
    "instance/release": _FAULTS,
    "instance/pace": _FAULTS,
    "instance/after-goal": _FAULTS,
    "instance/following": _FAULTS,
    "solution/covers": _BROKEN,
    "solution/order": _BROKEN,
    "plan/start": _PLANS,
    "plan/goal": _PLANS,
    "plan/stops": _PLANS,
    "plan/resource": _PLANS,
    "plan/move": _PLANS,
    "plan/contiguous": _PLANS,
    "plan/duration": _PLANS,
    "joint/capacity": _TICKS,
    "joint/group": "spec/test_check.py::test_the_checker_agrees_with_groups_spelt_out_tick_by_tick",
    "joint/exchange": _TICKS,
    "joint/following": f"{_EXECUTION}::test_following_is_what_is_too_full_if_robots_count_a_tick_longer",
    "cost/robot": f"{_RULES}::test_costs_are_the_ticks_before_the_last_visits",
    "cost/total": f"{_RULES}::test_costs_are_the_ticks_before_the_last_visits",
    "window/free": "spec/test_windows.py::test_free_windows_are_the_maximal_runs_of_free_ticks",
    "window/fits": "spec/test_windows.py::test_a_stay_fits_if_all_its_ticks_are_in_the_window_and_enough",
    "query/sound": f"{_TWINS}::test_a_robot_under_way_arrives_as_early_by_windows_as_by_ticks",
    "query/optimal": f"{_TWINS}::test_a_new_robot_arrives_as_early_by_windows_as_by_ticks",
    "query/complete": f"{_TWINS}::test_a_robot_replanned_against_other_plans_arrives_as_early_by_windows_as_by_ticks",
    "query/ties": f"{_RULES}::test_what_is_expanded_first_is_best_in_each_respect_among_its_equals",
    "neighbourhood/baseline": f"{_RULES}::test_there_is_always_a_first_candidate",
    "neighbourhood/nearest": "spec/test_neighbourhood_rules.py"
    "::test_nearest_is_the_first_with_the_least_distance_to_any_member",
    "neighbourhood/distance": "spec/test_neighbourhood_rules.py"
    "::test_distance_is_the_mean_of_the_distances_tick_by_tick",
    "neighbourhood/replan": f"{_NEIGHBOURS}::test_replanning_from_scratch_equals_keeping_the_prefix_in_paper_mode",
    "neighbourhood/orders": "spec/test_permutations.py"
    "::test_sampled_orders_are_the_first_distinct_shuffles_of_the_stream",
    "neighbourhood/best": f"{_RULES}::test_the_best_of_all_candidates_is_the_first_of_the_cheapest",
    "neighbourhood/update": f"{_RULES}::test_a_trajectory_is_the_last_plan_that_was_found",
    "polish/draws": f"{_POLISH}::test_some_are_drawn_as_all_are_and_each_once",
    "polish/kind": f"{_POLISH}::test_rounds_repair_in_turn_and_end_when_nothing_is_left",
    "polish/pivot": f"{_POLISH}::test_a_pivot_is_chosen_by_as_many_numbers_as_its_weight",
    "polish/members": f"{_POLISH}::test_members_are_the_pivot_the_first_candidates_and_others",
    "polish/way": f"{_POLISH}::test_in_the_way_is_who_is_near_between_the_first_tick_and_the_last",
    "polish/contested": f"{_POLISH}::test_robots_that_cross_a_resource_are_apart_by_ticks",
    "polish/near": f"{_POLISH}::test_near_robots_come_by_distance_and_equals_in_their_order",
    "polish/order": f"{_POLISH}::test_an_order_has_each_member_once_and_a_repair_begins_with_the_pivot",
    "polish/kept": f"{_POLISH}::test_what_is_kept_leaves_fewer_unplanned_or_as_many_at_no_larger_total",
    "polish/options": f"{_POLISH}::test_options_are_numbers_within_their_bounds",
    "fleet/history": "spec/test_plan_rules.py::test_history_is_kept_if_the_robot_was_tick_by_tick_where_it_was",
    "trace/robots": f"{_EXECUTION}::test_a_trace_that_is_none_is_found_before_rules_of_execution",
    "trace/prefix": f"{_EXECUTION}::test_a_trace_that_is_none_is_found_before_rules_of_execution",
    "trace/ticks": f"{_EXECUTION}::test_a_trace_that_is_none_is_found_before_rules_of_execution",
    "execution/duration": f"{_EXECUTION}::test_a_trace_breaks_the_rules_spelt_out_pair_by_pair",
    "execution/order": f"{_EXECUTION}::test_a_trace_breaks_the_rules_spelt_out_pair_by_pair",
    "execution/exchange": f"{_EXECUTION}::test_a_trace_breaks_the_rules_spelt_out_pair_by_pair",
    "execution/acyclic": f"{_EXECUTION}::test_a_solution_has_a_cycle_if_its_edges_spelt_out_have_one",
    "priority/first": "oracle/test_giving_way.py"
    "::test_an_update_is_lawful_keeps_histories_and_is_first_where_it_says_so",
    "planner/options": f"{_RULES}::test_options_are_whole_numbers_within_their_bounds",
}


def properties(file: str) -> Iterator[str]:
    """The tests of a file for which hypothesis draws examples."""
    for node in ast.parse((TESTS / file).read_text()).body:
        if isinstance(node, ast.FunctionDef):
            drawn = any(ast.unparse(each).startswith("given(") for each in node.decorator_list)
            yield from [node.name] if drawn and node.name.startswith("test_") else []


@pytest.mark.parametrize("rule", [rule.id for rule in RULES])
def test_every_rule_has_vectors_a_property_and_support_or_a_reason(rule: str) -> None:
    cases = list(vectors(rule))
    assert any(not case.violated for case in cases)
    assert any(rule in case.violated for case in cases)
    file, _, name = PROPERTIES[rule].partition("::")
    assert name in properties(file)
    assert (rule in support_of_rules()) != bool(UNSUPPORTED.get(rule))


def test_no_evidence_is_of_a_rule_that_there_is_not() -> None:
    rules = {rule.id for rule in RULES}
    assert PROPERTIES.keys() == support_of_rules().keys() | UNSUPPORTED.keys() == rules
