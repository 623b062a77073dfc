"""People first: a robot with priority gets the earliest plan that the others' histories allow, and they give way.

At the tick now each other robot has a history that it cannot undo (`fleet/history`): the visits entered by then, the
current one for at least its duration. A robot that appears later stands at its start from its release. The robot with
priority is planned first, beside these histories alone, and no plan beside them arrives earlier (`query/optimal`). So
if all others can be planned around it, no lawful update has an earlier arrival (`priority/first`).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from carp_spec import (
    Instance,
    Plan,
    Refusal,
    RobotId,
    Solution,
    Visit,
    check_update,
    has_ended,
    plan_cost,
    violations_of,
)
from carp_spec.rule import DESIGN, rule
from carproof.engines import Engine


@rule(
    "priority/first",
    "Where the others give way to a robot at the tick now, the result is a lawful update of the plans: it has one "
    "plan for that robot and for each robot that had one, breaks no rule, and keeps fleet/history. In no lawful "
    "update does that robot arrive earlier.",
    DESIGN,
)
def robot_is_first(  # noqa: D103 - its statement stands in its decorator
    instance: Instance,
    before: Sequence[Plan],
    after: Sequence[Plan],
    robot: RobotId,
    now: int,
    rivals: Iterable[Sequence[Plan]],
) -> bool:
    def is_lawful(update: Sequence[Plan]) -> bool:
        robots = {plan.robot for plan in update}
        is_whole = robots == {robot, *(plan.robot for plan in before)} and len(robots) == len(update)
        return is_whole and not violations_of(instance, update) and not check_update(before, update, now)

    def arrival(update: Sequence[Plan]) -> int:
        return next(plan.visits[-1].enter for plan in update if plan.robot == robot)

    return is_lawful(after) and not any(is_lawful(rival) and arrival(rival) < arrival(after) for rival in rivals)


@dataclass(frozen=True, slots=True)
class GivenWay:
    """The result of giving way.

    `solution` has the new plans, or is `None` if the robot itself or those that are `stuck` have none; then nothing
    changes. `extra` has the robots that were replanned, each with the ticks by which it arrives later. In no lawful
    update (with a route: on that route) does the robot arrive before `least`; the planner's search says so, without a
    certificate.
    """

    robot: RobotId
    solution: Solution | None
    arrival: int | None
    least: int | None
    extra: Mapping[RobotId, int]
    stuck: tuple[RobotId, ...]

    @property
    def is_first(self) -> bool:
        """Whether no lawful update has an earlier arrival."""
        return self.solution is not None and self.arrival == self.least


def history(instance: Instance, plan: Plan, now: int) -> Plan:
    """The visits that the robot cannot undo, with the current one left as early as possible."""
    if has_ended(plan, now):
        return plan
    entered = [visit for visit in plan.visits if visit.enter <= now] or [plan.visits[0]]
    current = entered[-1]
    ready = max(current.enter + instance.duration(plan.robot, current.resource), now)
    return Plan(plan.robot, (*entered[:-1], Visit(current.resource, current.enter, ready)))


def give_way(
    instance: Instance,
    solution: Solution,
    robot: RobotId,
    now: int,
    engine: Engine,
    route: Sequence[Visit] | None = None,
) -> GivenWay:
    """Plan the robot first, or take its fixed route, and the others around it.

    If some find no plan around the earliest one, they keep theirs, and the robot gets the earliest plan beside those.
    Raises `Refusal` for a route that breaks a rule.
    """
    plans = {plan.robot: plan for plan in solution.plans}
    others = [plans[each] for each in solution.order if each != robot]
    own = [plans[robot]] if robot in plans else []
    kept: set[RobotId] = set()
    stuck: dict[RobotId, None] = {}
    least: int | None = None
    while True:
        fixed = [plan if plan.robot in kept else history(instance, plan, now) for plan in others]
        if route is None:
            first = engine.find(instance, [*fixed, *own], robot, now)
        else:
            first = Plan(robot, tuple(route))
            refuse_route(instance, fixed, own, first, now)
        if first is None:
            return GivenWay(robot, None, None, least, {}, tuple(stuck))
        arrival = first.visits[-1].enter
        least = arrival if least is None else least
        around = plan_around(instance, others, first, now, engine, kept)
        if isinstance(around, dict):
            unchanged = [each for each in solution.order if each != robot]
            unplanned = tuple(each for each in solution.unplanned if each != robot)
            changed = (first, *(around[each] for each in unchanged))
            after = Solution(changed, (robot, *unchanged), unplanned)
            extra = {
                plan.robot: plan_cost(instance, around[plan.robot]) - plan_cost(instance, plan)
                for plan in others
                if around[plan.robot] != plan
            }
            return GivenWay(robot, after, arrival, least, extra, tuple(stuck))
        stuck[around] = None
        if route is not None or around in kept:
            return GivenWay(robot, None, arrival, least, {}, tuple(stuck))
        kept.add(around)


def refuse_route(instance: Instance, fixed: Sequence[Plan], own: Sequence[Plan], route: Plan, now: int) -> None:
    """Raise `Refusal` if the route breaks a rule, alone, with its own history, or with the histories of others."""
    alone = [each for each in violations_of(instance, [route]) if each.robots == (route.robot,)]
    together = [each for each in violations_of(instance, [*fixed, route]) if each.rule.startswith("joint/")]
    for violation in (*alone, *together, *check_update(own, [route], now)):
        raise Refusal("request", "$.route", violation.rule, f"the route breaks a rule: {violation.message}")


def plan_around(
    instance: Instance, others: Sequence[Plan], first: Plan, now: int, engine: Engine, kept: set[RobotId]
) -> dict[RobotId, Plan] | RobotId:
    """The plans of the others around the first plan, few of them new, or a robot that finds none.

    Robots that collide are replanned in their order. If one finds no plan, the robots in the way of its plan beside the
    histories alone are replanned after it.
    """
    before = {plan.robot: plan for plan in others}
    moving = colliding(instance, [first], others)
    tried: list[list[RobotId]] = []
    while True:
        tried.append(moving)
        plans = {robot: plan for robot, plan in before.items() if robot not in moving}
        waiting = [history(instance, before[robot], now) for robot in moving]
        for robot in moving:
            waiting = waiting[1:]
            plan = engine.find(instance, [first, *plans.values(), *waiting, before[robot]], robot, now)
            if plan is None:
                failed = robot
                break
            plans[robot] = plan
        else:
            return {robot: plans[robot] for robot in before}
        if failed in kept:
            return failed
        histories = [history(instance, plan, now) for robot, plan in before.items() if robot != failed]
        wished = engine.find(instance, [first, *histories, before[failed]], failed, now)
        if wished is None:
            return failed
        in_way = colliding(instance, [first, wished], [plan for robot, plan in before.items() if robot != failed])
        wider = list(dict.fromkeys([failed, *moving, *(robot for robot in in_way if robot not in kept)]))
        if wider in tried:
            return failed
        moving = wider


def colliding(instance: Instance, first: Sequence[Plan], others: Sequence[Plan]) -> list[RobotId]:
    """The robots, in their order, that must be taken out so that no rule of robots together is broken."""
    fixed = {plan.robot for plan in first}
    taken: list[RobotId] = []
    rest = list(others)
    place = {plan.robot: number for number, plan in enumerate(others)}
    while True:
        crowds = [
            [robot for robot in violation.robots if robot not in fixed]
            for violation in violations_of(instance, [*first, *rest], most=None)
            if violation.rule.startswith("joint/") and not fixed.isdisjoint(violation.robots)
        ]
        out = {max(crowd, key=place.__getitem__) for crowd in crowds if crowd}
        if not out:
            return sorted(taken, key=place.__getitem__)
        taken += out
        rest = [plan for plan in rest if plan.robot not in out]
