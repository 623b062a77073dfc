"""The rules of one plan: `plan/...`, `cost/...` and `fleet/history`."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise, zip_longest

from carp_spec.model import Instance, Plan, Robot, Stop, Visit
from carp_spec.rule import DESIGN, MORS, Breach, Rule, Violation, at_visit, of_robots, rule, violation_rule


@violation_rule(
    "plan/start", "The first visit is to the robot's start and enters at its release tick.", f"{MORS}; {DESIGN}"
)
def plan_starts_at_release(instance: Instance, plan: Plan) -> Iterator[Breach]:
    robot = instance.robot[plan.robot]
    right = f"the first visit must be to {robot.start} at the release tick {robot.release}"
    if not plan.visits:
        yield of_robots([plan.robot], f"{right}, and there is no visit")
    elif (plan.visits[0].resource, plan.visits[0].enter) != (robot.start, robot.release):
        yield at_visit(plan.robot, plan.visits[0], right)


@violation_rule(
    "plan/goal",
    "The last visit is to the robot's goal, the resource of its last stop. With `vanish` it is left exactly one "
    "duration (times the robot's pace) after its entry, or the last stop's service if that is longer; with `park` it "
    "is never left.",
    "paper, section IV (experiments); decision of carproof",
)
def plan_ends_at_goal(instance: Instance, plan: Plan) -> Iterator[Breach]:
    stop = instance.robot[plan.robot].stops[-1]
    goal = stop.resource
    if not plan.visits:
        yield of_robots([plan.robot], f"the last visit must be to {goal}, and there is no visit")
        return
    last = plan.visits[-1]
    leave = None if instance.after_goal == "park" else last.enter + instance.stay(plan.robot, stop)
    if last.resource != goal:
        yield at_visit(plan.robot, last, f"the last visit must be to {goal}")
    elif last.leave != leave:
        right = "stay at the goal for ever" if leave is None else f"leave the goal at {leave}"
        yield at_visit(plan.robot, last, f"it must {right}")


def stops_served(stops: Sequence[Stop], visits: Iterable[Visit]) -> int:
    """How many of the stops the visits have served, in order: each that is left serves the next stop if it can."""
    served = 0
    for visit in visits:
        if served == len(stops):
            break
        long_enough = visit.leave is not None and visit.leave - visit.enter >= stops[served].service
        served += long_enough and visit.resource == stops[served].resource
    return served


def stops_left(robot: Robot, followed: Plan | None, now: int) -> tuple[Stop, ...]:
    """The stops of a robot but for those that it has served by now; the visit in which it is then has served none."""
    entered = () if followed is None else [visit for visit in followed.visits if visit.enter <= now]
    return robot.stops[stops_served(robot.stops[:-1], entered[:-1]) :]


def least_stays(instance: Instance, plan: Plan) -> list[int]:
    """The least ticks of each visit of a lawful plan: the duration, or more in those that serve its stops."""
    *stops, last = instance.robot[plan.robot].stops
    least = [instance.duration(plan.robot, visit.resource) for visit in plan.visits]
    served = 0
    for place in range(len(least)):
        if stops_served(stops[served : served + 1], plan.visits[place : place + 1]):
            least[place] = instance.stay(plan.robot, stops[served])
            served += 1
    return [*least[:-1], instance.stay(plan.robot, last)]


@violation_rule(
    "plan/stops",
    "For each stop but the last, the plan has a visit to its resource that lasts at least its service: later than the "
    "visits that serve the stops before it, and before the last visit, which serves the last stop. The first visit may "
    "serve the first stop, and a robot may visit a stop's resource without serving it.",
    DESIGN,
)
def plan_serves_stops(instance: Instance, plan: Plan) -> Iterator[Breach]:
    *stops, _ = instance.robot[plan.robot].stops
    served = stops_served(stops, plan.visits[:-1])
    if served < len(stops):
        stop = stops[served]
        reason = f"it serves {served} of {len(stops) + 1} stops: no later visit to {stop.resource}"
        more = f" of at least {stop.service} ticks" if stop.service else ""
        yield of_robots([plan.robot], f"{reason}{more} comes before the last visit")


@violation_rule("plan/resource", "Every visit is to a resource of the graph.", DESIGN)
def plan_visits_resources(instance: Instance, plan: Plan) -> Iterator[Breach]:
    for visit in plan.visits:
        if visit.resource not in instance.graph.index:
            yield at_visit(plan.robot, visit, "the graph has no such resource")


@violation_rule(
    "plan/move",
    "Consecutive visits are joined by a move of the graph. To wait is to make a visit longer, not to add one.",
    "paper, section II",
)
def plan_follows_moves(instance: Instance, plan: Plan) -> Iterator[Breach]:
    for visit, following in pairwise(plan.visits):
        known = visit.resource in instance.graph.index and following.resource in instance.graph.index
        if known and (visit.resource, following.resource) not in instance.graph.moves:
            yield at_visit(plan.robot, following, f"the graph has no move to it from {visit.resource}")


@violation_rule("plan/contiguous", "Each visit enters at the tick at which the one before leaves.", MORS)
def plan_is_contiguous(instance: Instance, plan: Plan) -> Iterator[Breach]:
    del instance
    for visit, following in pairwise(plan.visits):
        if following.enter != visit.leave:
            left = "never left" if visit.leave is None else f"left at {visit.leave}"
            yield at_visit(plan.robot, following, f"it must enter when it leaves {visit.resource}, which is {left}")


@violation_rule(
    "plan/duration",
    "A visit lasts at least the resource's duration times the robot's pace; it may last longer, which is waiting.",
    f"paper, section II; {MORS}",
)
def plan_respects_durations(instance: Instance, plan: Plan) -> Iterator[Breach]:
    for visit in plan.visits:
        if visit.resource in instance.graph.index and visit.leave is not None:
            stay, least = visit.leave - visit.enter, instance.duration(plan.robot, visit.resource)
            if stay < least:
                yield at_visit(plan.robot, visit, f"it stays {stay} of at least {least} ticks")


PLAN_RULES: tuple[Rule[[Instance, Plan], Iterator[Violation]], ...] = (
    plan_starts_at_release,
    plan_ends_at_goal,
    plan_serves_stops,
    plan_visits_resources,
    plan_follows_moves,
    plan_is_contiguous,
    plan_respects_durations,
)


def plan_cost(instance: Instance, plan: Plan) -> int:
    """The ticks from the robot's release to the entry of the last visit; the plan must have a visit."""
    return plan.visits[-1].enter - instance.robot[plan.robot].release


def total_cost(instance: Instance, plans: Sequence[Plan]) -> int:
    """The sum of costs of the plans."""
    return sum(plan_cost(instance, plan) for plan in plans)


@rule(
    "cost/robot",
    "The cost of a plan is the tick at which it enters its last visit, minus the robot's release tick.",
    "paper, section IV (number of actions)",
)
def is_plan_cost(instance: Instance, plan: Plan, cost: int) -> bool:
    return cost == plan_cost(instance, plan)


@rule(
    "cost/total",
    "The total cost of a set of plans is the sum of their costs; a robot without a plan adds nothing.",
    "paper, section II",
)
def is_total_cost(instance: Instance, plans: Sequence[Plan], cost: int) -> bool:
    return cost == total_cost(instance, plans)


@violation_rule(
    "fleet/history",
    "A plan made again at the tick now keeps every visit entered by now: the last of them is entered at the same tick "
    "and left no earlier than now, those before it are unchanged. A plan whose last visit is left by now is unchanged.",
    DESIGN,
)
def plan_keeps_history(before: Plan, after: Plan, now: int) -> Iterator[Breach]:
    history = [visit for visit in before.visits if visit.enter <= now]
    for visit, again in zip_longest(history, after.visits[: len(history)]):
        ended = visit.leave is not None and visit.leave <= now
        is_kept = (
            again is not None
            and (again.resource, again.enter) == (visit.resource, visit.enter)
            and (again.leave == visit.leave if ended else again.leave is None or again.leave >= now)
        )
        if not is_kept:
            end = f"left at {visit.leave}" if ended else f"left no earlier than {now}"
            right = f"by {now} it was in {visit.resource}, entered at {visit.enter} and {end}"
            yield at_visit(before.robot, again or visit, right)
    if has_ended(before, now):
        for added in after.visits[len(history) :]:
            yield at_visit(before.robot, added, f"its plan had ended by {now}")


def has_ended(plan: Plan, now: int) -> bool:
    """Whether the robot has left the system by the tick now."""
    leave = plan.visits[-1].leave if plan.visits else None
    return leave is not None and leave <= now
