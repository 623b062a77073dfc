"""Questions that reach into the reuse logic: crowded fleets to which robots are added one after the other.

Equal numbers, equal question. The fleet stays up while time passes, so that plans made at one tick are reused at
another; rooms for several, paces, durations, one-way moves, detours, ended plans, large neighbourhoods, sampled orders
and every choice of what is reused are mixed. A question takes the reference a few milliseconds.
"""

from dataclasses import dataclass, replace

import carp_reference
from carp_optimized import Queries, Reuse
from carp_spec import (
    AfterGoal,
    Instance,
    Neighbourhood,
    Plan,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    Visit,
)
from carp_spec.permutations import shuffle, splitmix64
from carproof.questions import Draw, draw_edges, draw_plan

POLICIES: tuple[AfterGoal, ...] = ("vanish", "vanish", "park")


@dataclass(frozen=True, slots=True)
class Arrivals:
    """Committed plans, and the robots that are added to them, each at a tick, with the kinds of reuse."""

    instance: Instance
    before: tuple[Plan, ...]
    robots: tuple[tuple[RobotId, int], ...]
    options: Neighbourhood
    reuse: Reuse

    def by_reference(self) -> Solution:
        """The plans in the end."""
        solution = Solution(self.before, tuple(plan.robot for plan in self.before), ())
        for robot, now in self.robots:
            solution = carp_reference.add(self.instance, solution, robot, now, self.options)
        return solution

    def by_fleet(self) -> tuple[Solution, Queries]:
        """The same from one compiled fleet, and the queries asked and avoided."""
        from carp_optimized.fleet import PlannedFleet  # a run of mutants loads it after the questions

        fleet = PlannedFleet(self.instance, self.reuse)
        fleet.commit(self.before)
        for robot, now in self.robots:
            fleet.add(fleet.index(robot), now, self.options)
        order = tuple(plan.robot for plan in fleet.plans)
        named = {*(plan.robot for plan in self.before), *(robot for robot, _ in self.robots)}
        unplanned = (robot.id for robot in self.instance.robots if robot.id in named and robot.id not in order)
        return Solution(fleet.plans, order, tuple(unplanned)), fleet.queries


def scaled(question: Arrivals, space: int, time: int) -> Arrivals:
    """The same question with all coordinates and all ticks multiplied."""
    graph = question.instance.graph
    resources = tuple(
        replace(each, duration=time * each.duration, x=space * (each.x or 0), y=space * (each.y or 0))
        for each in graph.resources
    )
    robots = tuple(replace(each, release=time * each.release) for each in question.instance.robots)
    before = tuple(
        Plan(plan.robot, tuple(Visit(at, time * enter, leave and time * leave) for at, enter, leave in visits_of(plan)))
        for plan in question.before
    )
    return replace(
        question,
        instance=replace(question.instance, graph=replace(graph, resources=resources), robots=robots),
        before=before,
        robots=tuple((robot, time * now) for robot, now in question.robots),
    )


def visits_of(plan: Plan) -> list[tuple[ResourceId, int, int | None]]:
    return [(visit.resource, visit.enter, visit.leave) for visit in plan.visits]


def arrivals(number: int) -> Arrivals:
    """The question of that number."""
    draw = Draw(splitmix64(next(splitmix64(11)) + number))
    instance = draw_instance(draw)
    robots = shuffle(instance.robots, draw.stream)
    there = draw.between(0, len(robots) - 1) if draw.happens(2) else 0
    before: list[Plan] = []
    for robot in robots[:there]:
        plan = draw_plan(draw, instance, before, robot)
        if plan is not None:
            before.append(plan)
    now = 0
    added: list[tuple[RobotId, int]] = []
    moves = draw.happens(2)
    for robot in robots[there:]:
        now += draw.one_of((0, 0, 1, 2)) if moves else 0
        added.append((robot.id, now))
    return Arrivals(instance, tuple(before), tuple(added), draw_options(draw), draw_reuse(draw))


def convoy(number: int) -> Arrivals:
    """Many robots pass few resources one behind the other, so that there are more windows than are compared at once."""
    draw = Draw(splitmix64(next(splitmix64(12)) + number))
    size = draw.between(6, 9)
    cells = tuple(Resource(k, duration=draw.between(1, 2), x=k, y=draw.between(0, 1)) for k in range(size))
    tree = tuple((draw.between(max(0, k - 2), k - 1), k) for k in range(1, size))
    robots = tuple(
        Robot(k, draw.between(0, size - 1), draw.between(0, size - 1), draw.between(0, 90), draw.between(1, 2))
        for k in range(30)
    )
    options = Neighbourhood(m=draw.between(2, 3), baseline=draw.happens(2))
    return Arrivals(
        Instance(ResourceGraph(cells, tree), robots), (), tuple((each.id, 0) for each in robots), options, Reuse()
    )


def draw_instance(draw: Draw) -> Instance:
    """As many robots as resources, or half as many."""
    size = draw.between(4, 9) if draw.happens(3) else draw.between(9, 16)
    simple, narrow = draw.happens(3), draw.happens(2)
    resources = tuple(
        Resource(
            k,
            1 if narrow else draw.one_of((1, 1, 2, 3)),
            1 if simple else draw.between(1, 4),
            *((None, None) if draw.happens(8) else (draw.between(-2, 5), draw.between(-2, 5))),
        )
        for k in range(size)
    )
    tree = tuple((draw.between(0, k - 1), k) for k in range(1, size))
    edges = {frozenset(edge): edge for edge in (*draw_edges(draw, range(size)), *tree)}
    graph = ResourceGraph(resources, tree if draw.happens(3) else tuple(edges.values()))
    if draw.happens(8):
        graph = ResourceGraph(resources, draw_edges(draw, range(size)), directed=True)
    robots = tuple(
        Robot(
            k,
            draw.between(0, size - 1),
            draw.between(0, size - 1),
            0 if simple else draw.between(0, 8),
            1 if simple or draw.happens(2) else draw.between(1, 3),
        )
        for k in range(draw.between(4, 9))
    )
    return Instance(graph, robots, draw.one_of(POLICIES))


def draw_options(draw: Draw) -> Neighbourhood:
    """Neighbourhoods of up to 6; the larger ones are sampled."""
    m = draw.one_of((2, 3, 3, 4, 5, 6))
    sample = draw.between(1, 30) if m > 3 or draw.happens(4) else None
    seed, baseline = draw.between(0, 999), draw.happens(2)
    fallback = draw.between(1, 3) if draw.happens(6) else None
    return Neighbourhood(m=m, sample=sample, seed=seed, baseline=baseline, fallback=fallback)


def draw_reuse(draw: Draw) -> Reuse:
    """All kinds of reuse every other time, else any choice of them."""
    if draw.happens(2):
        return Reuse()
    return Reuse(*(draw.happens(2) for _ in range(5)))
