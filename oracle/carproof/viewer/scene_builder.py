"""Makes the scene of a solution, a broken one too: numbers, labels, lanes, free windows, violations."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from carp_spec import Instance, Plan, ResourceId, RobotId, Solution, Violation, judge, plan_cost
from carp_spec.execution.execution_rules import trace_violations
from carp_spec.execution.traces import Trace
from carp_spec.inputs.values import require_instance, require_solution
from carp_spec.shapes import require_shape
from carp_spec.windows import Occupation, free_windows
from carproof.command_line.tables import printable
from carproof.formats.plans.services import stops_in
from carproof.layouts.lanes import lanes_of
from carproof.registry import RULES
from carproof.viewer.colours import LOOKS
from carproof.viewer.lanes import Area, Stays, area, lanes, lasts, occupations, slots, spots
from carproof.viewer.limits import MOST_LISTED, refuse_large_pictures
from carproof.viewer.names import common_start, cut, fitted, label, short_labels
from carproof.viewer.placement import Placement, placement
from carproof.viewer.plants import Lanes, outlines
from carproof.viewer.scene import Broken, BrokenRule, Mark, Outline, Place, Scene, Stand, Track

LONGEST_MESSAGE = 400
LONGEST_NAME = 24
MOST_NAMED = 200
LARGEST_MARK = 10


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
    lanes: Lanes
    placed: Placement
    number: Mapping[ResourceId, int]
    planned: Laid
    done: Laid
    stand: Mapping[tuple[ResourceId, int], int]

    def area(self, id: ResourceId) -> Area:
        """The part of a resource's square that robots are drawn in."""
        resource = self.instance.graph.resource.get(id)
        has_traits = resource is not None and (resource.capacity, resource.duration) != (1, 1)
        return area(is_named=self.is_named and not self.lanes, has_traits=has_traits and id not in self.lanes)

    @property
    def is_named(self) -> bool:
        """Whether the map has few enough resources for their names; lanes have none there."""
        return len(self.instance.graph.resources) - len(self.lanes) <= MOST_NAMED


def make_scene(instance: Instance, plans: Solution | None, title: str, trace: Trace | None = None) -> Scene:
    """Judge a solution and work out its scene; raises `Refusal` where it is too large to show.

    Without a solution the scene has the starts and goals alone. With a trace of what has happened, a solution that
    breaks no rule is shown with the rules that the trace breaks.
    """
    if plans is None:
        require_instance(instance)
    else:
        require_solution(instance, plans)
    if trace is not None:
        require_shape(trace, Trace)
    solution = Solution((), (), tuple(instance.robot)) if plans is None else plans
    refuse_large_pictures(instance, solution, trace)
    stage = make_stage(instance, solution, trace)
    verdict = judge(instance, solution, most=None)
    broken = verdict.violations
    if trace is not None and verdict.valid:
        broken = trace_violations(instance, solution, trace, most=None)
    robots = tuple(robots_with_plans(stage))
    first, last = span(instance, solution, trace)
    start = common_start([label(id) for id in instance.graph.index if id not in stage.lanes])
    return Scene(
        title=label(title),
        first=first,
        last=last,
        now=None if trace is None else trace.now,
        gap=instance.gap,
        cost=str(verdict.cost),
        unplanned=verdict.unplanned,
        alone=plans is None,
        computed=stage.placed.computed,
        named=stage.is_named,
        start=start,
        width=stage.placed.width,
        height=stage.placed.height,
        looks=LOOKS,
        places=tuple(places(stage, start)),
        stands=tuple(stands(stage)),
        outlines=tuple(
            Outline(label(id), tuple(corners))
            for id, corners in outlines(instance, stage.lanes, stage.placed.points, stage.placed.ways)
        ),
        tracks=tuple(tracks(stage, robots, is_alone=plans is None)),
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
    lanes = lanes_of(instance)
    return Stage(instance, solution, lanes, placement(instance.graph, lanes), number, planned, done, stand)


def laid(plans: tuple[Plan, ...]) -> Laid:
    """Give every visit of the plans its lane."""
    stays = occupations(plans)
    lane: dict[tuple[int, int], int] = {}
    for visits in stays.values():
        of_visits = lanes([occupation for _, _, occupation in visits])
        lane.update({(plan, visit): each for (plan, visit, _), each in zip(visits, of_visits, strict=True)})
    return Laid(plans, stays, lane)


def span(instance: Instance, solution: Solution, trace: Trace | None = None) -> tuple[int, int]:
    """The first and the last tick at which something happens; tick 0 is always shown."""
    plans = solution.plans if trace is None else solution.plans + trace.plans
    visits = [visit for plan in plans for visit in plan.visits]
    ticks = [0, *(robot.release for robot in instance.robots), *(visit.enter for visit in visits)]
    ticks.extend(visit.leave for visit in visits if visit.leave is not None)
    return min(ticks), max(*ticks, 1, 0 if trace is None else trace.now)


def places(stage: Stage, start: str) -> Iterator[Place]:
    """The resources as they are drawn, with their free windows."""
    names = fitted([without_start(stage, id, start) for id in stage.number], LONGEST_NAME)
    groups = stays_in_groups(stage)
    for id, name in zip(stage.number, names, strict=True):
        resource = stage.instance.graph.resource.get(id)
        yield Place(
            label=label(id),
            name=name,
            capacity="" if resource is None else label(resource.capacity),
            duration="" if resource is None else label(resource.duration),
            at=stage.placed.points.get(id),
            lanes=max(1, stage.planned.lane_count(id)),
            lanes_done=stage.done.lane_count(id),
            windows=() if resource is None else free_of(stage, id, groups),
            way=stage.placed.ways.get(id),
        )


def without_start(stage: Stage, id: ResourceId, start: str) -> str:
    """The label without the start of all labels; that of a lane without the starts of the labels of its ends too."""
    name = label(id)
    for end in stage.lanes.get(id, ()) if start else ():
        whole = label(end)
        if whole.startswith(start):
            name = name.replace(whole, whole.removeprefix(start))
    return name.removeprefix(start)


def free_of(stage: Stage, id: ResourceId, groups: Mapping[int, Sequence[Occupation]]) -> tuple[Occupation, ...]:
    """The free windows of a resource: there is room in it, and in its groups."""
    graph = stage.instance.graph
    own = [occupation for _, _, occupation in stage.planned.stays.get(id, [])]
    limits = [(groups.get(each, ()), graph.groups[each].capacity) for each in graph.groups_of.get(id, ())]
    windows = free_windows([(own, graph.resource[id].capacity), *limits], stage.instance.gap)
    return tuple((window.start, window.end) for window in windows)


def stays_in_groups(stage: Stage) -> Mapping[int, Sequence[Occupation]]:
    """The stays in each group; a robot that moves within it stays there."""
    found: dict[int, list[Occupation]] = {}
    for plan in stage.planned.plans:
        before: set[int] = set()
        for visit in plan.visits:
            is_there = lasts(visit.enter, visit.leave)
            groups = stage.instance.graph.groups_of.get(visit.resource, ()) if is_there else ()
            for each in groups:
                stays = found.setdefault(each, [])
                enter = stays.pop()[0] if each in before and stays[-1][1] == visit.enter else visit.enter
                stays.append((enter, visit.leave))
            before = set(groups)
    return found


def stands(stage: Stage) -> Iterator[Stand]:
    """Where robots are drawn: every lane that is in use."""
    counts = Counter(id for id, _ in stage.stand)
    for id, count in counts.items():
        centre = stage.placed.points.get(id)
        for lane, spot in enumerate(spots(stage.instance.graph.resource.get(id), count, stage.area(id))):
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


def marks(stage: Stage, robots: Sequence[RobotId], *, is_alone: bool) -> Mapping[tuple[RobotId, int], Mark]:
    """Where the stops of the robots are drawn, by their number, and as -1 their starts.

    Those of one resource are side by side, and a robot has each place once.
    """
    of_place: dict[ResourceId, list[tuple[RobotId, int]]] = {}
    for id in dict.fromkeys(robots):
        if id in stage.instance.robot:
            robot = stage.instance.robot[id]
            last = {stop.resource: number for number, stop in enumerate(robot.stops)}
            for place, number in reversed(last.items()):
                of_place.setdefault(place, []).append((id, number))
            of_place.setdefault(robot.start, []).append((id, -1))
    found: dict[tuple[RobotId, int], Mark] = {}
    for place, here in of_place.items():
        if place in stage.placed.points:
            x, y = stage.placed.points[place]
            around = slots(len(here), stage.area(place), LARGEST_MARK)
            for (id, number), spot in zip(here, around, strict=True):
                half = spot.radius if number >= 0 or is_alone else max(1, spot.radius * 3 // 5)
                found[id, number] = Mark(x + spot.dx, y + spot.dy, half)
    return found


def tracks(stage: Stage, robots: tuple[tuple[RobotId, int | None], ...], *, is_alone: bool) -> Iterator[Track]:
    """The robots as they are drawn and listed."""
    found = marks(stage, [robot for robot, _ in robots], is_alone=is_alone)
    shorts = short_labels([label(robot) for robot, _ in robots])
    plan_count = Counter(plan.robot for plan in stage.solution.plans)
    happened = {plan.robot: at for at, plan in enumerate(stage.done.plans)}
    for at, (id, at_plan) in enumerate(robots):
        robot = stage.instance.robot.get(id)
        stops = () if robot is None else robot.stops
        plan = None if at_plan is None else stage.solution.plans[at_plan]
        at_done = happened.get(id)
        done = None if at_done is None else stage.done.plans[at_done]
        known = None if robot is None or plan is None or not plan.visits else plan
        yield Track(
            label=label(id),
            short=shorts[at],
            look=at % len(LOOKS),
            start=None if robot is None else stage.number[robot.start],
            goal=None if robot is None else stage.number[robot.goal],
            start_mark=found.get((id, -1)),
            goal_mark=found.get((id, len(stops) - 1)),
            stops=tuple((stage.number[each.resource], each.service) for each in stops),
            stop_marks=tuple(found[id, number] for number in range(len(stops) - 1) if (id, number) in found),
            services=() if known is None else tuple(services(stage.instance, known)),
            release=0 if robot is None else robot.release,
            pace="" if robot is None else label(robot.pace),
            cost=None if known is None else plan_cost(stage.instance, known),
            note="" if is_alone else note(robot is not None, plan, plan_count[id], done),
            stays=tuple(stays_of(stage, stage.planned, at_plan)),
            done=tuple(stays_of(stage, stage.done, at_done)),
        )


def services(instance: Instance, plan: Plan) -> Iterator[tuple[int, int]]:
    """The ticks of services, each as soon as the robot is there."""
    for place, number in stops_in(instance, plan).items():
        service, enter = instance.robot[plan.robot].stops[number].service, plan.visits[place].enter
        if service:
            yield enter, enter + service


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
    plans: dict[RobotId, list[Plan]] = {}
    for plan in stage.solution.plans:
        plans.setdefault(plan.robot, []).append(plan)
    for each in broken[:MOST_LISTED]:
        yield Broken(
            rule=rules.index(each.rule),
            tracks=tuple(number for robot in each.robots for number in numbers[robot]),
            places=tuple(dict.fromkeys(stage.number[id] for id in places_of(each, plans))),
            start=each.start,
            end=each.end,
            message=cut(printable(each.message), LONGEST_MESSAGE),
        )


def places_of(broken: Violation, plans: Mapping[RobotId, Sequence[Plan]]) -> Iterator[ResourceId]:
    """The resource of a violation; of an exchange all between which its robots move at its tick."""
    if broken.resource is not None:
        yield broken.resource
    if broken.rule == "joint/exchange":
        for plan in (plan for robot in broken.robots for plan in plans.get(robot, [])):
            for one, other in pairwise(plan.visits):
                if one.leave == other.enter == broken.start:
                    yield from (one.resource, other.resource)
