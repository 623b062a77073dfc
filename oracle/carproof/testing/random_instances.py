"""Random questions for both engines, small and fast to draw; equal numbers, equal question."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, TypeAlias, TypeVar

from carp_spec import (
    AfterGoal,
    Carp,
    Greedy,
    Group,
    Instance,
    LongestFirst,
    Neighbourhood,
    Plan,
    Planner,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Shuffled,
    Solution,
    Stop,
)
from carp_spec.model import Following
from carp_spec.permutations import shuffle, splitmix64
from carp_spec.planners import LARGEST_SEED
from carp_spec.shapes import numbers_of
from carproof.testing.timing import path_over, timed_plan

T = TypeVar("T")

MOST_MEMBERS = 4
POLICIES: tuple[AfterGoal, ...] = ("vanish", "park")
SIMPLE_PLANNERS: tuple[Planner, ...] = (Carp(), LongestFirst(), Greedy())


@dataclass(frozen=True, slots=True)
class FleetUnderWay:
    """A solution that is being followed at the tick `now`, and a robot to add that has no plan yet."""

    instance: Instance
    solution: Solution
    robot: RobotId
    now: int


@dataclass(frozen=True, slots=True)
class Mix:
    """The values that instances are made of; one that stands twice is drawn twice as often.

    Graphs are trees with at most `more` further edges. A directed one has each edge in one direction or, with
    `both_ways`, three in four edges in both. With `goals_apart`, the goals of most instances are as distinct as the
    starts. A robot has up to `stops` stops with these services.
    """

    sizes: Sequence[int] = (1, 2, 3, 4, 4, 5, 5, 6)
    robots: Sequence[int] = (1, 2, 3, 4, 5)
    capacities: Sequence[int] = (2, 1, 1, 1)
    durations: Sequence[int] = (1, 2, 3)
    releases: Sequence[int] = (0, 1, 2, 3, 4)
    paces: Sequence[int] = (1, 2)
    more: int = 6
    both_ways: bool = False
    groups: Sequence[int] = (0,)
    followings: Sequence[Following] = ("allowed",)
    goals_apart: bool = False
    stops: int = 1
    services: Sequence[int] = (0,)


SMALL = Mix()
WITH_STOPS = Mix(robots=(1, 2, 3, 4), stops=4, services=(0, 0, 1, 2, 3, 5, 8))


Question: TypeAlias = tuple[Instance, Planner] | tuple[FleetUnderWay, Neighbourhood]


@dataclass(frozen=True, slots=True)
class Draw:
    """Numbers of a stream, as choices."""

    stream: Iterator[int]

    def between(self, least: int, most: int) -> int:
        """A whole number from the least to the most, both included."""
        return least + next(self.stream) % (most - least + 1)

    def one_of(self, choices: Sequence[T]) -> T:
        """One of the choices."""
        return choices[next(self.stream) % len(choices)]

    def happens(self, one_in: int) -> bool:
        """True once in this many times."""
        return next(self.stream) % one_in == 0


GROUPED = Mix(groups=(1, 2, 3), followings=("allowed", "allowed", "forbidden"))


def question(seed: int, number: int, mix: Mix = SMALL) -> Question:
    """The question of that number: an instance and a planner, or a fleet under way and a robot to add.

    Durations, capacities, releases, paces, both kinds of ids and graphs, both policies and all options are mixed.
    Starts and goals may be shared, the same, or out of reach of each other.
    """
    draw = Draw(splitmix64(next(splitmix64(seed)) + number))
    instance = draw_instance(draw, mix)
    if draw.happens(4):
        return draw_fleet(draw, instance), draw_neighbourhood(draw)
    return instance, draw_planner(draw)


def draw_instance(draw: Draw, mix: Mix = SMALL) -> Instance:
    """An instance of a few resources and robots."""
    size = draw.one_of(mix.sizes)
    ids = draw_ids(draw, size)
    simple = draw.happens(3)
    resources = tuple(
        Resource(
            id,
            **draw_numbers(draw, mix, Resource, lambda: simple),
            **({} if draw.happens(8) else {"x": draw.between(-2, 3), "y": draw.between(-2, 3)}),
        )
        for id in ids
    )
    graph = draw_graph(draw, resources, mix)
    count = draw.one_of(mix.robots)
    starts = [draw.one_of(ids) for _ in range(count)] if draw.happens(3) else [*shuffle(ids, draw.stream), *ids]
    goals = [*shuffle(ids, draw.stream), *ids] if mix.goals_apart and not draw.happens(4) else None
    robots = tuple(
        Robot(
            id,
            start,
            goals[place % len(goals)] if goals else draw.one_of(ids),
            **draw_numbers(draw, mix, Robot, lambda: simple or draw.happens(2)),
        )
        for place, (id, start) in enumerate(zip(draw_ids(draw, count), starts, strict=False))
    )
    if mix.stops > 1:
        robots = tuple(replace(robot, stops=draw_stops(draw, ids, robot, mix)) for robot in robots)
    after_goal = draw.one_of(POLICIES)
    following = draw.one_of(mix.followings) if len(mix.followings) > 1 else mix.followings[0]
    return Instance(graph, robots, after_goal, following)


def draw_numbers(
    draw: Draw, mix: Mix, kind: type[Resource | Robot], is_least: Callable[[], bool] = lambda: False
) -> dict[str, Any]:
    """The numbers of a resource or a robot by their names; the mix has the values of each under its feature."""
    numbers = numbers_of(kind).items()
    return {name: each.least if is_least() else draw.one_of(getattr(mix, each.feature)) for name, each in numbers}


def draw_stops(draw: Draw, ids: Sequence[ResourceId], robot: Robot, mix: Mix) -> tuple[Stop, ...]:
    """Stops of which the last is at the robot's goal."""
    places = [robot.goal]
    for _ in range(draw.between(0, mix.stops - 1 if len(ids) > 1 else 0)):
        places.append(draw.one_of([id for id in ids if id != places[-1]]))
    return tuple(Stop(place, draw.one_of(mix.services)) for place in reversed(places))


def draw_ids(draw: Draw, count: int) -> Sequence[str | int]:
    """Distinct ids, among them 1 beside "1"."""
    pool: list[str | int] = [*range(count), *map(str, range(count))]
    return shuffle(pool, draw.stream)[:count]


def draw_graph(draw: Draw, resources: tuple[Resource, ...], mix: Mix) -> ResourceGraph:
    """A tree, which seldom lacks an edge, and some more edges."""
    ids = [resource.id for resource in resources]
    edges = [(draw.one_of(ids[:place]), ids[place]) for place in range(1, len(ids)) if not draw.happens(12)]
    pairs = list(combinations(ids, 2))
    more = [draw.one_of(pairs) for _ in range(draw.between(0, min(mix.more, len(ids))))] if pairs else []
    present = {frozenset(edge): edge for edge in (*more, *edges)}
    moves = [(target, source) if draw.happens(2) else (source, target) for source, target in present.values()]
    directed = draw.happens(4)
    if directed and mix.both_ways:
        moves += [(target, source) for source, target in moves if not draw.happens(4)]
    groups = draw_groups(draw, ids, draw.one_of(mix.groups)) if any(mix.groups) else ()
    return ResourceGraph(resources, tuple(moves), directed, groups)


def draw_groups(draw: Draw, ids: Sequence[ResourceId], count: int) -> tuple[Group, ...]:
    """Groups, most of which have room for one robot; they may overlap, and one may have all resources."""
    return tuple(
        Group(
            id,
            tuple(shuffle(ids, draw.stream)[: draw.between(1, min(len(ids), 4))]),
            draw.one_of((1, 1, 1, 2)),
        )
        for id in draw_ids(draw, count)
    )


def draw_planner(draw: Draw) -> Planner:
    """A planner that both engines have."""
    if draw.happens(2):
        return draw_neighbourhood(draw)
    if draw.happens(4):
        return Shuffled(draw.between(1, 3), draw.between(0, LARGEST_SEED))
    return draw.one_of(SIMPLE_PLANNERS)


def draw_neighbourhood(draw: Draw) -> Neighbourhood:
    """Options of the neighbourhood planner; large neighbourhoods are seldom, as they take the reference long."""
    m = draw.one_of((1, 2, 2, 3, 3, 3, 3, MOST_MEMBERS))
    return Neighbourhood(
        m=m,
        sample=draw.between(1, 6) if m == MOST_MEMBERS or draw.happens(2) else None,
        seed=draw.between(0, LARGEST_SEED),
        baseline=draw.happens(2),
        fallback=draw.between(1, 3) if draw.happens(3) else None,
    )


def draw_fleet(draw: Draw, instance: Instance) -> FleetUnderWay:
    """A fleet under way; its plans make detours and wait, as those of any planner might."""
    new, *others = shuffle(instance.robots, draw.stream)
    plans = draw_plans(draw, instance, others)
    return FleetUnderWay(instance, Solution.of(instance, plans), new.id, draw.between(0, last_tick(plans)))


def last_tick(plans: Sequence[Plan]) -> int:
    """The last tick at which a robot enters or leaves anything, 0 without plans."""
    return max((visit.leave or visit.enter for plan in plans for visit in plan.visits), default=0)


def draw_plans(draw: Draw, instance: Instance, robots: Sequence[Robot]) -> list[Plan]:
    """Plans of the robots, one after the other, that break no rule together; who finds none has none."""
    plans: list[Plan] = []
    for robot in robots:
        plan = draw_plan(draw, instance, plans, robot)
        if plan is not None:
            plans.append(plan)
    return plans


def draw_plan(draw: Draw, instance: Instance, committed: Sequence[Plan], robot: Robot) -> Plan | None:
    """A plan over some resource that stays longer than needed in each; `None` if there is no way, or none is free."""
    over = draw.one_of(instance.graph.resources).id
    path = path_over(instance.graph, robot, over)
    waits = [draw.between(0, 2) if draw.happens(2) else 0 for _ in path[1:]] + [0]
    return timed_plan(instance, committed, robot, path, waits)
