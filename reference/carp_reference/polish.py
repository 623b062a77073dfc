"""Polishing, large neighbourhood search (LNS): a solution is improved as the rules `polish/...` decide.

Robots without a plan come first, so polishing also repairs a solution.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter

from carp_reference.problem import Problem, prepare
from carp_reference.query import find_plan
from carp_spec import Instance, Plan, RobotId, Solution, plan_cost, total_cost
from carp_spec import polish_rules as rules
from carp_spec.inputs.options import require_polish_options
from carp_spec.inputs.values import known
from carp_spec.neighbourhood_rules import distance
from carp_spec.permutations import splitmix64
from carp_spec.requests import require_tick, sound_solution

ByRobot = Mapping[RobotId, Plan]


@dataclass(frozen=True, slots=True)
class Polish:
    """The data of all rounds; `alone` has the plans on the empty graph."""

    problem: Problem
    alone: ByRobot
    stream: Iterator[int]


def polish(  # noqa: PLR0913 - how long, how, and when
    instance: Instance,
    solution: Solution,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    now: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """Improve a solution for that many rounds or seconds; `advance` gets rounds, unplanned robots and total.

    Robots keep what they have done by the tick `now`; after tick 0, those without a plan get none. The polish ends
    earlier if no plan can be shorter. Equal iterations and seed give an equal solution. Raises `Refusal` for wrong
    options or a broken rule.
    """
    require_polish_options(iterations, seconds, seed)
    require_tick(now)
    whole = sound_solution(instance, solution)
    last = rules.last_round(iterations, seconds)
    started = perf_counter()
    by_robot = {plan.robot: plan for plan in whole.plans}
    problem = replace(prepare(instance, now), before=by_robot)
    able = [robot.id for robot in instance.robots if now == 0 or robot.id in by_robot]
    alone = {robot: plan for robot in able if (plan := find_plan(problem, (), robot)) is not None}
    polishing = Polish(problem, alone, splitmix64(seed))
    plans: ByRobot = {robot: by_robot[robot] for robot in whole.order}
    turn = 0
    while turn != last and (seconds is None or perf_counter() - started < seconds):
        better = _round(polishing, plans, turn)
        if better is None:
            break
        plans = better
        turn += 1
        advance(turn, *_worth(instance, plans))
    return known(instance, Solution.of(instance, plans.values()))


def _round(polishing: Polish, plans: ByRobot, turn: int) -> ByRobot | None:
    """The plans after one round; `None` if there is nothing to improve."""
    instance, alone, stream = polishing.problem.instance, polishing.alone, polishing.stream
    everyone = [robot.id for robot in instance.robots if robot.id in alone]
    least = {robot: plan_cost(instance, alone[robot]) for robot in everyone}
    delays = [plan_cost(instance, plans[robot]) - least[robot] if robot in plans else 0 for robot in everyone]
    unplanned = [int(robot not in plans) for robot in everyone]
    kind = rules.kind_of(turn, sum(unplanned), sum(delays), stream)
    if kind is None:
        return None
    weights = {"repair": unplanned, "delayed": delays}.get(kind, [int(robot in plans) for robot in everyone])
    pivot = everyone[rules.pivot_of(weights, stream)]
    members = rules.members_of(pivot, _candidates(polishing, plans, kind, pivot), everyone, stream)
    changed = _replan(
        replace(polishing.problem, before=plans), plans, rules.order_of(members, kind == "repair", stream)
    )
    return changed if rules.is_kept(_worth(instance, plans), _worth(instance, changed)) else plans


def _candidates(polishing: Polish, plans: ByRobot, kind: rules.Kind, pivot: RobotId) -> list[RobotId]:
    """The robots related to the pivot, in the order in which they are removed."""
    instance = polishing.problem.instance
    others = [plans[robot.id] for robot in instance.robots if robot.id in plans and robot.id != pivot]
    if kind == "near":
        distances = [distance(instance, plans[pivot], other) for other in others]
        return [others[place].robot for place in rules.by_distance(distances)]
    if kind == "contested":
        visits = plans[pivot].visits
        visit = visits[next(polishing.stream) % len(visits)]
        apart = {other.robot: ticks for other in others if (ticks := rules.ticks_apart(visit, other)) is not None}
        return sorted(apart, key=apart.__getitem__)
    is_own = kind == "delayed" and next(polishing.stream) % 2 == 1
    wished = rules.spans(instance.graph.successors, plans[pivot] if is_own else polishing.alone[pivot])
    in_way = [other.robot for other in others if rules.is_in_way(wished, other)]
    return rules.drawn(in_way, len(in_way), polishing.stream)


def _replan(problem: Problem, plans: ByRobot, members: Sequence[RobotId]) -> ByRobot:
    """The plans with those of the members made again, in this order."""
    changed = {robot: plan for robot, plan in plans.items() if robot not in members}
    for robot in members:
        plan = find_plan(problem, tuple(changed.values()), robot)
        if plan is not None:
            changed[robot] = plan
    return changed


def _worth(instance: Instance, plans: ByRobot) -> tuple[int, int]:
    """Fewer unplanned robots are better, then a smaller total."""
    return (len(instance.robots) - len(plans), total_cost(instance, tuple(plans.values())))
