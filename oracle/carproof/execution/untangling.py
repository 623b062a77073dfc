"""Solutions that an executor can follow in order: rotations are removed, each by one robot that is replanned.

In a rotation, robots enter each other's places at one tick. A robot of the rotation is kept from its place at that tick
and gets the earliest plan beside the others. This is done with the robot whose cost grows least.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import count, takewhile

from carp_spec import Group, Instance, Plan, Resource, Robot, RobotId, Solution, Visit, plan_cost
from carp_spec.execution.dependencies import cycles, dependencies, shortest
from carp_spec.windows import occupancy, stays_within
from carproof.engines import Engine

MOST_ROUNDS = 10_000


@dataclass(frozen=True, slots=True)
class Untangled:
    """The solution without rotations, the number of rounds, and the ticks by which its cost grew.

    `rotation` has the robots of a rotation that stays in the solution, as none of them finds another plan. If it is
    `undecided`, the time was over, and more rotations may be left than the one that was found last.
    """

    solution: Solution
    rounds: int
    extra: int
    rotation: tuple[RobotId, ...]
    undecided: bool


def untangle(
    instance: Instance, solution: Solution, engine: Engine, goes_on: Callable[[], bool] = lambda: True
) -> Untangled:
    """Remove all rotations of a lawful solution, the shortest first, for as long as it is to go on."""
    plans = {plan.robot: plan for plan in solution.plans}
    kept_out: dict[RobotId, list[Visit]] = {}
    extra = 0
    for done in range(MOST_ROUNDS):
        edges = takewhile(lambda _: goes_on(), dependencies(instance, list(plans.values())))
        cycle = shortest(takewhile(lambda _: goes_on(), cycles(edges)))
        found: list[tuple[int, int, Plan, Visit]] = []
        for number, edge in enumerate(takewhile(lambda _: goes_on(), cycle)):
            robot, place = edge.after
            entered = plans[robot].visits[place]
            block = Visit(entered.resource, entered.enter, entered.enter + 1)
            others = [plan for plan in plans.values() if plan.robot != robot]
            plan = query_kept_out(instance, others, robot, [*kept_out.get(robot, ()), block], engine)
            if plan is not None:
                found.append((plan_cost(instance, plan) - plan_cost(instance, plans[robot]), number, plan, block))
        is_over = not goes_on()
        if is_over or not found:
            in_order = replace(solution, plans=tuple(plans[robot] for robot in solution.order))
            rotation = tuple(edge.after[0] for edge in cycle)
            return Untangled(in_order, done, extra, rotation, is_over)
        more, _, plan, block = min(found, key=lambda each: each[:2])
        extra += more
        plans[plan.robot] = plan
        kept_out.setdefault(plan.robot, []).append(block)
    raise AssertionError("each round keeps a robot from one more place and tick")


def query_kept_out(
    instance: Instance, others: Sequence[Plan], robot: RobotId, blocks: Sequence[Visit], engine: Engine
) -> Plan | None:
    """The earliest plan of the robot beside the others that makes none of these visits.

    Each visit is to a place that has in the instance of the query a group with one outside, for as many extra robots
    as have room. They are in no other group of the place, which has room for no more than all other robots.
    """
    graph, most = instance.graph, len(instance.robots)
    used = {*graph.index, *(group.id for group in graph.groups), *instance.robot}
    names = (number for number in count() if number not in used)
    outside, groups, guards = list[Resource](), list[Group](), list[Plan]()
    for block in blocks:
        capacity = min(graph.resource[block.resource].capacity, most)
        here = occupancy(stays_within(others, {block.resource}), block.enter)
        outside.append(Resource(next(names), capacity))
        groups.append(Group(next(names), (block.resource, outside[-1].id), capacity))
        visit = Visit(outside[-1].id, block.enter, block.leave)
        guards += [Plan(next(names), (visit,)) for _ in range(capacity - here)]
    standing = (Robot(guard.robot, guard.visits[0].resource, guard.visits[0].resource) for guard in guards)
    extended = replace(graph, resources=(*graph.resources, *outside), groups=(*graph.groups, *groups))
    beside = replace(instance, graph=extended, robots=(*instance.robots, *standing))
    return engine.find(beside, [*others, *guards], robot)
