"""Plans of all robots that need not be the best, for a search that may not end in time."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

from carp_optimized.orderings import carp
from carp_optimum.sat.solver import TimeOver
from carp_spec import Instance, Plan, Refusal, RobotId, Solution, total_cost

POLISHES, ROUNDS_OF_POLISH = 50, 200
PASSES = 20  # of CARP, each with the robots first that the one before left out
STARTS = 6  # seeds of annealing
ROUNDS, ROUNDS_OF_CROWD = 100_000, 30_000
"""Of an annealing. With a third of the rounds, those of a crowd find better plans."""
WORK_OF_ANNEALING = 150_000
"""The propagations of an annealing, for each robot."""


def plans_of_all(instance: Instance, order: Sequence[RobotId], check: Callable[[], None]) -> Sequence[Plan] | None:
    """Plans of all robots by the neighbourhood planner, polished; `None` if none are found.

    Where its code is not compiled yet, they are those of CARP, at first in this order, as compiling would take longer
    than many a limit. `check` may end the search by `TimeOver`; what was found by then is kept.
    """
    from carp_optimized.jit.compiling import is_cached  # noqa: PLC0415 - slow to load
    from carp_optimized.neighbourhood.adding import add_robot  # noqa: PLC0415

    found: list[Sequence[Plan]] = []
    with suppress(TimeOver):
        if is_cached(add_robot):
            with suppress(Refusal):  # numbers that only the reference holds
                found.extend(_polished(instance, check))
        if not found:
            found.extend(_in_some_order(instance, order, check))
    return found[-1] if found else None


def _polished(instance: Instance, check: Callable[[], None]) -> Iterator[Sequence[Plan]]:
    """Ever better plans of all robots."""
    import carp_optimized  # noqa: PLC0415 - slow to load

    solution = carp_optimized.plan(instance, advance=check)
    for seed in range(POLISHES):
        if not solution.unplanned:
            yield solution.plans
        solution = carp_optimized.polish(
            instance, solution, iterations=ROUNDS_OF_POLISH, seed=seed, advance=lambda *_: check()
        )
    if not solution.unplanned:
        yield solution.plans


def _in_some_order(instance: Instance, order: Sequence[RobotId], check: Callable[[], None]) -> Iterator[Sequence[Plan]]:
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
            yield plans
            return
        order = sorted(order, key={plan.robot for plan in plans}.__contains__)


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
