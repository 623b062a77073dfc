"""Traces and the dependency graph: what the rules of an execution promise, and how traces are read."""

import random
from dataclasses import replace

import networkx as nx
from tests.spec.making import (
    CROSSED,
    RING,
    ROW,
    SOLVED,
    STEP,
    TURNING,
    VANISHING,
    WALK,
    is_before,
    plan_of,
    solution_of,
)

from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit, violations_of
from carp_spec.execution.dependencies import Dependency, dependencies, shortest_cycle
from carp_spec.execution.execution_rules import is_acyclic, trace_violations
from carp_spec.execution.traces import Trace


def test_rules_of_execution_are_asked_only_of_what_is_a_trace() -> None:
    trace = Trace(2, (plan_of("r1", ("b", 0, None)), plan_of("r2", ("e", 1, None))))
    assert {violation.rule for violation in trace_violations(ROW, solution_of([WALK, STEP]), trace)} == {"trace/prefix"}


def test_no_more_violations_than_asked_for_are_listed_of_each_rule() -> None:
    empty = Trace(0, ())
    solution = solution_of(SOLVED)
    assert len(trace_violations(VANISHING, solution, empty)) == len(SOLVED)
    assert len(trace_violations(VANISHING, solution, empty, most=1)) == 1


def test_edges_that_follow_from_others_are_left_out_and_none_else() -> None:
    """Every pair of visits with one before the other is joined by a path that takes long enough."""
    for seed in range(40):
        instance, solution = wide_case(seed)
        edges = list(dependencies(instance, solution.plans))
        visits = {(plan.robot, place): visit for plan in solution.plans for place, visit in enumerate(plan.visits)}
        graph = nx.DiGraph([(edge.before, edge.after) for edge in edges])
        graph.add_nodes_from(visits)
        for (robot, place), visit in visits.items():
            for other, later in visits.items():
                if visit.resource == later.resource and is_before(instance, visit, later):
                    following = (robot, place + 1)
                    assert nx.has_path(graph, following if following in visits else (robot, place), other)
        orders = [edge for edge in edges if edge.kind == "order"]
        assert len({(edge.before, edge.after) for edge in orders}) == len(orders)


def wide_case(seed: int) -> tuple[Instance, Solution]:
    """Robots that cross one place with room for two, one after the other."""
    draw = random.Random(seed)  # noqa: S311 - no secret
    graph = ResourceGraph((Resource("m", capacity=2), Resource("a", 99), Resource("b", 99)), (("a", "m"), ("m", "b")))
    robots = tuple(Robot(f"r{number}", *draw.choice((("a", "b"), ("b", "a")))) for number in range(6))
    instance = Instance(graph, robots, following=draw.choice(("allowed", "forbidden")))
    plans: list[Plan] = []
    for robot in robots:
        for enter in range(1, 40):
            leave = enter + draw.randint(1, 3)
            stays = (Visit(robot.start, 0, enter), Visit("m", enter, leave), Visit(robot.goal, leave, leave + 1))
            plan = Plan(robot.id, stays)
            if not violations_of(instance, [*plans, plan]):
                plans.append(plan)
                break
    return instance, solution_of(plans)


def test_a_cycle_is_a_rotation_and_is_named_with_robots_resources_and_tick() -> None:
    instance, solution = Instance(RING, TURNING[0]), solution_of(TURNING[1])
    cycle = shortest_cycle(tuple(dependencies(instance, solution.plans)))
    assert len(cycle) == 3
    (violation,) = is_acyclic(instance, solution)
    assert (sorted(map(str, violation.robots)), violation.start) == (["r1", "r2", "r3"], 1)


def test_the_shortest_of_several_cycles_is_named() -> None:
    ring = "defg"
    edges = (*RING.edges, *((ring[at - 1], ring[at]) for at in range(4)))
    graph = ResourceGraph((*(Resource(id) for id in ring), *RING.resources), edges)
    robots = (*(Robot(f"s{at}", ring[at - 1], ring[at]) for at in range(4)), *TURNING[0])
    plans = [Plan(robot.id, (Visit(robot.start, 0, 1), Visit(robot.goal, 1, 2))) for robot in robots]
    instance = Instance(graph, robots)
    assert not violations_of(instance, plans)
    assert len(shortest_cycle(tuple(dependencies(instance, plans)))) == 3


def test_without_following_there_is_no_edge_that_takes_no_time() -> None:
    instance, solution = CROSSED
    assert any(edge.ticks == 0 for edge in dependencies(instance, solution.plans))
    assert all(edge.ticks > 0 for edge in dependencies(replace(instance, following="forbidden"), solution.plans))


def test_a_shortest_cycle_is_found_where_ways_join() -> None:
    ways = ("ab", "ac", "bd", "cd", "da")
    edges = tuple(Dependency("order", (way[0], 0), (way[1], 0), 0, "place") for way in ways)
    assert shortest_cycle(edges) == (edges[0], edges[2], edges[4])
