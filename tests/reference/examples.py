"""Small instances that the tests of the planners share."""

from itertools import pairwise

from carp_spec import AfterGoal, Instance, Plan, Resource, ResourceGraph, Robot, Visit


def grid(width: int, height: int) -> ResourceGraph:
    """A 4-connected grid of unit capacities and durations; ids are (x, y) as "x,y"."""
    cells = [(x, y) for y in range(height) for x in range(width)]
    steps = [((x, y), (x + dx, y + dy)) for x, y in cells for dx, dy in ((1, 0), (0, 1))]
    return ResourceGraph(
        tuple(Resource(f"{x},{y}", x=x, y=y) for x, y in cells),
        tuple((f"{a},{b}", f"{c},{d}") for (a, b), (c, d) in steps if c < width and d < height),
    )


def line(names: str, **durations: int) -> ResourceGraph:
    """A path of resources, each named by a letter; durations by name where they are not 1."""
    resources = tuple(Resource(name, duration=durations.get(name, 1), x=x, y=0) for x, name in enumerate(names))
    return ResourceGraph(resources, tuple(pairwise(names)))


def instance(graph: ResourceGraph, *ends: tuple[str, str], after_goal: AfterGoal = "vanish") -> Instance:
    """Robots r0, r1, ... with these starts and goals, all released at 0."""
    robots = tuple(Robot(f"r{index}", start, goal) for index, (start, goal) in enumerate(ends))
    return Instance(graph, robots, after_goal)


def plan_of(robot: str, *visits: tuple[str, int, int | None]) -> Plan:
    """A plan from its visits (resource, enter, leave)."""
    return Plan(robot, tuple(Visit(*visit) for visit in visits))
