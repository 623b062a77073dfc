"""Makes the scene of a solution, a broken one too: numbers, labels, lanes, free windows, violations."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from carp_spec import Instance, Plan, ResourceId, RobotId, Solution, Violation, judge, plan_cost
from carp_spec.execution_rules import trace_violations
from carp_spec.traces import Trace
from carp_spec.windows import free_windows
from carproof.registry import RULES
from carproof.tables import printable
from carproof.viewer.lanes import Stays, lanes, occupations, spots
from carproof.viewer.limits import MOST_LISTED, refuse_large_pictures
from carproof.viewer.placement import Placement, placement
from carproof.viewer.scene import Broken, BrokenRule, Place, Scene, Stand, Track

LONGEST_LABEL = 60
LONGEST_MESSAGE = 400
LONGEST_SHORT = 4
TINTS = 6


@dataclass(frozen=True, slots=True)
class Laid:
    """Plans whose visits are in lanes; `lane` is that of a visit, named by the index of its plan and its own."""

    plans: tuple[Plan, ...]
    stays: Mapping[ResourceId, Stays]
    lane: Mapping[tuple[int, int], int]

    def lane_count(self, id: ResourceId) -> int:
        """How many lanes a resource needs."""
        return 1 + max((self.lane[plan, visit] for plan, visit, _ in self.stays.get(id, [])), default=-1)


@dataclass(frozen=True, slots=True)
class Stage:
    """A solution with its resources numbered, those unknown to the instance last, and its visits in lanes.

    So are the visits that have happened, if there is a trace. `stand` numbers the lanes in use.
    """

    instance: Instance
    solution: Solution
    trace: Trace | None
    placed: Placement
    number: Mapping[ResourceId, int]
    planned: Laid
    done: Laid
    stand: Mapping[tuple[ResourceId, int], int]


def make_scene(instance: Instance, solution: Solution, title: str, trace: Trace | None = None) -> Scene:
    """Judge a solution and work out its scene; raises `Refusal` where it is too large to show.

    With a trace of what has happened, a solution that breaks no rule is shown with the rules that the trace breaks.
    """
    refuse_large_pictures(instance, solution, trace)
    stage = make_stage(instance, solution, trace)
    verdict = judge(instance, solution, most=None)
    broken = verdict.violations
    if trace is not None and verdict.valid:
        broken = trace_violations(instance, solution, trace, most=None)
    robots = tuple(robots_with_plans(stage))
    first, last = span(stage)
    return Scene(
        title=label(title),
        first=first,
        last=last,
        now=None if trace is None else trace.now,
        gap=instance.gap,
        cost=str(verdict.cost),
        unplanned=verdict.unplanned,
        computed=stage.placed.computed,
        width=stage.placed.width,
        height=stage.placed.height,
        places=tuple(places(stage)),
        stands=tuple(stands(stage)),
        tracks=tuple(tracks(stage, robots)),
        rules=broken_rules(broken),
        violations=tuple(violations(stage, broken, [robot for robot, _ in robots])),
    )


def make_stage(instance: Instance, solution: Solution, trace: Trace | None) -> Stage:
    """Number the resources and give every visit its lane."""
    planned, done = laid(solution.plans), laid(() if trace is None else trace.plans)
    visited = dict.fromkeys(visit.resource for plan in planned.plans + done.plans for visit in plan.visits)
    number = {id: at for at, id in enumerate(dict.fromkeys([*instance.graph.index, *visited]))}
    in_use = [(id, lane) for id in visited for lane in range(max(1, planned.lane_count(id), done.lane_count(id)))]
    stand = {each: at for at, each in enumerate(in_use)}
    return Stage(instance, solution, trace, placement(instance.graph), number, planned, done, stand)


def laid(plans: tuple[Plan, ...]) -> Laid:
    """Give every visit of the plans its lane."""
    stays = occupations(plans)
    lane: dict[tuple[int, int], int] = {}
    for visits in stays.values():
        of_visits = lanes([occupation for _, _, occupation in visits])
        lane.update({(plan, visit): each for (plan, visit, _), each in zip(visits, of_visits, strict=True)})
    return Laid(plans, stays, lane)


def span(stage: Stage) -> tuple[int, int]:
    """The first and the last tick at which something happens; tick 0 is always shown."""
    visits = [visit for plan in stage.planned.plans + stage.done.plans for visit in plan.visits]
    ticks = [0, *(robot.release for robot in stage.instance.robots), *(visit.enter for visit in visits)]
    ticks.extend(visit.leave for visit in visits if visit.leave is not None)
    return min(ticks), max(*ticks, 1, 0 if stage.trace is None else stage.trace.now)


def places(stage: Stage) -> Iterator[Place]:
    """The resources as they are drawn, with their free windows."""
    for id in stage.number:
        resource = stage.instance.graph.resource.get(id)
        stays = stage.planned.stays.get(id, [])
        yield Place(
            label=label(id),
            capacity="" if resource is None else label(resource.capacity),
            duration="" if resource is None else label(resource.duration),
            at=stage.placed.points.get(id),
            lanes=max(1, stage.planned.lane_count(id)),
            lanes_done=stage.done.lane_count(id),
            windows=() if resource is None else free_of(resource.capacity, stays),
        )


def free_of(capacity: int, stays: Stays) -> tuple[tuple[int, int | None], ...]:
    """The free windows of a resource."""
    windows = free_windows([occupation for _, _, occupation in stays], capacity)
    return tuple((window.start, window.end) for window in windows)


def stands(stage: Stage) -> Iterator[Stand]:
    """Where robots are drawn: every lane that is in use."""
    counts = Counter(id for id, _ in stage.stand)
    for id, count in counts.items():
        centre = stage.placed.points.get(id)
        for lane, spot in enumerate(spots(stage.instance.graph.resource.get(id), count)):
            at = None if centre is None else (centre[0] + spot.dx, centre[1] + spot.dy)
            yield Stand(stage.number[id], lane, at, spot.radius)


def robots_with_plans(stage: Stage) -> Iterator[tuple[RobotId, int | None]]:
    """Every robot that is named, with the index of each of its plans, or once with none."""
    solution = stage.solution
    plans: dict[RobotId, list[int]] = {}
    for at, plan in enumerate(solution.plans):
        plans.setdefault(plan.robot, []).append(at)
    happened = [plan.robot for plan in stage.done.plans]
    for robot in dict.fromkeys([*stage.instance.robot, *plans, *solution.order, *solution.unplanned, *happened]):
        yield from ((robot, at) for at in plans.get(robot, [None]))


def tracks(stage: Stage, robots: tuple[tuple[RobotId, int | None], ...]) -> Iterator[Track]:
    """The robots as they are drawn and listed."""
    shorts = short_labels([label(robot) for robot, _ in robots])
    plan_count = Counter(plan.robot for plan in stage.solution.plans)
    happened = {plan.robot: at for at, plan in enumerate(stage.done.plans)}
    for at, (id, at_plan) in enumerate(robots):
        robot = stage.instance.robot.get(id)
        plan = None if at_plan is None else stage.solution.plans[at_plan]
        at_done = happened.get(id)
        done = None if at_done is None else stage.done.plans[at_done]
        known = robot is not None and plan is not None and plan.visits
        yield Track(
            label=label(id),
            short=shorts[at],
            tint=at % TINTS,
            start=None if robot is None else stage.number[robot.start],
            goal=None if robot is None else stage.number[robot.goal],
            release=0 if robot is None else robot.release,
            pace="" if robot is None else label(robot.pace),
            cost=plan_cost(stage.instance, plan) if known and plan is not None else None,
            note=note(robot is not None, plan, plan_count[id], done),
            stays=tuple(stays_of(stage, stage.planned, at_plan)),
            done=tuple(stays_of(stage, stage.done, at_done)),
        )


def note(known: bool, plan: Plan | None, plans: int, done: Plan | None) -> str:
    """The remark about a robot beyond its plan; it is late by the ticks of the last visit that it has entered."""
    if not known:
        return "not in the instance"
    if plan is None:
        return "unplanned"
    if plans > 1:
        return f"one of {plans} plans"
    entered = list(zip(plan.visits, () if done is None else done.visits, strict=False))
    late = entered[-1][1].enter - entered[-1][0].enter if entered else 0
    return f"late by {late}" if late > 0 else ""


def stays_of(stage: Stage, laid: Laid, at_plan: int | None) -> Iterator[tuple[int, int, int | None]]:
    """The visits of a plan as stays at stands; one that takes no time is in the first lane."""
    if at_plan is None:
        return
    for at, visit in enumerate(laid.plans[at_plan].visits):
        lane = laid.lane.get((at_plan, at), 0)
        yield (stage.stand[visit.resource, lane], visit.enter, visit.leave)


def broken_rules(broken: Sequence[Violation]) -> tuple[BrokenRule, ...]:
    """The rules that are broken, in the order of the registry."""
    count = Counter(violation.rule for violation in broken)
    return tuple(BrokenRule(rule.id, rule.statement, count[rule.id]) for rule in RULES if rule.id in count)


def violations(stage: Stage, broken: Sequence[Violation], robots: list[RobotId]) -> Iterator[Broken]:
    """The violations, the first ones of all."""
    rules = [rule.id for rule in broken_rules(broken)]
    numbers: dict[RobotId, list[int]] = {}
    for at, robot in enumerate(robots):
        numbers.setdefault(robot, []).append(at)
    for each in broken[:MOST_LISTED]:
        yield Broken(
            rule=rules.index(each.rule),
            tracks=tuple(number for robot in each.robots for number in numbers[robot]),
            place=None if each.resource is None else stage.number[each.resource],
            start=each.start,
            end=each.end,
            message=cut(printable(each.message), LONGEST_MESSAGE),
        )


def label(value: object) -> str:
    """A value as one short line that can be shown."""
    return cut(printable(value), LONGEST_LABEL)


def cut(text: str, longest: int) -> str:
    """The text, without its middle if it is too long."""
    half = longest // 2
    return text if len(text) <= longest else f"{text[:half]}…{text[-half:]}"


def short_labels(labels: list[str]) -> list[str]:
    """Labels that fit on a robot: the number at the end of one, if no other has it, or the end of a long one."""
    numbers = [each[len(each.rstrip("0123456789")) :][-LONGEST_SHORT:] for each in labels]
    count = Counter(numbers)
    tails = [each if len(each) <= LONGEST_SHORT else f"…{each[-LONGEST_SHORT + 1 :]}" for each in labels]
    return [number if number and count[number] == 1 else tails[at] for at, number in enumerate(numbers)]
