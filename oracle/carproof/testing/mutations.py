"""Mutations of a sound solution: each changes it in one place and names the rules that it must break by that.

A mutation is a function of an instance and a sound solution that yields mutants in a fixed order. A mutant may break
further rules: a robot that starts late may also run into another.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

from msgspec import structs

from carp_spec import Instance, Plan, ResourceId, Solution, Visit
from carp_spec.windows import constraints_on, occupancy

NO_RESOURCE = "no resource of the graph"
NO_ROBOT = "no robot of the instance"


@dataclass(frozen=True, slots=True)
class BrokenSolution:
    """A solution that breaks at least these rules."""

    instance: Instance
    solution: Solution
    rules: tuple[str, ...]


Mutation: TypeAlias = Callable[[Instance, Solution], Iterator[BrokenSolution]]


def stranger_is_named(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A robot is listed as unplanned that the instance does not have."""
    unplanned = (*solution.unplanned, NO_ROBOT)
    yield BrokenSolution(instance, replace(solution, unplanned=unplanned), ("solution/covers",))


def plan_is_lost(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A plan is missing, and the order still names its robot."""
    for lost in solution.plans:
        plans = tuple(plan for plan in solution.plans if plan is not lost)
        yield BrokenSolution(instance, replace(solution, plans=plans), ("solution/covers", "solution/order"))


def order_repeats_a_robot(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """The planning order names a robot twice."""
    for robot in solution.order:
        yield BrokenSolution(instance, replace(solution, order=(*solution.order, robot)), ("solution/order",))


def robot_starts_late(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A whole plan is one tick late."""
    for plan in solution.plans:
        yield _with_visits(instance, solution, plan, later(plan.visits, 1), "plan/start")


def robot_stops_short(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A plan lacks its last visit."""
    for plan in solution.plans:
        yield _with_visits(instance, solution, plan, plan.visits[:-1], "plan/goal")


def goal_is_left_wrongly(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A robot that must vanish stays a tick longer; a robot that must park leaves."""
    for plan in solution.plans:
        last, stop = plan.visits[-1], instance.robot[plan.robot].stops[-1]
        leave = last.enter + instance.stay(plan.robot, stop) if last.leave is None else last.leave + 1
        yield _with_visits(
            instance, solution, plan, (*plan.visits[:-1], structs.replace(last, leave=leave)), "plan/goal"
        )


def stop_is_left_out(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A robot gets a longer service at a stop before its last than it can have given."""
    for plan in solution.plans:
        robot = instance.robot[plan.robot]
        too_long = max((visit.leave - visit.enter for visit in plan.visits if visit.leave is not None), default=0) + 1
        for place, stop in enumerate(robot.stops[:-1]):
            longer = replace(stop, service=too_long)
            stops = (*robot.stops[:place], longer, *robot.stops[place + 1 :])
            robots = tuple(replace(each, stops=stops) if each is robot else each for each in instance.robots)
            yield BrokenSolution(replace(instance, robots=robots), solution, ("plan/stops",))


def resource_is_unknown(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A visit is to a resource that the graph does not have."""
    for plan, position in _visits(solution):
        elsewhere = structs.replace(plan.visits[position], resource=NO_RESOURCE)
        yield _with_visits(instance, solution, plan, _exchanged(plan, position, elsewhere), "plan/resource")


def robot_moves_nowhere(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A visit is to the same resource as the one before, and no resource has a move to itself."""
    for plan, position in _visits(solution, first=1):
        same = structs.replace(plan.visits[position], resource=plan.visits[position - 1].resource)
        yield _with_visits(instance, solution, plan, _exchanged(plan, position, same), "plan/move")


def robot_is_nowhere_for_a_tick(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """From one visit on, a plan is one tick late, and the visit before is not prolonged."""
    for plan, position in _visits(solution, first=1):
        visits = (*plan.visits[:position], *later(plan.visits[position:], 1))
        yield _with_visits(instance, solution, plan, visits, "plan/contiguous")


def robot_hurries(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A stay is a tick shorter than the robot's duration, and the rest of the plan that much earlier."""
    for plan, position in _visits(solution):
        visit = plan.visits[position]
        if visit.leave is not None:
            leave = visit.enter + instance.duration(plan.robot, visit.resource) - 1
            rest = later(plan.visits[position + 1 :], leave - visit.leave)
            visits = (*plan.visits[:position], structs.replace(visit, leave=leave), *rest)
            yield _with_visits(instance, solution, plan, visits, "plan/duration")


def robot_overstays(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A robot stays until another is in the same resource or group too, and they exceed its capacity."""
    for plan, position in _visits(solution):
        visit = plan.visits[position]
        others = [other for other in solution.plans if other is not plan]
        for place, (stays, capacity) in enumerate(constraints_on(instance.graph, others, visit.resource)):
            for enter, _ in stays:
                if visit.leave is not None and visit.leave <= enter and occupancy(stays, enter) == capacity:
                    rest = later(plan.visits[position + 1 :], enter + 1 - visit.leave)
                    visits = (*plan.visits[:position], structs.replace(visit, leave=enter + 1), *rest)
                    broken = "joint/group" if place else "joint/capacity"
                    yield _with_visits(instance, solution, plan, visits, broken)


def robot_goes_against_another(instance: Instance, solution: Solution) -> Iterator[BrokenSolution]:
    """A robot waits where another will go, or close, makes the opposite move at the same tick, and comes back."""
    graph = instance.graph
    areas = {resource: {*graph.areas_of(resource)} for resource in graph.index}
    moves = [
        (mover, following.enter, visit.resource, following.resource)
        for mover in solution.plans
        for visit, following in pairwise(mover.visits)
    ]
    for plan, position in _visits(solution):
        visit = plan.visits[position]
        for mover, tick, source, target in moves:
            ready = visit.enter + instance.duration(plan.robot, visit.resource) <= tick
            if mover is not plan and ready and areas[visit.resource] & areas[target]:
                for over in (each for each in graph.successors[visit.resource] if areas[each] & areas[source]):
                    detour = _detour(instance, plan, position, tick, over)
                    yield _with_visits(instance, solution, plan, detour, "joint/exchange")


MUTATIONS: tuple[Mutation, ...] = (
    stranger_is_named,
    plan_is_lost,
    order_repeats_a_robot,
    robot_starts_late,
    robot_stops_short,
    goal_is_left_wrongly,
    stop_is_left_out,
    resource_is_unknown,
    robot_moves_nowhere,
    robot_is_nowhere_for_a_tick,
    robot_hurries,
    robot_overstays,
    robot_goes_against_another,
)


def later(visits: tuple[Visit, ...], ticks: int) -> tuple[Visit, ...]:
    """The visits this many ticks later."""
    return tuple(
        Visit(visit.resource, visit.enter + ticks, None if visit.leave is None else visit.leave + ticks)
        for visit in visits
    )


def _visits(solution: Solution, first: int = 0) -> Iterator[tuple[Plan, int]]:
    """Each plan with the position of each of its visits from the first one asked for."""
    for plan in solution.plans:
        for position in range(first, len(plan.visits)):
            yield plan, position


def _exchanged(plan: Plan, position: int, visit: Visit) -> tuple[Visit, ...]:
    return (*plan.visits[:position], visit, *plan.visits[position + 1 :])


def _detour(instance: Instance, plan: Plan, position: int, tick: int, over: ResourceId) -> tuple[Visit, ...]:
    """The plan's visits with a detour: from the visit at the position over the other resource at the tick and back."""
    visit = plan.visits[position]
    back = tick + instance.duration(plan.robot, over)
    away = (structs.replace(visit, leave=tick), Visit(over, tick, back))
    rest = later(plan.visits[position:], back - visit.enter)
    return (*plan.visits[:position], *away, *rest)


def _with_visits(
    instance: Instance, solution: Solution, plan: Plan, visits: tuple[Visit, ...], rule: str
) -> BrokenSolution:
    """The solution in which the plan has other visits, and so breaks the rule."""
    plans = tuple(Plan(plan.robot, visits) if each is plan else each for each in solution.plans)
    return BrokenSolution(instance, replace(solution, plans=plans), (rule,))
