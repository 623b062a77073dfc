"""Questions that reach into the reuse logic: crowded fleets to which robots are added one after the other.

Equal numbers, equal question. The fleet stays up while time passes, so that plans made at one tick are reused at
another; rooms for several, paces, durations, one-way moves, detours, ended plans, large neighbourhoods, sampled orders
and every choice of what is reused are mixed. A question takes the reference a few milliseconds.
"""

from dataclasses import dataclass, replace

import carp_reference
from carp_optimized import Queries, Reuse
from carp_spec import Instance, Neighbourhood, Plan, ResourceId, RobotId, Solution, Visit
from carp_spec.permutations import shuffle, splitmix64
from carproof.testing.random_instances import Draw, Mix, draw_instance, draw_plan

CROWDED = Mix(
    sizes=range(4, 17),
    robots=range(4, 10),
    capacities=(1, 1, 2, 3),
    durations=range(1, 5),
    releases=range(9),
    paces=range(1, 4),
    both_ways=True,
    followings=("allowed", "allowed", "forbidden"),
)
"""As many robots as resources, or half as many."""
ROOMS = Mix(
    sizes=range(3, 7),
    robots=(8,),
    capacities=(1, 2, 2, 3),
    durations=(1, 2),
    releases=range(7),
    more=0,
    both_ways=True,
    followings=CROWDED.followings,
)
"""More robots than resources, some with room for several, so that those behind one stand in its way."""
CONVOY = Mix(sizes=range(6, 10), robots=(30,), capacities=(1,), durations=(1, 2), more=0, both_ways=True)
"""Many robots pass few resources one behind the other: there are more windows than are compared at once."""


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
        from carp_optimized.adding import add  # a run of mutants loads it after the questions
        from carp_optimized.fleet import PlannedFleet

        fleet = PlannedFleet(self.instance, self.reuse)
        fleet.commit(self.before)
        for robot, now in self.robots:
            add(fleet, fleet.index(robot), now, self.options)
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


def arrivals(number: int, mix: Mix = CROWDED) -> Arrivals:
    """The question of that number."""
    draw = Draw(splitmix64(next(splitmix64(11)) + number))
    instance = draw_instance(draw, mix)
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
    """The same for a convoy, whose robots come one behind the other and are all added at once."""
    draw = Draw(splitmix64(next(splitmix64(12)) + number))
    drawn = draw_instance(draw, CONVOY)
    robots = tuple(replace(each, release=draw.between(0, 90)) for each in drawn.robots)
    options = Neighbourhood(m=draw.between(2, 3), baseline=draw.happens(2))
    added = tuple((each.id, 0) for each in robots)
    return Arrivals(replace(drawn, robots=robots, after_goal="vanish"), (), added, options, Reuse())


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
