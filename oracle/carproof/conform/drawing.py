"""A small picture in text: which robot is in which resource at which tick."""

from collections.abc import Sequence

from carp_spec import Instance, Plan

MOST_TICKS = 60


def drawing(instance: Instance, plans: Sequence[Plan]) -> str:
    """Resources as rows, ticks as columns, robots by their number in the instance; `*` where several are."""
    numbers = {robot.id: str(position % 10) for position, robot in enumerate(instance.robots)}
    ticks = [tick for plan in plans for visit in plan.visits for tick in (visit.enter, visit.leave) if tick is not None]
    end = max(1, min(MOST_TICKS, max(ticks, default=0) + 1))
    width = max((len(str(id)) for id in instance.graph.index), default=0)
    lines = [f"{number}: robot {robot}" for robot, number in numbers.items()]
    lines += ["", " " * (width + 1) + "".join(str(tick % 10) for tick in range(end))]
    for resource in instance.graph.resources:
        row = []
        for tick in range(end):
            inside = [
                numbers.get(plan.robot, "?")
                for plan in plans
                for visit in plan.visits
                if visit.resource == resource.id and visit.enter <= tick and (visit.leave is None or tick < visit.leave)
            ]
            row.append(inside[0] if len(inside) == 1 else "*" if inside else ".")
        lines.append(f"{resource.id!s:>{width}} {''.join(row)}")
    return "\n".join(lines) + "\n"
