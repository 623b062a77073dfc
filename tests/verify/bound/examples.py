"""Certificates of lower bounds that several tests take, and plans with their payments, word for word."""

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import msgspec
from hypothesis import strategies as st
from tests.verify.bound.plain_search import plain_least_cost

from carp_optimum.bound import lower_bound
from carp_optimum.deadline import Deadline
from carp_optimum.sat.proving import refutation
from carp_spec import Instance, Plan, Resource, ResourceGraph, ResourceId, Robot, RobotId, Visit
from carp_spec.documents.bounds import BOUND_FORMAT, BoundDocument, CutDocument, DeadlinesDocument
from carp_spec.documents.instances import digest
from carp_verify.bound.cuts import formula_of_deadlines, group_of
from carp_verify.bound.tariff import Tariff, fees_of
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.encoding import Evidence, beat_formula

SCALE = 4
HORIZON = 6
UNSOUND_DRAT = "91 0\n92 -91 0\nd 92 -91 0\n-92 0\n0\n"
"""Refuted every formula by a checker that forgets a unit clause and keeps what it implied."""
Tamper = Callable[[BoundDocument], BoundDocument]


def crossing() -> Instance:
    """Three robots meet in the middle cell of a plus; no move leads to the island."""
    cells = tuple(Resource(name) for name in ("north", "east", "south", "west", "middle", "island"))
    edges = tuple((name, "middle") for name in ("north", "east", "south", "west"))
    ends = (("north", "south"), ("east", "west"), ("south", "north"))
    robots = tuple(Robot(f"r{number}", *each) for number, each in enumerate(ends))
    return Instance(ResourceGraph(cells, edges), robots)


def priced(instance: Instance, **fields: Any) -> BoundDocument:  # noqa: ANN401 - those of the document
    """A certificate of bound 0 with nothing in it but these fields."""
    empty = BoundDocument(BOUND_FORMAT, digest(instance), 0, SCALE, HORIZON, (), (), (), ())
    return msgspec.structs.replace(empty, **fields)


def completed(instance: Instance, certificate: BoundDocument) -> BoundDocument:
    """The certificate with all that its prices and cuts prove."""
    tariff = Tariff(instance, certificate)
    fees = fees_of(instance, certificate.deadlines)
    weight = dict.fromkeys(instance.robot, certificate.scale)
    for cut in certificate.cuts:
        for robot in cut.robots:
            weight[robot] = max(weight.get(robot, 0) - cut.multiplier, 0)
    robots = tuple(
        (robot.id, plain_least_cost(tariff, robot, weight[robot.id], fees[robot.id])) for robot in instance.robots
    )
    worth = sum(deadlines.price * (len(deadlines.robots) - 1) for deadlines in certificate.deadlines)
    proved = sum(cut.multiplier * cut.least for cut in certificate.cuts)
    parts = proved + sum(least or 0 for _, least in robots) - tariff.worth - worth
    return msgspec.structs.replace(certificate, robots=robots, bound=-(-parts // certificate.scale))


@st.composite
def certificates(draw: st.DrawFn, instance: Instance) -> BoundDocument:
    """Certificates with any prices at all, many of them bad."""
    graph = instance.graph
    ticks, prices = st.integers(0, HORIZON - 1), st.integers(1, 3 * SCALE)
    places = st.sampled_from([resource.id for resource in graph.resources])
    moves = [(source, target) for source in graph.index for target in graph.successors[source]]
    both = [move for move in moves if (*reversed(move),) in graph.moves]
    resources = draw(st.dictionaries(st.tuples(places, ticks), prices, max_size=8))
    exchanges = draw(st.dictionaries(st.tuples(st.sampled_from(both), ticks), prices, max_size=8)) if both else {}
    ids = [group.id for group in graph.groups]
    groups = draw(st.dictionaries(st.tuples(st.sampled_from(ids), ticks), prices, max_size=8)) if ids else {}
    certificate = priced(
        instance,
        resources=tuple((*at, price) for at, price in resources.items()),
        exchanges=tuple((*pair, tick, price) for (pair, tick), price in exchanges.items()),
        groups=tuple((*at, price) for at, price in groups.items()),
    )
    return completed(instance, certificate)


def payment(instance: Instance, certificate: BoundDocument, plan: Plan) -> int:
    """The payments of a plan, tick by tick."""
    ticks = range(certificate.horizon)
    at = {
        tick: visit.resource
        for visit in plan.visits
        for tick in ticks
        if visit.enter <= tick and (visit.leave is None or tick < visit.leave)
    }
    moves = {(b.enter, a.resource, b.resource) for a, b in pairwise(plan.visits)}
    stays = {(t, v.resource) for v in plan.visits for t in ticks if v.enter < t and (v.leave is None or t < v.leave)}
    paid = sum(price for resource, tick, price in certificate.resources if at.get(tick) == resource)
    members = {group.id: group.resources for group in instance.graph.groups}
    paid += sum(price for group, tick, price in certificate.groups if at.get(tick) in members[group])
    for one, other, tick, price in certificate.exchanges:
        pays = {(tick, one, other), (tick, other, one)} & moves or (tick, one) in stays
        paid += price if pays else 0
    return paid


def plans_of(instance: Instance, robot: Robot) -> Iterator[Plan]:
    """All plans of a robot alone that do not come later than a shortest way from the horizon on would."""
    last = HORIZON + 2 * sum(instance.duration(robot.id, resource) for resource in instance.graph.index)

    def go_on(visits: tuple[Visit, ...], here: ResourceId, enter: int) -> Iterator[Plan]:
        ready = enter + instance.duration(robot.id, here)
        if here == robot.goal:
            yield Plan(robot.id, (*visits, Visit(here, enter, None if instance.after_goal == "park" else ready)))
        for leave in range(ready, min(last, max(ready, HORIZON)) + 1):
            for target in instance.graph.successors[here]:
                if leave < HORIZON or all(visit.resource != target or visit.enter < HORIZON for visit in visits):
                    yield from go_on((*visits, Visit(here, enter, leave)), target, leave)

    return go_on((), robot.start, robot.release)


@cache
def sight_certificate() -> BoundDocument:
    """A certificate without prices of places: r0 and r2, which meet head-on, are not both in the middle at tick 1."""
    return with_deadlines(DeadlinesDocument(("r0", "r2"), (0, 0), 3 << 15, "", ((1, ("middle",)), (1, ("middle",)))))


@cache
def deadline_certificate() -> BoundDocument:
    """A certificate without prices of places, in which one of r0 and r2, which meet head-on, comes late."""
    return with_deadlines(DeadlinesDocument(("r0", "r2"), (2, 2), 3 << 15, ""))


def with_deadlines(unproved: DeadlinesDocument) -> BoundDocument:
    """A certificate of the crossing with nothing but these deadlines, and their refutation."""
    certificate = msgspec.structs.replace(lower_bound(crossing(), steps=0), resources=(), exchanges=())
    lines = refutation(formula_of_deadlines(crossing(), unproved, 10**6), Deadline(60))
    proved = msgspec.structs.replace(unproved, refutation=lines)
    with_it = completed(crossing(), msgspec.structs.replace(certificate, deadlines=(proved,)))
    assert verify_bound(crossing(), with_it) == with_it.bound == 7
    return with_it


@cache
def cut_certificate() -> BoundDocument:
    """A certificate with a cut of r0 and r2, which meet head-on, that counts half of their costs."""
    certificate = lower_bound(crossing(), steps=2)
    cut = cut_of(crossing(), ("r0", "r2"), 7, Evidence((2, 2), (1, 0)))
    half = msgspec.structs.replace(cut, multiplier=certificate.scale // 2)
    with_it = completed(crossing(), msgspec.structs.replace(certificate, cuts=(half,)))
    assert verify_bound(crossing(), with_it) == with_it.bound
    assert with_it.bound > certificate.bound
    return with_it


def cut_of(instance: Instance, robots: Sequence[RobotId], least: int, evidence: Evidence | None = None) -> CutDocument:
    """The claim that robots cost at least so much together, with its refutation."""
    evidence = evidence or Evidence(tuple(least for _ in robots), tuple(range(len(robots))))
    lrat = refutation(beat_formula(group_of(instance, robots), least, evidence).formula, Deadline(60))
    return CutDocument(tuple(robots), least, 1, evidence.horizons, evidence.order, lrat)


def left(visit: Visit) -> int:
    """The tick at which a visit ends that is not the last one."""
    assert visit.leave is not None
    return visit.leave
