"""Every rule has evidence of each kind: vectors that keep it and that break it, a property, a lemma or a reason."""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from tests.verify.lemmas.support import UNSUPPORTED, support_of_rules

from carproof.registry import RULES
from carproof.testing.vectors import vectors

TESTS = Path(__file__).parents[2]
TESTED: Mapping[str, Mapping[str, str]] = {
    "verify/lemmas/test_rules_as_properties.py": {
        "test_a_document_cut_short_is_no_json": "document/json",
        "test_any_other_format_is_refused": "document/format",
        "test_a_fraction_anywhere_in_a_document_has_not_the_shape": "document/shape",
        "test_a_fault_planted_in_an_instance_is_found_and_no_other": """
            instance/resource-id instance/capacity instance/duration instance/position instance/edge instance/group
            instance/robot-id instance/endpoint instance/stops instance/release instance/pace instance/after-goal
            instance/following
        """,
        "test_costs_are_the_ticks_before_the_last_visits": "cost/robot cost/total",
        "test_what_is_expanded_first_is_best_in_each_respect_among_its_equals": "query/ties",
        "test_before_a_goal_is_free_for_ever_the_nearest_window_is_expanded_first": "query/ties",
        "test_there_is_always_a_first_candidate": "neighbourhood/baseline",
        "test_the_best_of_all_candidates_is_the_first_of_the_cheapest": "neighbourhood/best",
        "test_a_trajectory_is_the_last_plan_that_was_found": "neighbourhood/update",
        "test_options_are_whole_numbers_within_their_bounds": "planner/options",
    },
    "verify/test_strategies.py": {
        "test_broken_solutions_break_the_rules_they_name": "solution/covers solution/order",
    },
    "spec/test_check.py": {
        "test_the_checker_agrees_with_the_rules_spelt_out_plan_by_plan": """
            plan/start plan/goal plan/stops plan/resource plan/move plan/contiguous plan/duration
        """,
        "test_the_checker_agrees_with_the_rules_spelt_out_tick_by_tick": "joint/capacity joint/exchange",
        "test_the_checker_agrees_with_groups_spelt_out_tick_by_tick": "joint/group",
    },
    "spec/execution/test_execution_properties.py": {
        "test_following_is_what_is_too_full_if_robots_count_a_tick_longer": "joint/following",
        "test_a_trace_that_is_none_is_found_before_rules_of_execution": "trace/robots trace/prefix trace/ticks",
        "test_a_trace_breaks_the_rules_spelt_out_pair_by_pair": "execution/duration execution/order execution/exchange",
        "test_a_solution_has_a_cycle_if_its_edges_spelt_out_have_one": "execution/acyclic",
    },
    "spec/test_windows.py": {
        "test_free_windows_are_the_maximal_runs_of_free_ticks": "window/free",
        "test_a_stay_fits_if_all_its_ticks_are_in_the_window_and_enough": "window/fits",
    },
    "reference/test_twins.py": {
        "test_a_robot_under_way_arrives_as_early_by_windows_as_by_ticks": "query/sound",
        "test_a_new_robot_arrives_as_early_by_windows_as_by_ticks": "query/optimal",
        "test_a_robot_replanned_against_other_plans_arrives_as_early_by_windows_as_by_ticks": "query/complete",
    },
    "spec/test_neighbourhood_rules.py": {
        "test_nearest_is_the_first_with_the_least_distance_to_any_member": "neighbourhood/nearest",
        "test_distance_is_the_mean_of_the_distances_tick_by_tick": "neighbourhood/distance",
    },
    "reference/test_neighbourhood_properties.py": {
        "test_replanning_from_scratch_equals_keeping_the_prefix_in_paper_mode": "neighbourhood/replan",
    },
    "spec/test_permutations.py": {
        "test_sampled_orders_are_the_first_distinct_shuffles_of_the_stream": "neighbourhood/orders",
    },
    "spec/test_polish_rules.py": {
        "test_some_are_drawn_as_all_are_and_each_once": "polish/draws",
        "test_rounds_repair_in_turn_and_end_when_nothing_is_left": "polish/kind",
        "test_a_pivot_is_chosen_by_as_many_numbers_as_its_weight": "polish/pivot",
        "test_members_are_the_pivot_the_first_candidates_and_others": "polish/members",
        "test_in_the_way_is_who_is_near_between_the_first_tick_and_the_last": "polish/way",
        "test_robots_that_cross_a_resource_are_apart_by_ticks": "polish/contested",
        "test_near_robots_come_by_distance_and_equals_in_their_order": "polish/near",
        "test_an_order_has_each_member_once_and_a_repair_begins_with_the_pivot": "polish/order",
        "test_what_is_kept_leaves_fewer_unplanned_or_as_many_at_no_larger_total": "polish/kept",
        "test_options_are_numbers_within_their_bounds": "polish/options",
    },
    "spec/test_plan_rules.py": {
        "test_history_is_kept_if_the_robot_was_tick_by_tick_where_it_was": "fleet/history",
    },
    "oracle/execution/test_giving_way.py": {
        "test_an_update_is_lawful_keeps_histories_and_is_first_where_it_says_so": "priority/first",
    },
}
"""Files with their random tests, and the rules that each tests."""
PROPERTIES = {
    rule: (file, name) for file, tests in TESTED.items() for name, rules in tests.items() for rule in rules.split()
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
    file, name = PROPERTIES[rule]
    assert name in properties(file)
    assert (rule in support_of_rules()) != bool(UNSUPPORTED.get(rule))


def test_no_evidence_is_of_a_rule_that_there_is_not() -> None:
    rules = {rule.id for rule in RULES}
    assert PROPERTIES.keys() == support_of_rules().keys() | UNSUPPORTED.keys() == rules
