"""Properties of rules that no other module tests as such: what breaks them at random is found, and nothing else."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, TypeAlias

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from tests.profiles import draws

from carp_spec import (
    FixedPaths,
    Group,
    Instance,
    Neighbourhood,
    Plan,
    Refusal,
    ResourceGraph,
    Shuffled,
    Solution,
    Stop,
    Visit,
    plan_cost,
)
from carp_spec.documents.instances import read_instance, write_instance
from carp_spec.inputs.options import LARGEST_SAMPLE, options_are_right
from carp_spec.instance_rules import instance_faults
from carp_spec.neighbourhood_rules import baseline_is_tried, next_trajectory, replaces_best
from carp_spec.plan_rules import is_plan_cost, is_total_cost
from carp_spec.planners import LARGEST_SEED
from carp_spec.query_rules import expansion_key
from carproof.testing.strategies import PlannedInstance, Sizes, instances, planned_instances

Plant: TypeAlias = Callable[[Instance, st.DataObject], Instance]
WITH_ROBOTS = instances(Sizes(groups=2), least_robots=1)
TOO_SMALL = st.integers(max_value=0) | st.sampled_from([True, 1.0, "1", None])
NOWHERE = "no resource of the graph"


def _on_graph(instance: Instance, **changes: Any) -> Instance:  # noqa: ANN401 - nonsense too
    return replace(instance, graph=replace(instance.graph, **changes))


def _one_changed(each: Sequence[Any], name: str, wrong: st.SearchStrategy[Any], data: st.DataObject) -> tuple[Any, ...]:
    at = data.draw(st.integers(0, len(each) - 1))
    return (*each[:at], replace(each[at], **{name: data.draw(wrong)}), *each[at + 1 :])


def _resource(name: str, wrong: st.SearchStrategy[Any]) -> Plant:
    return lambda instance, data: _on_graph(
        instance, resources=_one_changed(instance.graph.resources, name, wrong, data)
    )


def _robot(name: str, wrong: st.SearchStrategy[Any]) -> Plant:
    return lambda instance, data: replace(instance, robots=_one_changed(instance.robots, name, wrong, data))


def _edge(instance: Instance, data: st.DataObject) -> Instance:
    graph = instance.graph
    some = data.draw(st.sampled_from([resource.id for resource in graph.resources]))
    wrong = [(some, some), (some, NOWHERE), (NOWHERE, some), *graph.edges[:1]]
    return _on_graph(instance, edges=(*graph.edges, data.draw(st.sampled_from(wrong))))


def _group(instance: Instance, data: st.DataObject) -> Instance:
    graph = instance.graph
    some = data.draw(st.sampled_from([resource.id for resource in graph.resources]))
    wrong = [Group("x", ()), Group("x", (some, NOWHERE)), Group("x", (some, some)), *graph.groups[:1]]
    zero = st.builds(Group, st.just("x"), st.just((some,)), TOO_SMALL)
    return _on_graph(instance, groups=(*graph.groups, data.draw(st.sampled_from(wrong) | zero)))


def _repeated_robot(instance: Instance, data: st.DataObject) -> Instance:
    again = data.draw(st.sampled_from(instance.robots))
    return replace(instance, robots=tuple(data.draw(st.permutations([*instance.robots, again]))))


def _repeated_resource(instance: Instance, data: st.DataObject) -> Instance:
    resources = instance.graph.resources
    return _on_graph(instance, resources=(*resources, data.draw(st.sampled_from(resources))))


def _policy(name: str, *known: str) -> Plant:
    def plant(instance: Instance, data: st.DataObject) -> Instance:
        wrong: st.SearchStrategy[Any] = st.none() | st.text().filter(lambda text: text not in known)
        return replace(instance, **{name: data.draw(wrong)})

    return plant


def _stops(instance: Instance, data: st.DataObject) -> Instance:
    goal = instance.robots[0].stops[-1]
    wrong: list[Any] = [
        (),
        (Stop(goal.resource, -1),),
        (Stop(goal.resource, True),),
        (Stop(NOWHERE, 1),),
        (Stop(NOWHERE), goal),
        (goal, replace(goal, service=2)),
    ]
    robot = replace(instance.robots[0], stops=data.draw(st.sampled_from(wrong)))
    return replace(instance, robots=(robot, *instance.robots[1:]))


PLANTS: Mapping[str, Plant] = {
    "instance/resource-id": _repeated_resource,
    "instance/capacity": _resource("capacity", TOO_SMALL),
    "instance/duration": _resource("duration", TOO_SMALL),
    "instance/position": _resource("x", st.sampled_from([True, 1.0, "1"])),
    "instance/edge": _edge,
    "instance/group": _group,
    "instance/robot-id": _repeated_robot,
    "instance/endpoint": _robot("stops", st.just((Stop(NOWHERE),))),
    "instance/stops": _stops,
    "instance/release": _robot("release", st.integers(max_value=-1) | st.sampled_from([False, 0.0, None])),
    "instance/pace": _robot("pace", TOO_SMALL),
    "instance/after-goal": _policy("after_goal", "vanish", "park"),
    "instance/following": _policy("following", "allowed", "forbidden"),
}


@pytest.mark.parametrize("rule", PLANTS)
@settings(max_examples=draws(60))
@given(data=st.data(), instance=WITH_ROBOTS)
def test_a_fault_planted_in_an_instance_is_found_and_no_other(
    rule: str, data: st.DataObject, instance: Instance
) -> None:
    assert {fault.rule for fault in instance_faults(PLANTS[rule](instance, data))} == {rule}


@settings(max_examples=draws(200))
@given(WITH_ROBOTS, st.data())
def test_a_document_cut_short_is_no_json(instance: Instance, data: st.DataObject) -> None:
    document = write_instance(instance).rstrip()
    with pytest.raises(Refusal, match="document/json"):
        read_instance(document[: data.draw(st.integers(0, len(document) - 1))])


@settings(max_examples=draws(200))
@given(WITH_ROBOTS, st.text() | st.text().map("carproof-instance/".__add__) | st.none() | st.integers())
def test_any_other_format_is_refused(instance: Instance, format: str | int | None) -> None:
    assume(format != "carproof-instance/1")
    with pytest.raises(Refusal, match="document/format"):
        read_instance(json.dumps({**json.loads(write_instance(instance)), "format": format}).encode())


def leaves(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:  # noqa: ANN401 - any JSON
    """The paths of all values that hold no others."""
    if isinstance(value, dict | list) and value:
        entries = value.items() if isinstance(value, dict) else enumerate(value)
        return [leaf for name, each in entries for leaf in leaves(each, (*path, name))]
    return [path]


@settings(max_examples=draws(200))
@given(WITH_ROBOTS, st.data())
def test_a_fraction_anywhere_in_a_document_has_not_the_shape(instance: Instance, data: st.DataObject) -> None:
    document = json.loads(write_instance(instance))
    *way, last = data.draw(st.sampled_from([path for path in leaves(document) if path != ("format",)]))
    holder = document
    for name in way:
        holder = holder[name]
    holder[last] = 1.5
    with pytest.raises(Refusal, match="document/shape"):
        read_instance(json.dumps(document).encode())


def stay_lengths(plan: Plan) -> list[int]:
    return [following.enter - visit.enter for visit, following in pairwise(plan.visits)]


@settings(max_examples=draws(200))
@given(planned_instances(), st.integers(-50, 50))
def test_costs_are_the_ticks_before_the_last_visits(planned: PlannedInstance, claimed: int) -> None:
    plans = planned.solution.plans
    for plan in plans:
        assert is_plan_cost(planned.instance, plan, claimed) == (claimed == sum(stay_lengths(plan)))
    assert is_total_cost(planned.instance, plans, claimed) == (
        claimed == sum(sum(stay_lengths(plan)) for plan in plans)
    )
    assert all(plan_cost(planned.instance, plan) >= 0 for plan in plans)


@settings(max_examples=draws(200))
@given(st.lists(st.tuples(*[st.integers(0, 2)] * 4), min_size=1))
@example([(0, 0, 1, 0), (1, 1, 0, 0)])
def test_what_is_expanded_first_is_best_in_each_respect_among_its_equals(
    nodes: list[tuple[int, int, int, int]],
) -> None:
    f, g, index, window = min(nodes, key=lambda node: expansion_key(*node))
    assert f == min(node[0] for node in nodes)
    assert g == max(node[1] for node in nodes if node[0] == f)
    assert index == min(node[2] for node in nodes if node[:2] == (f, g))
    assert window == min(node[3] for node in nodes if node[:3] == (f, g, index))


@settings(max_examples=draws(200))
@given(st.lists(st.tuples(*[st.integers(0, 3)] * 3), min_size=1), st.integers(0, 4))
@example([(0, 0, 0), (0, 1, 0)], 0)
def test_before_a_goal_is_free_for_ever_the_nearest_window_is_expanded_first(
    nodes: list[tuple[int, int, int]], opens: int
) -> None:
    h, g, index = min(nodes, key=lambda node: expansion_key(node[0] + node[1], node[1], node[2], 0, 0, opens))
    early = [node for node in nodes if node[0] + node[1] <= opens]
    if early:
        assert h == min(node[0] for node in early)
        assert index == min(node[2] for node in early if node[0] == h)
        assert g == min(node[1] for node in early if (node[0], node[2]) == (h, index))
    else:
        assert h + g == min(node[0] + node[1] for node in nodes)


@settings(max_examples=draws(200))
@given(st.lists(st.integers(0, 5)))
def test_the_best_of_all_candidates_is_the_first_of_the_cheapest(costs: list[int]) -> None:
    best: int | None = None
    for position, cost in enumerate(costs):
        if replaces_best(cost, None if best is None else costs[best]):
            best = position
    assert best == (costs.index(min(costs)) if costs else None)


@settings(max_examples=draws(200))
@given(st.lists(st.booleans()), st.booleans())
def test_there_is_always_a_first_candidate(rounds: list[bool], baseline: bool) -> None:
    assert baseline_is_tried(baseline, len(rounds)) or rounds
    assert baseline_is_tried(baseline=True, rounds=len(rounds))


@settings(max_examples=draws(200))
@given(st.lists(st.none() | st.integers(1, 9), min_size=1))
def test_a_trajectory_is_the_last_plan_that_was_found(rounds: list[int | None]) -> None:
    def plan(enter: int) -> Plan:
        return Plan("r1", (Visit("a", 0, enter), Visit("b", enter, None)))

    trajectory = plan(10)
    for enter in rounds:
        trajectory = next_trajectory(trajectory, None if enter is None else plan(enter))
    found = [enter for enter in rounds if enter is not None]
    assert trajectory == plan(found[-1] if found else 10)


@settings(max_examples=draws(200))
@given(st.integers(-3, LARGEST_SEED + 3) | st.sampled_from([True, 1.0, "1"]))
def test_options_are_whole_numbers_within_their_bounds(value: Any) -> None:  # noqa: ANN401 - nonsense too
    whole = type(value) is int
    assert (not [*options_are_right(Neighbourhood(m=value))]) == (whole and value >= 1)
    assert (not [*options_are_right(Neighbourhood(sample=value))]) == (whole and 1 <= value <= LARGEST_SAMPLE)
    assert (not [*options_are_right(Shuffled(seed=value))]) == (whole and 0 <= value <= LARGEST_SEED)
    assert (not [*options_are_right(FixedPaths(k=value))]) == (whole and value >= 1)


def test_a_solution_without_robots_has_no_cost() -> None:
    assert is_total_cost(Instance(ResourceGraph((), ()), ()), Solution((), ()).plans, 0)
