"""Orders without end: pick here, drop there, and plans that are polished between arrivals.

Robots come in docks at random ticks, as in a stream, each with an order: a pick, which takes time, and a drop. A fleet
in memory takes them up one by one, by CARP or by the neighbourhood planner, or improves its plans by polish after each.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from time import process_time

import msgspec

from carp_experiments.beyond.streams import TICKS, middle_half, stream_instance, throughput_of
from carp_experiments.paper.map_cases import SORTING, MapCase, place_name, rows_by_map
from carp_experiments.report import ExperimentReport, table_of
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import MEASURED, Row
from carp_spec import Instance, Neighbourhood, Plan, RobotId, Stop, violations_of
from carp_spec.permutations import splitmix64
from carproof import Fleet

RATES = (200, 400, 800)
SERVICE = 5
ROUNDS = 10
PLANNERS = {
    "CARP": (Neighbourhood(m=1), 0),
    "Proposed_4": (Neighbourhood(m=4), 0),
    "Proposed_4, polished": (Neighbourhood(m=4), ROUNDS),
}


class Served(msgspec.Struct, frozen=True):
    """The orders of a stream: the ticks in which the middle half is done, and those in the system."""

    half: int
    taken: int


class LifelongRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment: the streams of each planner, one for each rate."""

    map: int
    planners: dict[str, tuple[Served, ...]]
    measured: dict[str, tuple[int, ...]]


def lifelong_row(case: MapCase) -> Row:
    """The streams of each planner, and their microseconds."""
    streams = {name: [served(case, name, rate) for rate in RATES] for name in PLANNERS}
    return {
        "planners": {name: [orders for orders, _ in found] for name, found in streams.items()},
        MEASURED: {name: [microseconds for _, microseconds in found] for name, found in streams.items()},
    }


def served(case: MapCase, name: str, rate: int) -> tuple[Served, int]:
    """Take up the orders of a stream, and measure it in microseconds.

    Raises `AssertionError` if an order has no plan, or plans break a rule.
    """
    planner, rounds = PLANNERS[name]
    instance = order_instance(case, rate)
    fleet = Fleet(replace(instance, robots=()), planner=planner)
    fleet.polish(iterations=0)  # what is loaded once is not counted
    plans: dict[RobotId, Plan] = {}
    began = process_time()
    for robot in sorted(instance.robots, key=lambda robot: robot.release):
        plans |= {plan.robot: plan for plan in fleet.add(robot, now=robot.release).plans}
        if rounds:
            plans |= {plan.robot: plan for plan in fleet.polish(iterations=rounds, seed=case.assignment).plans}
    seconds = process_time() - began
    made = [plans[robot.id] for robot in instance.robots if robot.id in plans]
    broken = violations_of(instance, made)
    if broken or len(made) < len(instance.robots):
        raise AssertionError(broken)
    taken = sum(plan.visits[-1].enter - instance.robot[plan.robot].release for plan in made)
    return Served(middle_half(made), taken), round(1e6 * seconds)


def order_instance(case: MapCase, rate: int) -> Instance:
    """The robots of a stream, each with a pick on its way: the goal of another, or the station where it starts."""
    instance = stream_instance(case, rate)
    if case.map == SORTING:
        starts = {robot.id: instance.graph.successors[robot.start][0] for robot in instance.robots}
        sorters = (replace(each, stops=(Stop(starts[each.id], SERVICE), *each.stops)) for each in instance.robots)
        return replace(instance, robots=tuple(sorters))
    goals, stream = [robot.goal for robot in instance.robots], splitmix64(case.assignment)
    robots = []
    for robot in instance.robots:
        picks = [goal for goal in dict.fromkeys(goals) if goal != robot.goal]
        picked = [Stop(picks[next(stream) % len(picks)], SERVICE)] if picks else []
        robots.append(replace(robot, stops=(*picked, *robot.stops)))
    return replace(instance, robots=tuple(robots))


@dataclass(frozen=True, slots=True)
class LifelongOf:
    """Means over the streams of a planner on one map at a rate of orders in 100 ticks.

    `throughput` is how many orders are done in 100 ticks, `taken` how many ticks an order is in the system, and
    `milliseconds` the processor's time for an order.
    """

    map: int
    planner: str
    rate: int
    streams: int
    throughput: Interval
    taken: Interval
    milliseconds: Interval


def lifelong_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """A table of all maps."""
    summary = tuple(
        LifelongOf(
            map,
            planner,
            rate,
            len(found),
            throughput_of([each.half for each in found], robots),
            mean_interval([each.taken / robots for each in found]),
            mean_interval([each / robots / 1000 for each in microseconds]),
        )
        for map, stored in rows_by_map(rows, LifelongRow).items()
        for place, rate in enumerate(RATES)
        for planner in PLANNERS
        if (found := [row.planners[planner][place] for row in stored])
        and (microseconds := [row.measured[planner][place] for row in stored])
    )
    title = (
        f"Streams of {robots} pick-and-drop orders, means with 95 % intervals: orders that come in {TICKS} ticks, "
        f"orders done in as many, ticks from an order's arrival to its drop, and processor time. A pick takes "
        f"{SERVICE} ticks; polish plays {ROUNDS} rounds after each arrival"
    )
    cells: Mapping[str, Callable[[LifelongOf], object]] = {
        "place": lambda each: place_name(each.map),
        "orders": lambda each: each.rate,
        "planner": lambda each: each.planner,
        "done": lambda each: f"{each.throughput:.0f}",
        "ticks in system": lambda each: f"{each.taken:.1f}",
        "ms an order": lambda each: f"{each.milliseconds:.2f}",
    }
    return ExperimentReport(summary, (table_of("lifelong", title, summary, cells, names=3),))
