"""Planners with a bug each that shows only beyond a size or a number, and the table of when `conform` finds them.

`python -m tests.oracle.conform.asking.planted` prints the table.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from msgspec import structs
from tests.oracle.conform.judging.test_judges import Tampered, as_it_is, right_reply

from carp_spec import Carp, Instance, Plan, Resource, Robot, Solution, Visit
from carproof.conform.answers import Reply
from carproof.conform.cases import Case
from carproof.conform.judging.claims import EVERYTHING, Claims
from carproof.conform.levels import Level
from carproof.conform.run import Options, Report, conform
from carproof.engines import engine_named
from carproof.protocol.ops.planning import QueryDocument, query_document

BIT_15, BIT_31 = 2**15, 2**31
Tamper = Callable[[Case], Reply]


@dataclass(frozen=True)
class Bug:
    """A bug, beyond what it shows, in which op, the level that it breaks, and its answers; `None` where it is right."""

    what: str
    beyond: str
    op: str
    level: Level
    answer: Callable[[Case], Reply | None]
    claims: Claims = EVERYTHING


class Planted(Tampered):
    """A planner that is right but for a bug."""

    def __init__(self, bug: Bug) -> None:
        super().__init__(as_it_is, (bug.op,))
        self.bug = bug

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        del seconds
        answer: Reply = self.bug.answer(case) or right_reply(case, None)
        return answer


def alone(case: Case) -> Solution:
    """Each robot planned as if there were no other."""
    plans = [engine_named(None).query(case.instance, (), robot) for robot in case.instance.robot]
    return Solution.of(case.instance, [plan for plan in plans if plan is not None])


def believing(
    resource: Callable[[Resource], Resource] = lambda each: each, robot: Callable[[Robot], Robot] = lambda each: each
) -> Callable[[Case], Reply | None]:
    """Plans of an instance whose resources and robots are taken for others."""

    def answer(case: Case) -> Reply | None:
        graph = case.instance.graph
        believed = Instance(
            replace(graph, resources=tuple(map(resource, graph.resources))),
            tuple(map(robot, case.instance.robots)),
            case.instance.after_goal,
        )
        return None if believed == case.instance else engine_named(None).plan(believed, case.planner or Carp())

    return answer


def makespan(case: Case) -> int:
    return max((plan.visits[-1].enter for plan in rightly_planned(case).plans), default=0)


def rightly_planned(case: Case) -> Solution:
    return engine_named(None).plan(case.instance, Carp())


def with_visits(case: Case, change: Callable[[Visit], Visit]) -> Solution | None:
    """The right plans with changed visits; `None` if no visit is another one then."""
    solution = rightly_planned(case)
    plans = tuple(Plan(plan.robot, tuple(map(change, plan.visits))) for plan in solution.plans)
    return replace(solution, plans=plans) if plans != solution.plans else None


def short_ticks(case: Case) -> Reply | None:
    """Ticks of 16 bits."""

    def cut(tick: int) -> int:
        return (tick + BIT_15) % (2 * BIT_15) - BIT_15

    return with_visits(case, lambda v: Visit(v.resource, cut(v.enter), None if v.leave is None else cut(v.leave)))


def short_ids(case: Case) -> Reply | None:
    """Ids of resources of 32 bits."""

    def cut(visit: Visit) -> Visit:
        id = visit.resource
        return structs.replace(visit, resource=id % BIT_31) if isinstance(id, int) else visit

    return with_visits(case, cut)


def gives_up_late(case: Case) -> Reply | None:
    """A search that ends 500 ticks after the release."""
    reply = right_reply(case, None)
    assert isinstance(reply, QueryDocument)
    robot = case.instance.robot[case.asked_robot]
    return QueryDocument(None) if reply.plan is not None and reply.plan[-1][1] > robot.release + 500 else None


def waits(case: Case) -> Reply | None:
    """A plan that starts a tick later than it could, beyond 40 committed plans."""
    reply = right_reply(case, None)
    assert isinstance(reply, QueryDocument)
    if len(case.solution.plans) <= 40 or case.now or reply.plan is None or len(reply.plan) < 2:
        return None
    robot = case.instance.robot[case.asked_robot]
    delayed = tuple(replace(r, release=r.release + 1) if r.id == robot.id else r for r in case.instance.robots)
    plan = engine_named(None).query(replace(case.instance, robots=delayed), case.solution.plans, robot.id)
    if plan is None:
        return None
    first, *rest = plan.visits
    return query_document(Plan(plan.robot, (structs.replace(first, enter=robot.release), *rest)))


def arrives_only(case: Case) -> Reply | None:
    """The goal is kept free only at the arrival."""
    graph, robot = case.instance.graph, case.instance.robot[case.asked_robot]
    short = tuple(replace(each, duration=1) if each.id == robot.goal else each for each in graph.resources)
    believed = replace(case.instance, graph=replace(graph, resources=short), after_goal="vanish")
    if len(case.others) < len(case.solution.plans) or case.now:
        return None
    plan = engine_named(None).find(believed, case.others, robot.id)
    if plan is None:
        return None
    *visits, last = plan.visits
    leave = None if case.instance.after_goal == "park" else last.enter + case.instance.duration(robot.id, robot.goal)
    return query_document(Plan(plan.robot, (*visits, structs.replace(last, leave=leave))))


def early(robot: Robot) -> Robot:
    return replace(robot, release=min(robot.release, 10**5))


def hasty(robot: Robot) -> Robot:
    return replace(robot, pace=min(robot.pace, 3))


def short_services(robot: Robot) -> Robot:
    return replace(robot, stops=tuple(replace(stop, service=min(stop.service, 5)) for stop in robot.stops))


def beyond(measure: Callable[[Case], int], most: int, wrongly: Tamper) -> Callable[[Case], Reply | None]:
    return lambda case: wrongly(case) if measure(case) > most else None


def robots(case: Case) -> int:
    return len(case.instance.robots)


def resources(case: Case) -> int:
    return len(case.instance.graph.resources)


def others_lost(case: Case) -> Reply:
    """An added robot is planned as if there were no other."""
    plan = engine_named(None).query(case.instance, (), case.asked_robot, case.now)
    plans = case.solution.plans if plan is None else (*case.solution.plans, plan)
    return Solution.of(case.instance, plans)


def any_order(case: Case) -> Reply:
    """The right plans of robots in another order."""
    turned = replace(case.instance, robots=case.instance.robots[::-1])
    return engine_named(None).plan(turned, Carp())


def capacities_beyond(most: int) -> Callable[[Case], Reply | None]:
    return believing(resource=lambda each: replace(each, capacity=10**6) if each.capacity > most else each)


def durations_up_to(most: int) -> Callable[[Case], Reply | None]:
    return believing(resource=lambda each: replace(each, duration=min(each.duration, most)))


BUDGETS = (0.0, 1.0, 3.0, 10.0, 30.0, 100.0)
"""Seconds for large cases; without any, smoke cases, vectors and random cases alone are asked."""
SOUND, OPTIMAL = Level.SOUND, Level.CONTEXT_OPTIMAL
ARRIVES_ONLY = Bug("the goal is kept free only at the arrival", "nothing", "query", SOUND, arrives_only)
BUGS: Sequence[Bug] = (
    Bug("no collision check", "8 resources", "plan", SOUND, beyond(resources, 8, alone)),
    Bug("no collision check", "5 robots", "plan", SOUND, beyond(robots, 5, alone)),
    Bug("no collision check", "64 robots", "plan", SOUND, beyond(robots, 64, alone)),
    Bug("no collision check", "255 robots", "plan", SOUND, beyond(robots, 255, alone)),
    Bug("no collision check", "1,024 resources", "plan", SOUND, beyond(resources, 1024, alone)),
    Bug("capacities are unlimited", "capacity 2", "plan", SOUND, capacities_beyond(2)),
    Bug("capacities are unlimited", "capacity 10", "plan", SOUND, capacities_beyond(10)),
    Bug("durations are cut", "duration 9", "plan", SOUND, durations_up_to(9)),
    Bug("durations are cut", "duration 255", "plan", SOUND, durations_up_to(255)),
    Bug("paces are cut", "pace 3", "plan", SOUND, believing(robot=hasty)),
    Bug("releases are cut", "tick 100,000", "plan", SOUND, believing(robot=early)),
    Bug("no collision check", "tick 32,767", "plan", SOUND, beyond(makespan, BIT_15 - 1, alone)),
    Bug("ticks have 16 bits", "tick 32,767", "plan", SOUND, short_ticks),
    Bug("ids have 32 bits", "id 2^31", "plan", SOUND, short_ids),
    Bug("the others are forgotten", "20 robots", "add", SOUND, beyond(robots, 20, others_lost)),
    Bug("the search ends", "500 ticks", "query", Level.COMPLETE_IN_CONTEXT, gives_up_late),
    Bug("a tick too late", "40 plans", "query", OPTIMAL, waits),
    Bug("services are cut", "service 5", "plan", SOUND, believing(robot=short_services), Claims(stops=True)),
    Bug("another order", "50 robots", "plan", Level.EXACT, beyond(robots, 50, any_order)),
)


def run(bug: Bug, large: float, examples: int = 20, shrinking: float = 0.0) -> Report:
    options = Options(bug.level, examples, 1, 60.0, shrinking, claims=bug.claims, large=large)
    return conform(Planted(bug), options)


def main() -> None:
    rows = ["| planted bug | shows beyond | found by | large cases before | `--large` |", "|---|---|---|---:|---:|"]
    for bug in BUGS:
        reports = ((large, run(bug, large)) for large in BUDGETS)
        large, report = next(((large, report) for large, report in reports if report.failures), (0.0, None))
        if report is None:
            rows.append(f"| {bug.what} | {bug.beyond} | not found | | |")
            continue
        found = report.failures[0].case
        before = max(0, report.large.total() - 1)
        rows.append(f"| {bug.what} | {bug.beyond} | {found.op}: {found.name} | {before} | {large:g} |")
    sys.stdout.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
