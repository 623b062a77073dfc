"""Plans of all robots that need not be the best, for a search that may not end in time.

The robots are planned one after the other, the longest way first; then again and again, with those that found no
plan moved to the front, or in a random order if all did. Each is added by the neighbourhood planner of
`carp_optimized`, which plans near robots again; where its code is not compiled yet, or its arrays do not hold the
instance's numbers, by CARP of `carp_reference`, as compiling would take longer than many a limit.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TypeAlias

from carp_optimum.sat.solver import TimeOver
from carp_spec import Instance, Neighbourhood, Plan, Refusal, ResourceId, RobotId, Solution, total_cost
from carp_spec.permutations import shuffle, splitmix64

ATTEMPTS = 1000
TOGETHER = 3
STUBBORN = 20
STARTS = 6
ROUNDS = 100_000
WORK_OF_ROUND = 2
"""The propagations of a round of annealing, for each robot."""

Attempt: TypeAlias = Callable[[Sequence[RobotId]], tuple[Plan, ...]]


def plans_of_all(
    instance: Instance,
    ticks_to_goal: Mapping[RobotId, Mapping[ResourceId, int]],
    check: Callable[[], None],
    enough: int = 0,
    attempts: int = ATTEMPTS,
    seed: int = 0,
) -> tuple[Plan, ...] | None:
    """The cheapest plans of all robots found, or `None`; `check` is called before each robot and may raise `TimeOver`.

    `ticks_to_goal` are those of `carp_reference.problem.Problem`. A total of `enough` ends the search. After
    `STUBBORN` failures in a row the order is shuffled too; another seed begins with another order.
    """
    stream = splitmix64(seed)
    order = sorted(ticks_to_goal, key=lambda robot: -ticks_to_goal[robot].get(instance.robot[robot].start, 0))
    if seed:
        order = list(shuffle(order, stream))
    attempt = _run(instance, check) or _read(instance, ticks_to_goal, check)
    best: tuple[Plan, ...] | None = None
    failures = 0
    try:
        for _ in range(attempts):
            try:
                plans = attempt(order)
            except Refusal:
                attempt = _read(instance, ticks_to_goal, check)
                continue
            planned = {plan.robot for plan in plans}
            failures = 0 if len(planned) == len(order) else failures + 1
            if 0 < failures < STUBBORN:
                order.sort(key=planned.__contains__)
                continue
            if failures == 0 and (best is None or total_cost(instance, plans) < total_cost(instance, best)):
                best = plans
                if total_cost(instance, best) <= enough:
                    break
            failures = 0
            order = list(shuffle(order, stream))
    except TimeOver:
        pass
    return best


def ever_better(instance: Instance, look: Callable[[], None]) -> Iterator[tuple[int, Sequence[Plan]]]:
    """The best plans of all robots so far, with the work for them: by annealings, then by groups planned together.

    It ends if there are no plans of all robots to begin with. The work is about that of as many propagations of a
    solver; `look` is called now and then, and may end it by an exception. Raises `Refusal` for numbers that are too
    large, and for formulas.
    """
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415 - slow to load
    from carp_optimized.improve.repair import repair  # noqa: PLC0415
    from carp_optimum.sat.group_search import improved  # noqa: PLC0415

    fleet = PlannedFleet(instance)
    fleet.carp(range(len(instance.robots)))
    first = repair(instance, Solution.of(instance, fleet.plans))
    if len(first.plans) < len(instance.robots):
        return
    best: Sequence[Plan] = first.plans
    work = 0
    for seed in range(STARTS):
        found = _annealed(instance, first, seed, look)
        if total_cost(instance, found) < total_cost(instance, best):
            best = found
        work += ROUNDS * len(instance.robots) * WORK_OF_ROUND
        yield work, best
    for further, plans in improved(instance, best, look):
        yield work + further, plans


def _annealed(instance: Instance, solution: Solution, seed: int, look: Callable[[], None]) -> Sequence[Plan]:
    """The plans of an annealing whose clock counts rounds."""
    from carp_optimized.improve.annealing import anneal  # noqa: PLC0415 - slow to load

    played = 0

    def count(rounds: int, _: int, __: int) -> None:
        nonlocal played
        look()
        played = rounds

    return anneal(instance, solution, ROUNDS, seed=seed, advance=count, clock=lambda: played).plans


def _run(instance: Instance, check: Callable[[], None]) -> Attempt | None:
    """The plans of the neighbourhood planner in an order, without the robots that find none; `None`: not at hand."""
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415
    from carp_optimized.jit.compiling import is_cached  # noqa: PLC0415 - slow to load
    from carp_optimized.neighbourhood.adding import add_robot  # noqa: PLC0415

    if not is_cached(add_robot):
        return None
    try:
        fleet = PlannedFleet(instance)
    except Refusal:
        return None

    def attempt(order: Sequence[RobotId]) -> tuple[Plan, ...]:
        fleet.clear()
        for robot in order:
            check()
            fleet.add(fleet.index(robot), 0, Neighbourhood(m=TOGETHER))
        return fleet.plans

    return attempt


def _read(
    instance: Instance, ticks_to_goal: Mapping[RobotId, Mapping[ResourceId, int]], check: Callable[[], None]
) -> Attempt:
    """The plans of CARP in an order, without the robots that find none."""
    from carp_reference.problem import Problem  # noqa: PLC0415 - slow to load
    from carp_reference.query import find_plan  # noqa: PLC0415

    problem = Problem(instance, {robot: [ticks] for robot, ticks in ticks_to_goal.items()}, 0)

    def attempt(order: Sequence[RobotId]) -> tuple[Plan, ...]:
        plans: list[Plan] = []
        for robot in order:
            check()
            plan = find_plan(problem, plans, robot)
            if plan is not None:
                plans.append(plan)
        return tuple(plans)

    return attempt
