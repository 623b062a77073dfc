"""Logs: what robots did up to a tick, judged by the law with no plans behind it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from msgspec import structs

from carp_spec.check import MOST_LISTED
from carp_spec.execution.traces import Trace
from carp_spec.inputs.options import require_limits
from carp_spec.inputs.values import require_instance
from carp_spec.joint_rules import JOINT_RULES, solution_covers_robots
from carp_spec.model import Instance, Plan, ResourceId, RobotId, Solution
from carp_spec.plan_rules import PLAN_RULES, plan_ends_at_goal, plan_serves_stops, total_cost
from carp_spec.quick_check import breaks_no_rule, is_large
from carp_spec.refusal import Refusal
from carp_spec.rule import Violation
from carp_spec.shapes import require_shape


@dataclass(frozen=True, slots=True)
class Served:
    """A stop of a robot, by its position, and the visit that served it; the visit under way has a leave of `None`."""

    robot: RobotId
    stop: int
    resource: ResourceId
    enter: int
    leave: int | None


@dataclass(frozen=True, slots=True)
class LogVerdict:
    """The answer for a log: its violations, and the stops served.

    `done` robots are at their last stop or have left; `cost` is their total. The others are under way.
    """

    cost: int
    done: int
    violations: tuple[Violation, ...]
    served: tuple[Served, ...]

    @property
    def valid(self) -> bool:
        """Whether no rule is broken."""
        return not self.violations


def judge_log(instance: Instance, log: Trace, most: int | None = MOST_LISTED) -> LogVerdict:
    """Judge what robots did up to the tick `now` of a log, at most `most` violations of each rule (`None`: all).

    Robots keep the rules of plans, but need not have come to an end: only a robot that has left must have served its
    stops. One that does not appear was to be released later. Raises `Refusal` for a malformed instance or log, and for
    a log of what happens after `now`.
    """
    require_instance(instance)
    require_shape(log, Trace)
    require_limits(most=most)
    _require_past(log)
    named = {plan.robot for plan in log.plans}
    absent = tuple(robot for robot in instance.robot if robot not in named)
    plans = [plan for plan in log.plans if plan.robot in instance.robot]
    plans += [Plan(robot, ()) for robot in absent]
    there = [plan for plan in plans if plan.visits or instance.robot[plan.robot].release <= log.now]
    violations = [*islice(solution_covers_robots(instance, Solution(log.plans, (), absent)), most)]
    if not (is_large(there) and breaks_no_rule(instance, there, log.now)):
        violations += _violations(instance, there, log.now, most)
    served = tuple(each for plan in there for each in _served(instance, plan))
    last = {each.robot for each in served if each.stop == len(instance.robot[each.robot].stops) - 1}
    done = [
        each for each in there if each.robot in last and each.visits[-1].resource == instance.robot[each.robot].goal
    ]
    return LogVerdict(total_cost(instance, done), len(done), tuple(violations), served)


def _violations(instance: Instance, plans: Sequence[Plan], now: int, most: int | None) -> Iterator[Violation]:
    gone = [plan for plan in plans if plan.visits and plan.visits[-1].leave is not None]
    for of_plan in PLAN_RULES:
        of = gone if of_plan in (plan_ends_at_goal, plan_serves_stops) else plans
        yield from islice((violation for plan in of for violation in of_plan(instance, plan)), most)
    seen = [_until(plan, now) for plan in plans]
    for together in JOINT_RULES:
        yield from islice(together(instance, seen), most)


def _require_past(log: Trace) -> None:
    for number, plan in enumerate(log.plans):
        for place, visit in enumerate(plan.visits):
            if visit.enter > log.now or (visit.leave or 0) > log.now:
                message = f"nothing in a log happens after its tick {log.now}, and the visit has {visit.enter}"
                to = "" if visit.leave is None else f" to {visit.leave}"
                raise Refusal("document", f"$.plans[{number}].visits[{place}]", "log/now", message + to)


def _until(plan: Plan, now: int) -> Plan:
    """The plan, with the visit under way as far as it is known."""
    if not plan.visits or plan.visits[-1].leave is not None:
        return plan
    return replace(plan, visits=(*plan.visits[:-1], structs.replace(plan.visits[-1], leave=now + 1)))


def _served(instance: Instance, plan: Plan) -> Iterator[Served]:
    """The stops served, in order: each visit serves the next stop if it can, the one under way if it is there."""
    waiting: Sequence[tuple[int, ResourceId, int]] = [
        (place, stop.resource, stop.service) for place, stop in enumerate(instance.robot[plan.robot].stops)
    ]
    for visit in plan.visits:
        if not waiting:
            return
        place, resource, service = waiting[0]
        if visit.resource == resource and (visit.leave is None or visit.leave - visit.enter >= service):
            yield Served(plan.robot, place, resource, visit.enter, visit.leave)
            waiting = waiting[1:]
