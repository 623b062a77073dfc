"""Short ways to write instances and plans down, and a solved instance to break in one place."""

from collections.abc import Iterable
from itertools import pairwise
from typing import TypeAlias

from carp_spec import (
    AfterGoal,
    Instance,
    Plan,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    Visit,
    total_cost,
)

Stay: TypeAlias = tuple[ResourceId, int, int | None]


def line(names: str, directed: bool = False, **durations: int) -> ResourceGraph:
    """A row of resources at (0, 0), (1, 0), and so on, each named by a letter; durations where they are not 1."""
    resources = tuple(Resource(name, duration=durations.get(name, 1), x=x, y=0) for x, name in enumerate(names))
    return ResourceGraph(resources, tuple(pairwise(names)), directed)


def row(*durations: int, capacity: int = 1) -> ResourceGraph:
    """A row of resources 0, 1, 2 and so on without positions."""
    resources = tuple(Resource(number, capacity, duration) for number, duration in enumerate(durations))
    return ResourceGraph(resources, tuple(pairwise(range(len(durations)))))


def grid(width: int, height: int) -> ResourceGraph:
    """A 4-connected grid of unit capacities and durations; ids are (x, y) as "x,y"."""
    cells = [(x, y) for y in range(height) for x in range(width)]
    steps = [((x, y), (x + dx, y + dy)) for x, y in cells for dx, dy in ((1, 0), (0, 1))]
    return ResourceGraph(
        tuple(Resource(f"{x},{y}", x=x, y=y) for x, y in cells),
        tuple((f"{a},{b}", f"{c},{d}") for (a, b), (c, d) in steps if c < width and d < height),
    )


def instance(graph: ResourceGraph, *ends: tuple[str, str], after_goal: AfterGoal = "vanish") -> Instance:
    """Robots r0, r1, ... with these starts and goals, all released at 0."""
    robots = tuple(Robot(f"r{index}", start, goal) for index, (start, goal) in enumerate(ends))
    return Instance(graph, robots, after_goal)


def instance_on(graph: ResourceGraph, *robots: Robot, after_goal: AfterGoal = "vanish") -> Instance:
    return Instance(graph, robots, after_goal)


def plan_of(robot: RobotId, *stays: Stay) -> Plan:
    return Plan(robot, tuple(Visit(*stay) for stay in stays))


def solution_of(plans: Iterable[Plan], unplanned: tuple[RobotId, ...] = ()) -> Solution:
    plans = tuple(plans)
    return Solution(plans, tuple(plan.robot for plan in plans), unplanned)


def worth(instance: Instance, solution: Solution) -> tuple[int, int]:
    """How many robots have no plan, and the total: what a polish makes less."""
    return (len(instance.robots) - len(solution.plans), total_cost(instance, solution.plans))


# A line a - b - c - d with e beside b and f beside c. Two robots fit into b, and c takes two ticks.
CROSSING = ResourceGraph(
    (
        Resource("a", x=0, y=0),
        Resource("b", capacity=2, x=1, y=0),
        Resource("c", duration=2, x=2, y=0),
        Resource("d", x=3, y=0),
        Resource("e", x=1, y=1),
        Resource("f", x=2, y=1),
    ),
    (("a", "b"), ("b", "c"), ("c", "d"), ("b", "e"), ("c", "f")),
)
ROBOTS = (Robot("r1", "a", "d"), Robot("r2", "e", "a", release=1), Robot("r3", "f", "f"))
VANISHING = Instance(CROSSING, ROBOTS, "vanish")
PARKING = Instance(CROSSING, ROBOTS, "park")
SOLVED = (
    plan_of("r1", ("a", 0, 2), ("b", 2, 3), ("c", 3, 5), ("d", 5, 6)),
    plan_of("r2", ("e", 1, 2), ("b", 2, 4), ("a", 4, 5)),
    plan_of("r3", ("f", 0, 1)),
)
PARKED = (
    plan_of("r1", ("a", 0, 2), ("b", 2, 3), ("c", 3, 5), ("d", 5, None)),
    plan_of("r2", ("e", 1, 2), ("b", 2, 4), ("a", 4, None)),
    plan_of("r3", ("f", 0, None)),
)

# Robots that follow each other along a row, and three that change places in a ring.
ROW = instance_on(line("abcde"), Robot("r1", "a", "c"), Robot("r2", "e", "d", release=1))
WALK = plan_of("r1", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3))
STEP = plan_of("r2", ("e", 1, 2), ("d", 2, 3))
CROSSED = (
    instance_on(line("abcd"), Robot("r1", "b", "d"), Robot("r2", "a", "c")),
    solution_of(
        [
            plan_of("r1", ("b", 0, 1), ("c", 1, 2), ("d", 2, 3)),
            plan_of("r2", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3)),
        ]
    ),
)
RING = ResourceGraph(line("abc").resources, (("a", "b"), ("b", "c"), ("c", "a")))
TURNING = (
    (Robot("r1", "a", "b"), Robot("r2", "b", "c"), Robot("r3", "c", "a")),
    tuple(plan_of(robot, (at, 0, 1), (to, 1, 2)) for robot, at, to in (("r1", *"ab"), ("r2", *"bc"), ("r3", *"ca"))),
)


def is_before(instance: Instance, one: Visit, other: Visit) -> bool:
    """Whether the first robot is planned to have left the resource when the second enters it."""
    return one.leave is not None and one.leave + instance.gap <= other.enter
