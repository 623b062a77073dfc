"""Small pictures in text: the map with starts and goals, and which robot is in which resource at which tick."""

from collections.abc import Mapping, Sequence
from string import ascii_letters, ascii_uppercase, digits

from carp_spec import Instance, Plan, ResourceId, Robot

MOST_TICKS = 60
MOST_CELLS = 60
SYMBOLS = digits + ascii_letters
MANY, NOBODY, UNKNOWN = "*", ".", "?"


def map_drawing(instance: Instance) -> str:
    """The cells at their positions, with robots' starts as numbers and their goals as letters; else the moves."""
    starts: dict[ResourceId, str] = {}
    goals: dict[ResourceId, str] = {}
    for number, robot in enumerate(instance.robots[: len(ascii_uppercase)]):
        starts[robot.start] = starts.get(robot.start, "") + str(number % 10)
        goals[robot.goal] = goals.get(robot.goal, "") + ascii_uppercase[number]
    cells = {
        (each.x, each.y): starts.get(each.id, "") + goals.get(each.id, "") or "."
        for each in instance.graph.resources
        if each.x is not None and each.y is not None
    }
    legend = [
        f"{number % 10}: robot {robot.id} goes from {_way(robot)}"
        + (f" ({ascii_uppercase[number]})" if number < len(ascii_uppercase) else "")
        for number, robot in enumerate(instance.robots)
    ]
    legend += [
        f"group {each.id}, capacity {each.capacity}: {', '.join(map(str, each.resources))}"
        for each in instance.graph.groups
    ]
    if cells and len(cells) == len(instance.graph.resources):
        return "\n".join([*legend, "", *_rows(cells)]) + "\n"
    moves = [f"{source} -> {', '.join(map(str, instance.graph.successors[source]))}" for source in instance.graph.index]
    return "\n".join([*legend, "", *moves]) + "\n"


def _way(robot: Robot) -> str:
    """The robot's start and stops."""
    return " to ".join(map(str, (robot.start, *(stop.resource for stop in robot.stops))))


def _rows(cells: Mapping[tuple[int, int], str]) -> list[str]:
    """A line for each row; a map wider or higher than `MOST_CELLS` is not drawn."""
    xs, ys = sorted({x for x, _ in cells}), sorted({y for _, y in cells})
    if xs[-1] - xs[0] >= MOST_CELLS or ys[-1] - ys[0] >= MOST_CELLS:
        return []
    width = max(map(len, cells.values())) + 1
    columns, rows = range(xs[0], xs[-1] + 1), range(ys[0], ys[-1] + 1)
    return ["".join(f"{cells.get((x, y), ''):{width}}" for x in columns).rstrip() for y in rows]


def drawing(instance: Instance, plans: Sequence[Plan]) -> str:
    """Resources as rows, ticks as columns, a symbol for each robot, and above them a legend."""
    symbols = dict(zip(instance.robot, SYMBOLS, strict=False))
    ticks = [tick for plan in plans for visit in plan.visits for tick in (visit.enter, visit.leave) if tick is not None]
    last = max(ticks, default=0)
    end = max(1, min(MOST_TICKS, last + 1))
    width = max((len(str(id)) for id in instance.graph.index), default=0)
    lines = [
        "A row is a resource and a column a tick, headed by its last digit.",
        f"{NOBODY} is nobody, {MANY} is several robots, and the robots are:",
        *(f"{symbol}: robot {robot}" for robot, symbol in symbols.items()),
    ]
    if len(symbols) < len(instance.robots) or any(plan.robot not in instance.robot for plan in plans):
        lines.append(f"{UNKNOWN}: any other robot")
    if end <= last:
        lines.append(f"The ticks from {end} to {last} are left out.")
    lines += ["", " " * (width + 1) + "".join(str(tick % 10) for tick in range(end))]
    inside: dict[tuple[ResourceId, int], str] = {}
    for robot, visit in ((plan.robot, visit) for plan in plans for visit in plan.visits):
        for tick in range(max(0, visit.enter), end if visit.leave is None else min(end, visit.leave)):
            place = visit.resource, tick
            inside[place] = MANY if place in inside else symbols.get(robot, UNKNOWN)
    for id in instance.graph.index:
        lines.append(f"{id!s:>{width}} " + "".join(inside.get((id, tick), NOBODY) for tick in range(end)))
    return "\n".join(lines) + "\n"
