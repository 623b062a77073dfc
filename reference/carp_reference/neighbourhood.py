"""The neighbourhood planner: the paper's Algorithm 1, line by line, as the rules `neighbourhood/...` decide.

In the paper's notation, `outside` is the sequence A, `members` the set N, and `new` the robot a_k.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby

from carp_reference.orderings import Plans, shuffled
from carp_reference.problem import Problem
from carp_reference.query import find_plan
from carp_spec import Neighbourhood, Plan, RobotId, has_ended, total_cost
from carp_spec import neighbourhood_rules as rules
from carp_spec.permutations import Order, splitmix64


def add_robot(problem: Problem, committed: Plans, new: RobotId, options: Neighbourhood) -> Plans | None:
    """All plans with the new robot's, in their new planning order; `None` if it stays unplanned.

    A robot that gets further stops is new too: `before` of the problem has the plan that it has followed.
    """
    problem = replace(problem, before={**problem.before, **{plan.robot: plan for plan in committed}})
    plans = _best_candidate(problem, committed, new, options)
    if plans is None and options.fallback is not None:
        order = [*(plan.robot for plan in committed), new]
        plans = shuffled(problem, order, options.fallback, options.seed)
        return plans if len(plans) > len(committed) else None
    return plans


def _best_candidate(problem: Problem, committed: Plans, new: RobotId, options: Neighbourhood) -> Plans | None:
    shortest = find_plan(problem, (), new)
    if shortest is None:
        return None
    trajectories = {**problem.before, new: shortest}
    stream = splitmix64(options.seed + problem.instance.robots.index(problem.instance.robot[new]))
    outside = [plan.robot for plan in committed]
    kept = committed
    members = [new]
    best: Plans | None = None
    rounds = min(options.m - 1, sum(not has_ended(plan, problem.now) for plan in committed))
    if rules.baseline_is_tried(options.baseline, rounds):
        plan = find_plan(problem, committed, new)
        best = None if plan is None else (*committed, plan)
    for _ in range(rounds):
        taken = _nearest_outside(problem, trajectories, outside, members)
        members.append(outside.pop(taken))
        kept = _replan(problem, kept[: rules.replanned_from(taken, len(kept))], outside)
        round_best: Plans | None = None
        if len(kept) == len(outside):
            orders = rules.neighbourhood_orders(len(members), options.sample, stream)
            for plans in _plans_of_orders(problem, kept, members, orders):
                round_best = _better(problem, round_best, (*kept, *plans))
        best = _better(problem, best, round_best)
        planned = {plan.robot: plan for plan in round_best or kept}
        trajectories = {robot: rules.next_trajectory(plan, planned.get(robot)) for robot, plan in trajectories.items()}
    return best


def _better(problem: Problem, best: Plans | None, candidate: Plans | None) -> Plans | None:
    """The better of the two, if any."""
    if candidate is None:
        return best
    best_cost = None if best is None else total_cost(problem.instance, best)
    return candidate if rules.replaces_best(total_cost(problem.instance, candidate), best_cost) else best


def _nearest_outside(
    problem: Problem, trajectories: Mapping[RobotId, Plan], outside: Sequence[RobotId], members: Sequence[RobotId]
) -> int:
    """The position of the robot to take in; plans that have ended are left alone."""
    under_way = [robot for robot in outside if not has_ended(problem.before[robot], problem.now)]
    distances = [
        [rules.distance(problem.instance, trajectories[robot], trajectories[member]) for member in members]
        for robot in under_way
    ]
    return outside.index(under_way[rules.nearest(distances)])


def _replan(problem: Problem, kept: Plans, outside: Sequence[RobotId]) -> Plans:
    """The plans kept, and new ones for the robots behind them, up to the first that finds none."""
    plans = list(kept)
    for robot in outside[len(kept) :]:
        plan = find_plan(problem, plans, robot)
        if plan is None:
            break
        plans.append(plan)
    return tuple(plans)


def _plans_of_orders(
    problem: Problem, committed: Plans, members: Sequence[RobotId], orders: Iterable[Order]
) -> Iterator[Plans]:
    """The members' plans in each order in which all find one; orders that begin alike share the first queries."""
    for first, alike in groupby(orders, key=lambda order: order[0]):
        rest = [order[1:] for order in alike]
        plan = find_plan(problem, committed, members[first])
        if plan is None:
            continue
        if rest == [()]:
            yield (plan,)
            continue
        for plans in _plans_of_orders(problem, (*committed, plan), members, rest):
            yield (plan, *plans)
