"""Plans of all robots that need not be the best, for a search that may not end in time.

The robots are planned one after the other, the longest way first; then again and again, with those that found no
plan moved to the front, or in a random order if all did.
"""

from collections.abc import Callable, Mapping, Sequence

from carp_spec import Instance, Plan, ResourceId, RobotId, total_cost
from carp_spec.permutations import shuffle, splitmix64
from carp_verify.solver import TimeOver

ATTEMPTS = 30


def plans_of_all(
    instance: Instance, ticks_to_goal: Mapping[RobotId, Mapping[ResourceId, int]], check: Callable[[], None]
) -> tuple[Plan, ...] | None:
    """The cheapest plans of all robots found, or `None`; `check` is called before each query and may raise `TimeOver`.

    `ticks_to_goal` are those of `carp_reference.problem.Problem`.
    """
    stream = splitmix64(0)
    order = sorted(ticks_to_goal, key=lambda robot: -ticks_to_goal[robot].get(instance.robot[robot].start, 0))
    best: tuple[Plan, ...] | None = None
    try:
        for _ in range(ATTEMPTS):
            plans = _planned_in(order, instance, ticks_to_goal, check)
            planned = {plan.robot for plan in plans}
            if len(planned) < len(order):
                order.sort(key=planned.__contains__)
                continue
            if best is None or total_cost(instance, plans) < total_cost(instance, best):
                best = plans
            order = list(shuffle(order, stream))
    except TimeOver:
        pass
    return best


def _planned_in(
    order: Sequence[RobotId],
    instance: Instance,
    ticks_to_goal: Mapping[RobotId, Mapping[ResourceId, int]],
    check: Callable[[], None],
) -> tuple[Plan, ...]:
    """The plans of CARP in this order, without the robots that find none."""
    from carp_reference.problem import Problem  # noqa: PLC0415 - slow to load
    from carp_reference.query import find_plan  # noqa: PLC0415

    problem = Problem(instance, ticks_to_goal, 0)
    plans: list[Plan] = []
    for robot in order:
        check()
        plan = find_plan(problem, plans, robot)
        if plan is not None:
            plans.append(plan)
    return tuple(plans)
