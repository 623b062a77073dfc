"""Polishing with crossovers: the best choice among all plans that several polishes have found.

A polish changes a few robots at a time, and ends where no small change helps. Polishes with other choices end
elsewhere, and each is good in other places. So a population of solutions is polished, each for some rounds, and the
plans on their ways are collected, one after the other. Then an integer programme chooses one plan of each robot, so
that they break no rule together and cost least: capacities and exchanges are its rows, as in
`carp_optimum.priced_ways`. The choice takes the place of the worst solution. HiGHS solves the programme; nothing rests
on it, as the law judges what it chooses. Source: column generation with a restricted master heuristic, as surveyed by
Sadykov et al. 2019, where the columns come from a large neighbourhood search.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import count, pairwise, product
from time import perf_counter
from typing import TypeAlias

import numpy as np

from carp_optimized import polish
from carp_spec import Instance, Plan, RobotId, Solution, total_cost
from carp_spec.joint_rules import JOINT_RULES

POPULATION = 6
BATCHES = 10
"""Polishes of one solution between two crossovers; the plans after each are collected."""
ROUNDS = 2000
"""Rounds of a polish."""
GENERATIONS = 2
"""Plans that were not found again for this many crossovers are forgotten."""
NODES = 20
"""The programme ends after this number of nodes of its search tree."""
SECONDS = 15
"""With a limit of time, the programme ends after this number of seconds."""

Row: TypeAlias = tuple[Sequence[int], int]
"""Plans by number, and how many of them may be chosen."""


@dataclass(frozen=True, slots=True)
class Limit:
    """When a polish with crossovers ends: after this number of rounds of all polishes, or of seconds."""

    iterations: int | None
    seconds: float | None
    started: float

    def is_over(self, played: int) -> bool:
        """Whether it is reached after this number of rounds."""
        if self.iterations is not None:
            return played >= self.iterations
        return self.left() <= 0

    def left(self) -> float:
        """The seconds left; endless for a limit of rounds."""
        return float("inf") if self.seconds is None else self.seconds - (perf_counter() - self.started)


def polish_with_crossovers(
    instance: Instance,
    solution: Solution,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """Improve a solution; `advance` gets the rounds, the unplanned robots and the total of the best solution.

    Equal iterations and seed give an equal solution. Raises `Refusal` as `polish` does.
    """
    limit = Limit(iterations, seconds, perf_counter())
    solution = polish(instance, solution, iterations=0)
    population = [solution] * POPULATION
    found: dict[Plan, int] = {}
    seeds = count(seed << 32)
    played = 0
    for generation in count():
        for member in range(POPULATION):
            for _ in range(BATCHES):
                if limit.is_over(played):
                    return min([solution, *population], key=lambda each: worth(instance, each))
                rounds = ROUNDS if iterations is None else min(ROUNDS, iterations - played)
                population[member] = polish(instance, population[member], iterations=rounds, seed=next(seeds))
                played += rounds
                found |= dict.fromkeys(population[member].plans, generation)
                solution = min(solution, population[member], key=lambda each: worth(instance, each))
                advance(played, *worth(instance, solution))
        found = {plan: last for plan, last in found.items() if generation - last < GENERATIONS}
        solution = cross(instance, [*found], solution, min(SECONDS, limit.left()) if seconds is not None else None)
        found |= dict.fromkeys(solution.plans, generation)
        advance(played, *worth(instance, solution))
        worst = max(range(POPULATION), key=lambda member: worth(instance, population[member]))
        population[worst] = solution
    raise AssertionError  # pragma: no cover - the generations do not end


def worth(instance: Instance, solution: Solution) -> tuple[int, int]:
    """The number of unplanned robots, and the total."""
    return len(solution.unplanned), total_cost(instance, solution.plans)


def cross(instance: Instance, plans: Sequence[Plan], best: Solution, seconds: float | None = None) -> Solution:
    """The best solution of these plans that the programme finds, or `best` if that is not worse.

    Without seconds, the same plans in the same order give the same solution.
    """
    plans = list(dict.fromkeys((*best.plans, *plans)))
    chosen = [plans[number] for number in _choice(instance, plans, len(best.plans), seconds)]
    robots = {plan.robot for plan in chosen}
    order = (*(robot for robot in best.order if robot in robots), *(robots - set(best.order)))
    order = (*(robot for robot in best.order if robot in robots), *_newly_planned(chosen, best))
    unplanned = tuple(robot.id for robot in instance.robots if robot.id not in robots)
    crossed = Solution(tuple(sorted(chosen, key=lambda plan: order.index(plan.robot))), order, unplanned)
    is_lawful = len(robots) == len(chosen) and not any(next(rule(instance, chosen), None) for rule in JOINT_RULES)
    return crossed if is_lawful and worth(instance, crossed) < worth(instance, best) else best


def _newly_planned(chosen: Iterable[Plan], best: Solution) -> Iterable[RobotId]:
    return (plan.robot for plan in chosen if plan.robot not in best.order)


def _choice(instance: Instance, plans: Sequence[Plan], known: int, seconds: float | None) -> Sequence[int]:
    """The numbers of the plans that are chosen; the first `known` are lawful together."""
    import highspy  # noqa: PLC0415 - slow to load, and only for those who ask

    robots = {robot.id: number for number, robot in enumerate(instance.robots)}
    costs = [total_cost(instance, (plan,)) for plan in plans]
    missing = 0 if known == len(robots) else 1 + sum(costs)  # what a robot without a plan costs: more than all plans
    rows: list[Row] = [([], 1) for _ in robots]
    for number, plan in enumerate(plans):
        rows[robots[plan.robot]][0].append(number)  # type: ignore[attr-defined]
    rows += conflict_rows(instance, plans)
    highs = highspy.Highs()
    highs.setOptionValue("output_flag", False)
    highs.setOptionValue("threads", 1)
    highs.setOptionValue("mip_max_nodes", NODES)
    highs.setOptionValue("mip_rel_gap", 0.0)
    highs.setOptionValue("mip_abs_gap", 1 / 2)
    if seconds is not None:
        highs.setOptionValue("time_limit", max(seconds, 0.0))
    size = len(plans)
    none, empty = np.zeros(0), np.zeros(0, np.int32)
    gains = np.array([cost - missing for cost in costs], np.float64)
    highs.addCols(size, gains, np.zeros(size), np.ones(size), 0, empty, empty, none)
    whole = np.full(size, highspy.HighsVarType.kInteger)
    highs.changeColsIntegrality(size, np.arange(size, dtype=np.int32), whole)
    members = np.array([number for numbers, _ in rows for number in numbers], np.int32)
    starts = np.cumsum([0, *(len(numbers) for numbers, _ in rows[:-1])]).astype(np.int32)
    most = np.array([limit for _, limit in rows], np.float64)
    least = np.full(len(rows), -highspy.kHighsInf)
    least[: len(robots)] = float(known == len(robots))
    highs.addRows(len(rows), least, most, len(members), starts, members, np.ones(len(members)))
    first = highspy.HighsSolution()
    first.col_value = [1.0 if number < known else 0.0 for number in range(size)]
    highs.setSolution(first)
    highs.run()
    values = highs.getSolution().col_value
    return [number for number in range(size) if number < len(values) and values[number] > 1 / 2]


def conflict_rows(instance: Instance, plans: Sequence[Plan]) -> list[Row]:
    """What the joint rules demand of a choice of plans, of one plan for each robot.

    Where one of two resources has room for one robot, all who exchange, or stay in it just before and at the tick, are
    one row: two of them would be there together. Elsewhere each two who exchange are a row.
    """
    graph = instance.graph
    present: dict[tuple[str, int], list[int]] = defaultdict(list)
    staying: dict[tuple[str, int], list[int]] = defaultdict(list)
    moving: dict[tuple[str, str, int], list[int]] = defaultdict(list)
    last = max((visit.enter for plan in plans for visit in plan.visits), default=0) + 1
    for number, plan in enumerate(plans):
        for visit in plan.visits:
            for tick in range(visit.enter, max(last, visit.enter + 1) if visit.leave is None else visit.leave):
                present[visit.resource, tick].append(number)
                if tick > visit.enter:
                    staying[visit.resource, tick].append(number)
        for visit, following in pairwise(plan.visits):
            moving[visit.resource, following.resource, following.enter].append(number)
    rows: list[Row] = [(numbers, graph.resource[place].capacity) for (place, _), numbers in present.items()]
    for (source, target, tick), there in moving.items():
        back = moving.get((target, source, tick), [])
        if back and graph.index[source] < graph.index[target]:
            narrow = [place for place in (source, target) if graph.resource[place].capacity == 1]
            rows += [([*there, *back, *staying.get((place, tick), [])], 1) for place in narrow[:1]]
            rows += [(pair, 1) for pair in product(there, back) if not narrow]
    return list({tuple(numbers): (numbers, most) for numbers, most in rows if len(numbers) > most}.values())
