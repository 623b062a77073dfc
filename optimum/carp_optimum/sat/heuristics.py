"""Plans of all robots that need not be the best, for a search that may not end in time."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial

from carp_optimized.orderings import carp
from carp_optimum.deadline import Deadline, TimeOver
from carp_spec import Instance, Plan, Refusal, RobotId, Solution, judge, total_cost

BETWEEN_LOOKS = 16  # robots whose shortest paths are found between two looks at the clock
PASSES = 20  # of CARP, each with the robots first that the one before left out
STARTS = 6  # seeds of annealing
ROUNDS, ROUNDS_OF_CROWD = 100_000, 30_000
"""Of an annealing. With a third of the rounds, those of a crowd find better plans."""
WORK_OF_ANNEALING = 150_000
"""The propagations of an annealing, for each robot."""


def plans_of_all(instance: Instance, order: Sequence[RobotId], deadline: Deadline) -> Sequence[Plan] | None:
    """The best plans of all robots until the deadline; `None` if none are found.

    Where the planner's code is not compiled yet, they are those of CARP, at first in this order, as compiling would
    take longer than many a limit.
    """
    from carp_optimized.improve.annealing import BRIEF  # noqa: PLC0415 - slow to load
    from carp_optimized.improve.anytime import plan_within  # noqa: PLC0415

    with suppress(TimeOver):
        if _is_compiled():
            with suppress(Refusal):  # numbers that only the reference holds
                left, judging = max(deadline.left(), BRIEF), partial(judge, instance)
                found = plan_within(instance, seconds=left, clock=deadline.clock, finish=judging).solution
                return None if found.unplanned else found.plans
        return _in_some_order(instance, order, deadline.check)
    return None


def sum_of_shortest_paths(instance: Instance, check: Callable[[], None]) -> int | None:
    """The sum of the robots' costs if each were alone, one without a way left out.

    `None` if `check` ends the search for them by `TimeOver`, or where the planner's code is not compiled yet.
    """
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415 - slow to load

    total = 0
    with suppress(TimeOver, Refusal):
        if _is_compiled():
            fleet = PlannedFleet(instance)
            for robot in range(len(instance.robots)):
                if robot % BETWEEN_LOOKS == 0:
                    check()
                total += fleet.ticks_to_goal(robot)
            return total
    return None


def _is_compiled() -> bool:
    from carp_optimized.jit.compiling import is_cached  # noqa: PLC0415 - slow to load
    from carp_optimized.neighbourhood.adding import add_robot  # noqa: PLC0415

    return is_cached(add_robot)


def _in_some_order(instance: Instance, order: Sequence[RobotId], check: Callable[[], None]) -> Sequence[Plan] | None:
    """The plans of CARP, if there are any: pass after pass, with the robots first that the one before left out."""
    import carp_reference  # noqa: PLC0415 - slow to load

    for _ in range(PASSES):
        plans: list[Plan] = []
        for robot in order:
            check()
            plan = carp_reference.find(instance, plans, robot)
            if plan is not None:
                plans.append(plan)
        if len(plans) == len(order):
            return plans
        order = sorted(order, key={plan.robot for plan in plans}.__contains__)
    return None


def ever_better(instance: Instance, look: Callable[[], None]) -> Iterator[tuple[int, Sequence[Plan]]]:
    """The best plans of all robots so far, with the work for them: by annealings, then by groups planned together.

    It ends if there are no plans of all robots to begin with. The work is about that of as many propagations of a
    solver; `look` is called now and then, and may end it by an exception. Raises `Refusal` for numbers that are too
    large, and for formulas.
    """
    from carp_optimum.sat.group_search import improved  # noqa: PLC0415 - slow to load

    best: Sequence[Plan] = ()
    work = 0
    for found in _annealed(instance, look):
        if not best or total_cost(instance, found) < total_cost(instance, best):
            best = found
        work += WORK_OF_ANNEALING * len(instance.robots)
        yield work, best
    if best:
        for further, plans in improved(instance, best, look):
            yield work + further, plans


def _annealed(instance: Instance, look: Callable[[], None]) -> Iterator[Sequence[Plan]]:
    """The plans of annealings that count rounds, of one seed after the other; none if there are none to begin with."""
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415 - slow to load
    from carp_optimized.improve.annealing import anneal  # noqa: PLC0415
    from carp_optimized.improve.planning import plan_crowd  # noqa: PLC0415
    from carp_optimized.improve.repair import repair  # noqa: PLC0415

    def looking() -> float:
        look()
        return 0.0

    for seed in range(STARTS):
        found = plan_crowd(instance, iterations=ROUNDS_OF_CROWD, seconds=None, seed=seed, clock=looking)
        if found is None or found.solution.unplanned:
            break
        yield found.solution.plans
    else:
        return
    fleet = PlannedFleet(instance)
    carp(fleet, range(len(instance.robots)))
    first = repair(instance, Solution.of(instance, fleet.plans))
    played = 0

    def count(rounds: int, _: int, __: int) -> None:
        nonlocal played
        look()
        played = rounds

    def clock() -> int:
        return played

    for seed in range(0 if first.unplanned else STARTS):
        played = 0
        yield anneal(instance, first, ROUNDS, seed=seed, advance=count, clock=clock).plans
