"""People among robots: some travellers get priority one after the other, and the robots give way."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from time import process_time_ns

import msgspec

import carp_optimized as engine
from carp_experiments.paper.map_cases import MapCase, instance_of, place_name, rows_by_map
from carp_experiments.paper.quality import ALGORITHMS, seeded
from carp_experiments.report import ExperimentReport, Figure, lines_of, table_of
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import MEASURED, Row
from carp_spec import Instance, Plan, RobotId, Solution, plan_cost
from carp_spec.permutations import shuffle, splitmix64
from carproof.execution.giving_way import GivenWay, give_way

GIVEN = "Proposed_4"
PEOPLE = (1, 2, 5, 10)
EVERY = 2
"""The ticks between two people."""


class Person(msgspec.Struct, frozen=True):
    """A person who gets priority: `delay` is the arrival minus the least one, `None` without a new plan.

    `replanned` robots changed their plans, and `stuck` found none around the earliest plan. Then the robots without
    priority cost `extra` ticks more than at the beginning, and the people before arrive `pushed` ticks later in sum
    than their own plans had it.
    """

    delay: int | None
    proved: bool
    replanned: int
    stuck: int
    extra: int
    pushed: int


class PeopleRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment; `measured` are the milliseconds of processor time of each person."""

    map: int
    people: tuple[Person, ...]
    measured: tuple[int, ...]


def people_row(case: MapCase) -> Row:
    """Give priority to one traveller after the other."""
    instance = instance_of(case)
    solution = given = engine.plan(instance, seeded(ALGORITHMS[GIVEN], case.assignment))
    drawn = list(shuffle([*instance.robot], splitmix64(case.assignment)))
    promised: dict[RobotId, int] = {}
    people: list[Person] = []
    milliseconds: list[int] = []
    for number in range(PEOPLE[-1]):
        now = EVERY * (number + 1)
        travelling = {plan.robot for plan in solution.plans if plan.visits[-1].enter > now}
        person = next((robot for robot in drawn if robot in travelling), None)
        if person is None:
            break
        drawn.remove(person)
        started = process_time_ns()
        given_way = give_way(instance, solution, person, now, engine)
        milliseconds.append((process_time_ns() - started) // 1_000_000)
        solution = given_way.solution or solution
        after = {plan.robot: plan for plan in solution.plans}
        pushed = sum(after[robot].visits[-1].enter - tick for robot, tick in promised.items())
        promised[person] = after[person].visits[-1].enter
        people.append(
            Person(
                delay_of(given_way),
                given_way.is_first,
                len(given_way.extra),
                len(given_way.stuck),
                extra_cost(instance, given, after, promised),
                pushed,
            )
        )
    return {"people": people, MEASURED: milliseconds}


def delay_of(given_way: GivenWay) -> int | None:
    """The ticks between the arrival and the least one; `None` without a new plan."""
    if given_way.solution is None or given_way.arrival is None or given_way.least is None:
        return None
    return given_way.arrival - given_way.least


def extra_cost(instance: Instance, given: Solution, after: Mapping[RobotId, Plan], people: Collection[RobotId]) -> int:
    """The ticks by which the plans of all but the people cost more than the given ones."""
    before = [plan for plan in given.plans if plan.robot not in people]
    return sum(plan_cost(instance, after[plan.robot]) - plan_cost(instance, plan) for plan in before)


@dataclass(frozen=True, slots=True)
class PeopleOf:
    """The results on one map after this many people, over the assignments with that number.

    `first` of the `people` arrive in no lawful update earlier; `unserved` got no new plan; `delay` is the largest of
    the others. The means of an assignment are: robots replanned for a person, the extra cost of all robots without
    priority, the ticks by which people are pushed by later people, and milliseconds for a person.
    """

    map: int
    count: int
    people: int
    first: int
    unserved: int
    delay: int
    stuck: int
    replanned: Interval
    extra: Interval
    pushed: Interval
    milliseconds: Interval


def people_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """A table of all maps."""
    summary = tuple(
        people_of(map, count, enough)
        for map, stored in rows_by_map(rows, PeopleRow).items()
        for count in PEOPLE
        if (enough := [row for row in stored if len(row.people) >= count])
    )
    title = (
        f"People among {robots} robots that have plans by {GIVEN}, one each {EVERY} ticks. How many arrive as early as "
        "any lawful update allows, how many get no new plan, and the largest delay of the others; robots that find no "
        "plan around the earliest one, in all. Means with 95 % intervals: robots replanned for a person, ticks that "
        "all robots cost more, ticks by which people are late because of later people, processor time"
    )
    cells: Mapping[str, Callable[[PeopleOf], object]] = {
        "map": lambda each: each.map,
        "people": lambda each: each.count,
        "proved first": lambda each: f"{each.first}/{each.people}",
        "no plan": lambda each: each.unserved,
        "largest delay": lambda each: each.delay,
        "stuck": lambda each: each.stuck,
        "replanned": lambda each: f"{each.replanned:.1f}",
        "extra cost": lambda each: f"{each.extra:.1f}",
        "pushed": lambda each: f"{each.pushed:.1f}",
        "ms": lambda each: f"{each.milliseconds:.0f}",
    }
    return ExperimentReport(summary, (table_of("people", title, summary, cells),))


def people_figures(summary: Sequence[PeopleOf]) -> tuple[Figure, ...]:
    """The extra cost of robots, by the number of people."""
    lines = lines_of(summary, lambda each: place_name(each.map), lambda each: (each.count, each.extra))
    return (Figure("people", "Cost of people for the robots", ("people", "ticks more"), lines),)


def people_of(map: int, count: int, rows: Sequence[PeopleRow]) -> PeopleOf:
    """The results after this many people."""
    people = [person for row in rows for person in row.people[:count]]
    return PeopleOf(
        map,
        count,
        len(people),
        sum(person.proved for person in people),
        sum(person.delay is None for person in people),
        max((person.delay for person in people if person.delay is not None), default=0),
        sum(person.stuck for person in people),
        mean_interval([fmean(person.replanned for person in row.people[:count]) for row in rows]),
        mean_interval([row.people[count - 1].extra for row in rows]),
        mean_interval([row.people[count - 1].pushed for row in rows]),
        mean_interval([fmean(row.measured[:count]) for row in rows]),
    )
