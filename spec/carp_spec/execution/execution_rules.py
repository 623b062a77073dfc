"""The rules of an execution, `trace/...` and `execution/...`: a trace that keeps them follows a lawful solution.

Those of `execution/...` require a trace that keeps `trace/...`.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice, product
from operator import itemgetter

from carp_spec.check import MOST_LISTED
from carp_spec.execution.dependencies import Node, Stay, dependencies, shortest_cycle, stays_by_constraint
from carp_spec.execution.traces import Trace
from carp_spec.joint_rules import misnamed
from carp_spec.model import Instance, Plan, RobotId, Solution, Visit
from carp_spec.plan_rules import least_stays, plan_ends_at_goal, plan_starts_at_release
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, Breach, Rule, Violation, at_visit, interval, violation_rule

ADG = "Hönig et al. 2019, action dependency graph; ter Mors 2010"


@violation_rule("trace/robots", "A trace names each robot that has a plan exactly once, and no other.", DESIGN)
def trace_names_robots(instance: Instance, solution: Solution, trace: Trace) -> Iterator[Breach]:
    del instance
    return misnamed("trace", (plan.robot for plan in trace.plans), solution)


@violation_rule(
    "trace/prefix", "The resources that a robot has visited are the first ones of its plan, in their order.", DESIGN
)
def trace_is_prefix(instance: Instance, solution: Solution, trace: Trace) -> Iterator[Breach]:
    del instance
    for plan, done in _pairs(solution, trace):
        for place, visit in enumerate(done.visits):
            if place >= len(plan.visits):
                yield at_visit(plan.robot, visit, "its plan has ended before")
            elif visit.resource != plan.visits[place].resource:
                yield at_visit(plan.robot, visit, f"visit {place} of its plan is to {plan.visits[place].resource}")


@violation_rule(
    "trace/ticks",
    "A robot enters its first visit at its release or later, and each other visit at the tick at which it leaves the "
    "visit before. No visit is left before it is entered, and nothing happens after the tick now. Only the last "
    "visit of a plan is left for good; with `park` no visit is.",
    DESIGN,
)
def trace_keeps_time(instance: Instance, solution: Solution, trace: Trace) -> Iterator[Breach]:
    for plan, done in _pairs(solution, trace):
        release = instance.robot[plan.robot].release
        stays = len(done.visits) < len(plan.visits) or instance.after_goal == "park"
        due: int | None = None
        for place, visit in enumerate(done.visits):
            if place == 0 and visit.enter < release:
                yield at_visit(plan.robot, visit, f"it must enter at its release {release} or later")
            elif place > 0 and visit.enter != due:
                left = "never" if due is None else f"at {due}"
                yield at_visit(plan.robot, visit, f"it must enter when it leaves the visit before, {left}")
            elif visit.enter > trace.now or (visit.leave is not None and not visit.enter <= visit.leave <= trace.now):
                right = f"the trace ends at {trace.now}, and no visit is left before it is entered"
                yield at_visit(plan.robot, visit, right)
            elif stays and visit is done.visits[-1] and visit.leave is not None:
                yield at_visit(plan.robot, visit, "it must be left by entering the next visit, or never")
            due = visit.leave


@violation_rule(
    "execution/duration",
    "A visit that is left has lasted at least the resource's duration times the pace, and at least the service of the "
    "stop that the plan serves in it.",
    ADG,
)
def durations_are_kept(instance: Instance, solution: Solution, trace: Trace) -> Iterator[Breach]:
    for plan, done in _pairs(solution, trace):
        for visit, least in zip(done.visits, least_stays(instance, plan), strict=False):
            if visit.leave is not None and visit.leave - visit.enter < least:
                yield at_visit(plan.robot, visit, f"it stayed {visit.leave - visit.enter} of at least {least} ticks")


@violation_rule(
    "execution/order",
    "A robot enters a resource, or a group from outside, only after every robot has left it that is planned to have "
    "left it by then; where following is forbidden, at least a tick after.",
    ADG,
)
def order_is_kept(instance: Instance, solution: Solution, trace: Trace) -> Iterator[Breach]:
    happened = trace.happened
    for stays in stays_by_constraint(instance.graph, solution.plans).values():
        yield from _too_early(stays, stays, happened, instance.gap, instance.gap)


@violation_rule(
    "execution/exchange",
    "Of two moves that are planned at different ticks, (r, s) and (s', r') with r close to r' and s to s', the first "
    "is made at an earlier tick than the second.",
    ADG,
)
def exchange_order_is_kept(instance: Instance, solution: Solution, trace: Trace) -> Iterator[Breach]:
    areas, happened = instance.graph.areas_of, trace.happened
    leaving: dict[tuple[int, int], list[Stay]] = defaultdict(list)
    entering: dict[tuple[int, int], list[Stay]] = defaultdict(list)
    for constraint, stays in stays_by_constraint(instance.graph, solution.plans).items():
        for stay in stays if constraint < len(instance.graph.resources) else ():
            here = areas(stay.visit.resource)
            for ways, neighbour in ((leaving, stay.target), (entering, stay.source)):
                for way in () if neighbour is None else product(here, areas(neighbour)):
                    ways[way].append(stay)
    found = (_too_early(stays, entering.get(way, ()), happened, 1, 1) for way, stays in leaving.items())
    yield from dict.fromkeys(breach for breaches in found for breach in breaches)


def _too_early(
    leaving: Sequence[Stay], entering: Sequence[Stay], happened: Mapping[Node, Visit], planned: int, least: int
) -> Iterator[Breach]:
    """The robots that entered too early: another, planned to be `planned` ticks ahead, was less than `least` ahead.

    Of the robots that should have left, the violation names the one that left last.
    """
    left = sorted(((stay.visit.leave, stay) for stay in leaving if stay.visit.leave is not None), key=itemgetter(0))
    last: Stay | None = None
    last_left: int | None = -1
    place = 0
    for stay in sorted(entering, key=lambda stay: stay.visit.enter):
        while place < len(left) and left[place][0] + planned <= stay.visit.enter:
            done = happened.get(left[place][1].last)
            leave = None if done is None else done.leave
            if last_left is not None and (leave is None or leave > last_left):
                last, last_left = left[place][1], leave
            place += 1
        entered = happened.get(stay.node)
        if last is not None and entered is not None and (last_left is None or last_left + least > entered.enter):
            when = "has not left" if last_left is None else f"left at {last_left}"
            planned_in = interval(last.visit.enter, last.visit.leave)
            reason = f"by the plans robot {last.node[0]} leaves first, in {planned_in}, and {when}"
            yield at_visit(stay.node[0], entered, reason)


@violation_rule(
    "execution/acyclic",
    "The dependency graph of a solution has no cycle: at no tick do robots enter each other's places in a circle (a "
    "rotation).",
    ADG,
)
def is_acyclic(instance: Instance, solution: Solution) -> Iterator[Breach]:
    cycle = shortest_cycle(dependencies(instance, solution.plans))
    if cycle:
        robot, place = cycle[0].after
        tick = next(plan.visits[place].enter for plan in solution.plans if plan.robot == robot)
        reason = f"each enters as the next one leaves: {', '.join(str(edge.resource) for edge in cycle)}"
        yield tuple(edge.after[0] for edge in cycle), cycle[0].resource, tick, tick + 1, reason


TRACE_RULES: tuple[Rule[[Instance, Solution, Trace], Iterator[Violation]], ...] = (
    trace_names_robots,
    trace_is_prefix,
    trace_keeps_time,
)
EXECUTION_RULES: tuple[Rule[[Instance, Solution, Trace], Iterator[Violation]], ...] = (
    durations_are_kept,
    order_is_kept,
    exchange_order_is_kept,
)


def trace_violations(
    instance: Instance, solution: Solution, trace: Trace, most: int | None = MOST_LISTED
) -> tuple[Violation, ...]:
    """Where the trace does not follow the solution, at most the first `most` of each rule."""
    for rules in (TRACE_RULES, EXECUTION_RULES):
        violations = [violation for each in rules for violation in islice(each(instance, solution, trace), most)]
        if violations:
            return tuple(violations)
    return ()


def require_followed(instance: Instance, solution: Solution, trace: Trace) -> None:
    """Raise `Refusal` if the trace does not follow the lawful solution."""
    for violation in trace_violations(instance, solution, trace, most=1):
        raise _refusal(trace, violation.robots[0], violation.rule, violation.message)


def require_lawful_ends(instance: Instance, after: Solution, trace: Trace) -> None:
    """Raise `Refusal` where a plan that keeps the trace appears late, or stays too long at its goal."""
    happened = trace.happened
    for plan in after.plans:
        for violation in (*plan_starts_at_release(instance, plan), *plan_ends_at_goal(instance, plan)):
            message = f"no plan can have this history: {violation.message}"
            raise _refusal(trace, plan.robot, violation.rule, message)
        due = plan.visits[-1].leave
        left = happened.get((plan.robot, len(plan.visits) - 1), plan.visits[-1]).leave
        if due is not None and left != due and (left is not None or due <= trace.now):
            message = f"no plan can have this history: robot {plan.robot} must leave its goal at {due}"
            raise _refusal(trace, plan.robot, plan_ends_at_goal.id, message)


def _refusal(trace: Trace, robot: RobotId, rule: str, message: str) -> Refusal:
    places = [f"[{place}]" for place, plan in enumerate(trace.plans) if plan.robot == robot]
    return Refusal("document", f"$.plans{''.join(places[:1])}", rule, message)


def _pairs(solution: Solution, trace: Trace) -> Iterator[tuple[Plan, Plan]]:
    """Each robot's plan with what it has done."""
    plans = {plan.robot: plan for plan in solution.plans}
    for done in trace.plans:
        if done.robot in plans:
            yield plans[done.robot], done
