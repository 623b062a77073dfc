from dataclasses import replace

import pytest
from hypothesis import given, settings
from tests.profiles import draws
from tests.spec.making import plan_of, row
from tests.verify.optimum.models import has_model, model_of
from tests.verify.optimum.tiny import TINY

from carp_spec import Instance, Plan, Refusal, Resource, ResourceGraph, Robot, total_cost, violations_of
from carp_spec.model import Group
from carp_verify.optimum.encoding import Conflict, Encoding, Exchange, violated
from carp_verify.optimum.joint_search import least_total_cost
from carproof.testing.strategies import PlannedInstance, instances, planned_instances

FAR = 6


def plans_in(encoding: Encoding) -> list[Plan]:
    """The plans of a model of its formula."""
    model = model_of(encoding.formula)
    assert model is not None
    return encoding.plans(model)


def bounded(instance: Instance, horizons: list[int], bound: int, closed: bool) -> Encoding:
    encoding = Encoding(instance)
    encoding.grow_to(horizons)
    encoding.forbid_all()
    encoding.bound_delays(bound, range(len(instance.robots)))
    if closed:
        encoding.close()
    return encoding


@settings(max_examples=draws(300))
@given(instances(TINY, least_robots=1))
def test_with_horizons_far_enough_the_clauses_have_a_model_from_the_least_total_on(instance: Instance) -> None:
    if Encoding(instance).wayless:
        return
    least = least_total_cost(instance)
    delay = FAR if least is None else least - Encoding(instance).shortest
    horizons = [FAR] * len(instance.robots)
    assert not has_model(bounded(instance, horizons, min(delay, FAR), closed=True).formula)
    if delay < FAR:
        assert has_model(bounded(instance, horizons, delay + 1, closed=True).formula)


@settings(max_examples=draws(300))
@given(planned_instances(TINY))
def test_the_conflicts_among_plans_are_those_of_the_checker(planned: PlannedInstance) -> None:
    plans = [plan for robot in planned.instance.robots for plan in planned.solution.plans if plan.robot == robot.id]
    assert violated(planned.instance, plans) == []


@settings(max_examples=draws(300))
@given(instances(TINY, least_robots=2))
def test_models_with_no_conflict_forbidden_hold_plans_that_break_joint_rules_only(instance: Instance) -> None:
    encoding = Encoding(instance)
    if not encoding.wayless:
        encoding.grow_to([2] * len(instance.robots))
        encoding.close()
        plans = plans_in(encoding)
        assert len(plans) == len(instance.robots)
        broken = violations_of(instance, plans)
        assert {violation.rule for violation in broken} <= {"joint/capacity", "joint/exchange"}
        assert bool(violated(instance, plans)) == bool(broken)
        assert total_cost(instance, plans) >= encoding.shortest


@settings(max_examples=draws(300))
@given(instances(TINY, least_robots=1))
def test_the_nodes_of_a_horizon_are_counted_before_they_are_made(instance: Instance) -> None:
    for horizon in (0, 1, 4):
        encoding = Encoding(instance)
        counted = [robot.nodes_within(horizon) for robot in encoding.robots]
        encoding.grow_to([horizon] * len(instance.robots))
        assert [len(robot.node) for robot in encoding.robots] == counted


def test_horizons_that_need_too_many_clauses_are_refused_at_once() -> None:
    instance = Instance(row(1, 1), (Robot("a", 0, 1), Robot("b", 1, 0)))
    for most, horizons in ((30, (9, 5)), (29, (9, 5)), (10**6, (10**99, 0)), (10**6, (0, 10**99))):
        encoding = Encoding(instance, most=most)
        with pytest.raises(Refusal, match=f"the clauses of the formula must be at most {most}"):
            encoding.grow_to(horizons)
        assert bool(encoding.formula.clauses) == (most == 30)


def test_delays_are_never_below_zero() -> None:
    for bound in (0, -1, -(10**99)):
        assert bounded(Instance(row(1, 1), (Robot("a", 0, 1),)), [1], bound, closed=False).formula.clauses[-1] == ()


def test_a_robot_that_is_later_than_its_horizon_has_no_plan() -> None:
    encoding = Encoding(Instance(row(1, 1), (Robot("a", 0, 1), Robot("b", 1, 1))))
    encoding.grow_to([1, 0])
    assert encoding.plans([True] * (encoding.formula.variables + 1)) == []


def test_the_time_is_looked_at_before_each_robot() -> None:
    looks: list[int] = []
    Encoding(Instance(row(1, 1), (Robot("a", 0, 1), Robot("b", 1, 0))), lambda: looks.append(1))
    assert len(looks) == 2


def test_a_conflict_is_named_by_its_tick_and_its_resources() -> None:
    head_on = Instance(row(1, 1), (Robot("a", 0, 1), Robot("b", 1, 0)))
    encoding = Encoding(head_on)
    encoding.grow_to([0, 0])
    assert violated(head_on, plans_in(encoding)) == [Exchange(1, (0, 1), (1, 0))]


def test_a_robot_that_comes_as_another_leaves_is_a_conflict_where_following_is_forbidden() -> None:
    behind = Instance(row(1, 1, 1), (Robot("a", 1, 2), Robot("b", 0, 1)), following="forbidden")
    plans = [plan_of("a", (1, 0, 1), (2, 1, 2)), plan_of("b", (0, 0, 1), (1, 1, 2))]
    assert violated(behind, plans) == [Conflict(1, 1)]
    assert violated(replace(behind, following="allowed"), plans) == []


def test_a_long_stay_needs_no_more_variables_than_a_short_one() -> None:
    sizes = []
    for duration in (1, 1000):
        encoding = Encoding(Instance(row(duration, duration, duration), (Robot("a", 0, 2), Robot("b", 1, 2))))
        encoding.grow_to([0, 0])
        encoding.forbid_all()
        sizes.append((encoding.formula.variables, len(encoding.formula.clauses)))
    assert sizes[1] <= (sizes[0][0] + 2, sizes[0][1] + 6)


def test_many_robots_in_a_wide_place_are_counted() -> None:
    graph = ResourceGraph((Resource(0, 9), Resource(1, 3), Resource(2, 9)), ((0, 1), (1, 2)))
    instance = Instance(graph, tuple(Robot(i, 0, 2) for i in range(5)))
    for bound, possible in ((2, False), (3, True)):
        assert has_model(bounded(instance, [2] * 5, bound, closed=True).formula) == possible


def between_groups(size: int, robots: int) -> Encoding:
    """Robots that may all move from each resource of one group of capacity 1 to each of another, and back."""
    ids = range(2 * size)
    groups = (Group("left", tuple(ids[:size])), Group("right", tuple(ids[size:])))
    edges = tuple((one, other) for one in ids[:size] for other in ids[size:])
    graph = ResourceGraph(tuple(map(Resource, ids)), edges, groups=groups)
    ends = [(0, size), (size, 0)]
    encoding = Encoding(Instance(graph, tuple(Robot(each, *ends[each]) for each in range(robots))), most=900)
    encoding.grow_to([2] * robots)
    return encoding


def test_exchanges_are_no_more_than_clauses_before_one_is_forbidden(monkeypatch: pytest.MonkeyPatch) -> None:
    encoding = between_groups(6, 2)
    clauses = len(encoding.formula.clauses)
    with pytest.raises(Refusal, match=r"^\$\.robots: the clauses of the formula must be at most 900"):
        encoding.forbid_all()
    assert len(encoding.formula.clauses) == clauses
    between_groups(6, 1).forbid_all()  # one robot exchanges nothing
    monkeypatch.setattr("carp_verify.optimum.encoding.LARGEST_FORMULA", 59)
    with pytest.raises(Refusal, match="the pairs of moves that exchange close resources must be at most 59"):
        between_groups(6, 1).forbid_all()
