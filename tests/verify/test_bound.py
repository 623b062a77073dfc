"""Lower bounds by prices: they hold, they are checked, and tampering is refused."""

import ast
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import cache
from itertools import pairwise, product
from pathlib import Path
from time import process_time

import msgspec
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.verify.tiny import TINY

from carp_optimum.bound import Progress, lower_bound
from carp_optimum.cut_search import prove
from carp_optimum.proving import refutation
from carp_optimum.solver import Deadline, Solver
from carp_spec import Instance, Plan, Refusal, Resource, ResourceGraph, ResourceId, Robot, Rule, Visit
from carp_spec.plan_rules import plan_cost
from carp_verify import bound_rules
from carp_verify import verify_bound as page
from carp_verify.bound_cuts import formula_of, formula_of_deadlines
from carp_verify.bounds import BOUND_FORMAT, BoundDocument, CutDocument, DeadlinesDocument, digest, read_bound
from carp_verify.documents import write
from carp_verify.encoding import violated
from carp_verify.joint_search import least_total_cost
from carp_verify.refutation import NotRefutedError
from carp_verify.verify_bound import Budget, Fees, RobotSearch, Tariff, fees_of, predecessors, verify_bound
from carproof.strategies import PlannedInstance, Sizes, instances, planned_instances

SCALE = 4
HORIZON = 6
UNSOUND_DRAT = "91 0\n92 -91 0\nd 92 -91 0\n-92 0\n0\n"
"""Refuted every formula by a checker that forgets a unit clause and keeps what it implied."""
Tamper = Callable[[BoundDocument], BoundDocument]


def crossing() -> Instance:
    """Three robots meet in the middle cell of a plus, and a fourth cannot get anywhere."""
    cells = tuple(Resource(name) for name in ("north", "east", "south", "west", "middle", "island"))
    edges = tuple((name, "middle") for name in ("north", "east", "south", "west"))
    ends = (("north", "south"), ("east", "west"), ("south", "north"))
    robots = tuple(Robot(f"r{number}", *each) for number, each in enumerate(ends))
    return Instance(ResourceGraph(cells, edges), robots)


def completed(instance: Instance, certificate: BoundDocument) -> BoundDocument:
    """The certificate with all that its prices prove."""
    tariff = Tariff(instance, certificate)
    before, fees = predecessors(instance), fees_of(instance, certificate.deadlines)
    robots = tuple(
        (
            robot.id,
            RobotSearch(tariff, robot, certificate.scale, before, Budget(), fees[robot.id]).least_cost(),
        )
        for robot in instance.robots
    )
    worth = sum(deadlines.price * (len(deadlines.robots) - 1) for deadlines in certificate.deadlines)
    parts = sum(least or 0 for _, least in robots) - tariff.worth - worth
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
    certificate = BoundDocument(
        format=BOUND_FORMAT,
        instance=digest(instance),
        bound=0,
        scale=SCALE,
        horizon=HORIZON,
        resources=tuple((place, tick, price) for (place, tick), price in resources.items()),
        exchanges=tuple((*pair, tick, price) for (pair, tick), price in exchanges.items()),
        cuts=(),
        robots=(),
    )
    return completed(instance, certificate)


def payment(certificate: BoundDocument, plan: Plan) -> int:
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


@settings(max_examples=draws(120))
@given(st.data(), instances(Sizes(resources=3, robots=1, capacity=1, duration=2, release=3, pace=1), least_robots=1))
def test_the_least_cost_is_that_of_the_cheapest_of_all_plans(data: st.DataObject, instance: Instance) -> None:
    certificate = data.draw(certificates(instance))
    robot = instance.robots[0]
    costs = [SCALE * plan_cost(instance, plan) + payment(certificate, plan) for plan in plans_of(instance, robot)]
    assert certificate.robots == ((robot.id, min(costs, default=None)),)


@settings(max_examples=draws(120))
@given(st.data(), instances(Sizes(resources=3, robots=1, capacity=1, duration=2, release=3, pace=1), least_robots=1))
def test_who_keeps_a_deadline_pays_for_it_and_may_drive_on_through_the_goal_to_miss_it(
    data: st.DataObject, instance: Instance
) -> None:
    certificate = data.draw(certificates(instance))
    robot = instance.robots[0]
    fees = data.draw(st.lists(st.tuples(st.integers(0, HORIZON - 1), st.integers(0, 4 * SCALE)), max_size=3))
    costs = [
        SCALE * plan_cost(instance, plan)
        + payment(certificate, plan)
        + sum(price for tick, price in fees if plan.visits[-1].enter <= tick)
        for plan in plans_of(instance, robot)
    ]
    tariff = Tariff(instance, certificate)
    search = RobotSearch(tariff, robot, SCALE, predecessors(instance), Budget(), Fees(fees))
    assert search.least_cost() == min(costs, default=None)


def left(visit: Visit) -> int:
    """The tick at which a visit ends that is not the last one."""
    assert visit.leave is not None
    return visit.leave


def keeps(plan: Plan, deadline: int, seen: int, places: frozenset[ResourceId]) -> bool:
    """Whether the plan keeps the deadline of a robot that is seen, word for word as the document has it."""
    arrival = plan.visits[-1].enter
    at = {visit.resource for visit in plan.visits[:-1] if visit.enter <= seen < left(visit)}
    return (arrival <= deadline and arrival <= seen) or bool(at & places)


@settings(max_examples=draws(400))
@given(
    st.data(),
    instances(Sizes(resources=4, robots=2, capacity=1, duration=2, release=2, pace=1), least_robots=2),
)
def test_no_plans_that_break_no_rule_keep_all_deadlines_whose_formula_has_no_model(
    data: st.DataObject, instance: Instance
) -> None:
    ticks = st.integers(0, HORIZON - 1)
    places = st.frozensets(st.sampled_from([resource.id for resource in instance.graph.resources]))
    members = [data.draw(st.tuples(ticks, ticks, places)) for _ in instance.robots]
    robots = tuple(robot.id for robot in instance.robots)
    seen = tuple((tick, tuple(sorted(at, key=str))) for _, tick, at in members)
    deadlines = DeadlinesDocument(robots, tuple(tick for tick, _, _ in members), 0, "", seen)
    try:
        formula = formula_of_deadlines(instance, deadlines, 10**6)
    except NotRefutedError:
        return  # a robot has no way
    keeping = [
        [plan for plan in plans_of(instance, robot) if keeps(plan, *member)]
        for robot, member in zip(instance.robots, members, strict=True)
    ]
    is_possible = any(not violated(instance, plans) for plans in product(*keeping))
    has_model = Solver(formula, lambda: None).satisfiable([])
    assert has_model or not is_possible
    event("possible" if is_possible else "refuted" if not has_model else "not refuted")


@settings(max_examples=draws(200))
@given(st.data(), instances(Sizes(resources=3, robots=1, capacity=1, duration=3, release=3, pace=1), least_robots=1))
def test_who_is_seen_in_a_place_on_the_way_pays_for_it_once(data: st.DataObject, instance: Instance) -> None:
    certificate = data.draw(certificates(instance))
    robot = instance.robots[0]
    places = st.sets(st.sampled_from([resource.id for resource in instance.graph.resources]))
    prices = st.integers(0, 4 * SCALE)
    arrivals = data.draw(st.lists(st.tuples(st.integers(0, HORIZON - 1), prices), max_size=2))
    sights = data.draw(st.lists(st.tuples(st.integers(0, HORIZON - 1), places, prices), max_size=4))
    fees = Fees([*arrivals, (0, 0)], sights)
    costs = [
        SCALE * plan_cost(instance, plan)
        + payment(certificate, plan)
        + sum(price for tick, price in arrivals if plan.visits[-1].enter <= tick)
        + sum(
            price
            for tick, counted, price in sights
            if any(visit.resource in counted and visit.enter <= tick < left(visit) for visit in plan.visits[:-1])
        )
        for plan in plans_of(instance, robot)
    ]
    tariff = Tariff(instance, certificate)
    search = RobotSearch(tariff, robot, SCALE, predecessors(instance), Budget(), fees)
    assert search.least_cost() == min(costs, default=None)


@pytest.mark.parametrize(
    ("prices", "fees", "least"),
    [
        ((), [(3, 10)], 4),  # comes after the deadline, although nothing else is priced
        ((), [(3, 2)], 3),  # pays
        ((), [(1, 1), (3, 1)], 3),  # pays both
        ((("a", 1, 10 * SCALE),), [(2, 10)], 3),  # drives through the goal, as to wait is dear
    ],
)
def test_a_robot_is_late_where_that_is_cheaper(
    prices: tuple[tuple[str, int, int], ...], fees: list[tuple[int, int]], least: int
) -> None:
    lane = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("r", "a", "b"),))
    certificate = BoundDocument(BOUND_FORMAT, digest(lane), 0, SCALE, HORIZON, prices, (), (), ())
    paid = [(tick, SCALE * price) for tick, price in fees]
    search = RobotSearch(Tariff(lane, certificate), lane.robots[0], SCALE, predecessors(lane), Budget(), Fees(paid))
    assert search.least_cost() == SCALE * least


@settings(max_examples=draws(300))
@given(st.data(), planned_instances(Sizes(resources=4, robots=4, release=2, wait=1)))
def test_whatever_the_prices_sound_plans_pay_no_more_than_they_are_worth_and_cost_no_less_than_the_least(
    data: st.DataObject, planned: PlannedInstance
) -> None:
    instance, plans = planned.instance, planned.solution.plans
    certificate = data.draw(certificates(instance))
    verify_bound(instance, certificate)
    least = dict(certificate.robots)
    for plan in plans:
        own = least[plan.robot]
        assert own is not None
        assert own <= SCALE * plan_cost(instance, plan) + payment(certificate, plan)
    assert sum(payment(certificate, plan) for plan in plans) <= Tariff(instance, certificate).worth


@settings(max_examples=draws(80))
@given(instances(TINY, least_robots=2))
def test_a_bound_that_was_found_is_verified_and_at_most_the_optimum(instance: Instance) -> None:
    seen: list[Progress] = []
    certificate = lower_bound(instance, steps=600, on_step=seen.append)
    assert verify_bound(instance, certificate) == certificate.bound
    event(f"seen: {any(deadlines.seen for deadlines in certificate.deadlines)}")
    if not certificate.cuts:
        assert completed(instance, certificate) == certificate
    assert certificate.bound >= seen[0].bound
    best = least_total_cost(instance)
    if best is not None:
        assert certificate.bound <= best


def test_prices_find_what_the_shortest_paths_miss() -> None:
    instance = crossing()
    seen: list[Progress] = []
    certificate = lower_bound(instance, steps=500, on_step=seen.append)
    assert (seen[0].bound, certificate.bound, least_total_cost(instance)) == (6, 9, 11)


def test_deadlines_find_what_prices_alone_miss_and_carry_their_proofs() -> None:
    instance = crossing()
    certificate = lower_bound(instance, steps=4500)
    assert certificate.bound == 10
    assert certificate.deadlines
    assert verify_bound(instance, certificate) == 10


def with_deadlines(**fields: object) -> Tamper:
    """Change the only deadlines."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        changed = msgspec.structs.replace(certificate.deadlines[0], **fields)
        return completed(crossing(), msgspec.structs.replace(certificate, deadlines=(changed,)))

    return tamper


@pytest.mark.parametrize(
    ("tamper", "path", "reason"),
    [
        (with_deadlines(price=-1), "$.deadlines[0].price", "must be a whole number of at least 0, and is -1"),
        (with_deadlines(price=1.5), "$.deadlines[0].price", r"and is 1\.5"),
        (with_deadlines(price=True), "$.deadlines[0].price", "and is True"),
        (
            with_deadlines(robots=("r0", "r0")),
            "$.deadlines[0].robots",
            "must name one or more robots of the instance once",
        ),
        (with_deadlines(robots=("r0", "moon")), "$.deadlines[0].robots", "one or more robots of the instance"),
        (with_deadlines(robots=(), ticks=()), "$.deadlines[0].robots", "one or more robots"),
        (with_deadlines(ticks=(2, 3)), "$.deadlines[0]", "its proof does not hold"),
        (with_deadlines(ticks=(1, 2)), "$.deadlines[0]", "robot r0 can be at its goal at 2, not at 1"),
        (with_deadlines(ticks=(2.0, 2)), "$.deadlines[0]", r"not at 2\.0"),
        (with_deadlines(ticks=(True, 2)), "$.deadlines[0]", "not at True"),
        (with_deadlines(refutation=""), "$.deadlines[0]", "it does not end with the empty clause"),
    ],
)
def test_tampered_deadlines_are_refused(tamper: Tamper, path: str, reason: str) -> None:
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(crossing(), tamper(deadline_certificate()))
    assert (refused.value.path, refused.value.rule) == (path, "bound/deadline")


def test_each_robot_has_a_deadline_or_the_deadlines_are_refused() -> None:
    for ticks in ((2,), (2, 2, 2)):
        changed = msgspec.structs.replace(deadline_certificate().deadlines[0], ticks=ticks)
        with pytest.raises(Refusal, match="it must have a deadline of each of 2 robots") as refused:
            verify_bound(crossing(), msgspec.structs.replace(deadline_certificate(), deadlines=(changed,)))
        assert refused.value.rule == "bound/deadline"


def test_a_robot_without_a_way_has_no_deadline() -> None:
    crossed = crossing()
    instance = Instance(crossed.graph, (*crossed.robots, Robot("lost", "north", "island")))
    deadlines = DeadlinesDocument(("r0", "lost"), (2, 2), 1, "1 0 1 0\n")
    with pytest.raises(Refusal, match="robot lost can be at its goal at None, not at 2"):
        verify_bound(instance, msgspec.structs.replace(lower_bound(instance, steps=2), deadlines=(deadlines,)))


def with_sights(**fields: object) -> Tamper:
    """Change the only deadlines, of robots that are seen."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        changed = msgspec.structs.replace(certificate.deadlines[0], **fields)
        tampered = msgspec.structs.replace(certificate, deadlines=(changed,))
        return completed(crossing(), tampered) if len(changed.seen) > 1 else tampered

    return tamper


def sight(tick: object = 1, places: object = ("middle",), other: object = ("middle",)) -> Tamper:
    return with_sights(seen=((tick, places), (1, other)))


@pytest.mark.parametrize(
    ("tamper", "reason"),
    [
        (sight(tick=2), "its proof does not hold"),  # r0 can wait while r2 passes
        (sight(tick=0), "its proof does not hold"),
        (sight(places=("middle", "north")), "its proof does not hold"),
        (sight(other=("middle", "south")), "its proof does not hold"),
        (with_sights(robots=("r0", "r1"), refutation="1 0 1 0\n"), "its proof does not hold"),
        (sight(tick=-1), "robot r0 must have whole ticks of at least 0, not 0 and -1"),
        (sight(tick=1.0), r"whole ticks of at least 0, not 0 and 1\.0"),
        (sight(tick=True), "whole ticks of at least 0, not 0 and True"),
        (with_sights(ticks=(0, -1)), "robot r2 must have whole ticks of at least 0, not -1 and 1"),
        (sight(places=("moon",)), "the places of robot r0 must be resources"),
        (with_sights(seen=((1, ("middle",)),)), "it must see each of 2 robots"),
        (with_sights(refutation=""), "it does not end with the empty clause"),
    ],
)
def test_tampered_sights_are_refused(tamper: Tamper, reason: str) -> None:
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(crossing(), tamper(sight_certificate()))
    assert (refused.value.path, refused.value.rule) == ("$.deadlines[0]", "bound/deadline")


def test_a_robot_that_vanishes_may_have_passed_its_goal_when_it_is_seen() -> None:
    lane = Instance(
        ResourceGraph((Resource("a"), Resource("b"), Resource("c")), (("a", "b"), ("b", "c"))), (Robot("r", "a", "b"),)
    )
    deadlines = DeadlinesDocument(("r",), (0,), 1, "", ((2, ("c",)),))
    assert Solver(formula_of_deadlines(lane, deadlines, 100), lambda: None).satisfiable([])
    earlier = msgspec.structs.replace(deadlines, seen=((1, ("c",)),))
    assert not Solver(formula_of_deadlines(lane, earlier, 100), lambda: None).satisfiable([])


@cache
def sight_certificate() -> BoundDocument:
    """A certificate without prices of places: r0 and r2, which meet head-on, are not both in the middle at tick 1."""
    certificate = msgspec.structs.replace(lower_bound(crossing(), steps=0), resources=(), exchanges=())
    unproved = DeadlinesDocument(("r0", "r2"), (0, 0), 3 << 15, "", ((1, ("middle",)), (1, ("middle",))))
    lines = refutation(formula_of_deadlines(crossing(), unproved, 10**6), Deadline(60))
    proved = msgspec.structs.replace(unproved, refutation=lines)
    with_it = completed(crossing(), msgspec.structs.replace(certificate, deadlines=(proved,)))
    assert verify_bound(crossing(), with_it) == with_it.bound == 7
    return with_it


def test_deadlines_of_robots_that_are_seen_are_written_and_read() -> None:
    certificate = sight_certificate()
    assert read_bound(write(certificate)) == certificate
    assert b"seen" not in write(deadline_certificate())


def test_who_arrives_after_it_is_seen_pays_nothing_and_who_waits_where_it_is_seen_pays() -> None:
    deadlines = DeadlinesDocument(("r0", "r2"), (5, 0), 3, "", ((1, ("middle",)), (2, ())))
    fees = fees_of(crossing(), [deadlines])["r0"]
    assert [fees.at_arrival(tick) for tick in range(4)] == [3, 3, 0, 0]
    assert [fees.on_the_way("middle", tick, tick + 1) for tick in range(3)] == [0, 3, 0]
    assert fees.on_the_way("north", 0, 9) == 0
    lane = Instance(ResourceGraph(tuple(map(Resource, "abc")), (("a", "b"), ("b", "c"))), (Robot("r", "a", "c"),))
    certificate = BoundDocument(BOUND_FORMAT, digest(lane), 0, SCALE, HORIZON, (("b", 1, 9 * SCALE),), (), (), ())
    waits = Fees([], [(1, ("a",), SCALE)])
    search = RobotSearch(Tariff(lane, certificate), lane.robots[0], SCALE, predecessors(lane), Budget(), waits)
    assert search.least_cost() == 4 * SCALE


def test_robots_are_not_seen_in_a_certificate_for_the_kernel() -> None:
    certificate = lower_bound(crossing(), steps=1500, seen=False)
    assert certificate.deadlines
    assert not any(deadlines.seen for deadlines in certificate.deadlines)


def test_a_robot_pays_only_where_it_is_seen() -> None:
    certificate = sight_certificate()
    assert [least for _, least in certificate.robots] == [3 << 16, 2 << 16, 3 << 16]
    claimed = tuple((robot, 7 << 15) for robot, _ in certificate.robots)
    with pytest.raises(Refusal, match="robot r0 can have no more than 196608"):
        verify_bound(crossing(), msgspec.structs.replace(certificate, robots=claimed))


@cache
def deadline_certificate() -> BoundDocument:
    """A certificate without prices of places, in which one of r0 and r2, which meet head-on, comes late."""
    certificate = msgspec.structs.replace(lower_bound(crossing(), steps=0), resources=(), exchanges=())
    unproved = DeadlinesDocument(("r0", "r2"), (2, 2), 3 << 15, "")
    lines = refutation(formula_of_deadlines(crossing(), unproved, 10**6), Deadline(60))
    proved = msgspec.structs.replace(unproved, refutation=lines)
    with_it = completed(crossing(), msgspec.structs.replace(certificate, deadlines=(proved,)))
    assert verify_bound(crossing(), with_it) == with_it.bound == 7
    return with_it


def test_deadlines_are_counted_once_for_all_robots_but_one() -> None:
    certificate = deadline_certificate()
    assert [least for _, least in certificate.robots] == [3 << 16, 2 << 16, 3 << 16]
    dearer = msgspec.structs.replace(certificate, bound=8)
    with pytest.raises(Refusal, match="the bound must be 7") as refused:
        verify_bound(crossing(), dearer)
    assert refused.value.rule == "bound/total"


def test_a_document_without_deadlines_is_written_as_before() -> None:
    certificate = lower_bound(crossing(), steps=2)
    assert b"deadlines" not in write(certificate)
    assert read_bound(write(deadline_certificate())) == deadline_certificate()


def with_cut(**fields: object) -> Tamper:
    """Change the first cut."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        first = msgspec.structs.replace(certificate.cuts[0], **fields)
        return msgspec.structs.replace(certificate, cuts=(first, *certificate.cuts[1:]))

    return tamper


@pytest.mark.parametrize(
    ("tamper", "path", "reason"),
    [
        (with_cut(multiplier=-1), "$.cuts[0].multiplier", "must be a whole number of at least 0, and is -1"),
        (with_cut(multiplier=1.5), "$.cuts[0].multiplier", r"and is 1\.5"),
        (with_cut(multiplier=(1 << 16) + 1), "$.cuts[0].multiplier", "must add up to 65536 at most"),
        (with_cut(robots=("r0", "r0")), "$.cuts[0].robots", "must name robots of the instance once, also 'r0'"),
        (with_cut(robots=("r0", "moon")), "$.cuts[0].robots", "also 'moon'"),
        (with_cut(robots=("r1",)), "$.cuts[0]", "it must have a horizon of each of 1 robots"),
        (with_cut(robots=("r1", "r2")), "$.cuts[0]", "its proof does not hold: line"),
        (with_cut(robots=(), horizons=(), order=()), "$.cuts[0].robots", "it must name at least one robot"),
        (with_cut(least=99), "$.cuts[0]", "its proof does not hold: line"),
        (with_cut(least=7.0), "$.cuts[0]", "must be whole numbers"),
        (with_cut(least=True), "$.cuts[0]", "must be whole numbers"),
        (with_cut(horizons=(1,)), "$.cuts[0]", "it must have a horizon of each of 2 robots"),
        (with_cut(horizons=(-1, 1)), "$.cuts[0]", "a horizon must be between 0 and the least total"),
        (with_cut(order=(0, 0)), "$.cuts[0]", "and an order of them"),
        (with_cut(order=(0, 1, 1)), "$.cuts[0]", "and an order of them"),
        (with_cut(order=(1, 2)), "$.cuts[0]", "and an order of them"),
        (with_cut(horizons=(1, 1, 1)), "$.cuts[0]", "it must have a horizon of each of 2 robots"),
        (with_cut(horizons=(8, 1)), "$.cuts[0]", "a horizon must be between 0 and the least total"),
        (with_cut(refutation=""), "$.cuts[0]", "it does not end with the empty clause"),
        (with_cut(refutation="hello"), "$.cuts[0]", "line 1 must be a clause with its hints"),
        (with_cut(refutation=UNSOUND_DRAT), "$.cuts[0]", "line 1 has no hints: refutations without hints"),
    ],
)
def test_a_tampered_cut_is_refused(tamper: Tamper, path: str, reason: str) -> None:
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(crossing(), tamper(cut_certificate()))
    assert (refused.value.path, refused.value.rule) == (path, "bound/cut")


@cache
def cut_certificate() -> BoundDocument:
    """A certificate with a cut of r0 and r2, which meet head-on."""
    certificate = lower_bound(crossing(), steps=2)
    cut = prove(crossing(), (0, 2), lambda: None)
    assert cut is not None
    with_it = msgspec.structs.replace(certificate, cuts=(cut.document,))
    assert (cut.document.least, verify_bound(crossing(), with_it)) == (7, certificate.bound)
    return with_it


def test_horizons_of_a_cut_go_from_0_to_its_least_total() -> None:
    (cut,) = cut_certificate().cuts
    for horizons in ((0, cut.least), (cut.least, 0)):
        assert formula_of(crossing(), msgspec.structs.replace(cut, horizons=horizons), 10**6).clauses


def test_the_multipliers_of_all_cuts_of_a_robot_count_together() -> None:
    (cut,) = cut_certificate().cuts
    half = msgspec.structs.replace(cut, multiplier=cut_certificate().scale * 3 // 4)
    with pytest.raises(Refusal, match="the multipliers of robot r0 must add up to 65536 at most") as refused:
        verify_bound(crossing(), msgspec.structs.replace(cut_certificate(), cuts=(half, half)))
    assert refused.value.path == "$.cuts[1].multiplier"


def test_a_horizon_far_beyond_the_last_price_costs_nothing() -> None:
    certificate = lower_bound(crossing(), steps=500)
    for horizon in (10**9, 10**99):
        assert verify_bound(crossing(), msgspec.structs.replace(certificate, horizon=horizon)) == certificate.bound


def test_a_horizon_below_zero_is_malformed() -> None:
    with pytest.raises(Refusal, match="expected int >= 0") as refused:
        read_bound(write(msgspec.structs.replace(lower_bound(crossing(), steps=1), resources=(), horizon=-1)))
    assert (refused.value.path, refused.value.rule) == ("$.horizon", "document/shape")


def test_a_search_for_least_costs_that_takes_too_long_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "LARGEST_SEARCH", 2)
    with pytest.raises(Refusal, match="takes more than 2 steps") as refused:
        verify_bound(crossing(), lower_bound(crossing(), steps=500))
    assert refused.value.rule == "bound/size"


def sized(change: str) -> tuple[Instance, BoundDocument]:
    """A certificate with one size larger than all others."""
    if change == "prices":
        lane = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("r", "a", "b"),))
        prices = {"resources": (("a", 29, 1),), "exchanges": (("b", "a", 29, 1), ("a", "b", 3, 1))}
        return lane, completed(lane, msgspec.structs.replace(lower_bound(lane, steps=1), horizon=30, **prices))
    certificate = cut_certificate()
    return crossing(), msgspec.structs.replace(certificate, cuts=certificate.cuts * (2 if change == "cuts" else 0))


@pytest.mark.parametrize(
    ("change", "limit", "size", "path"),
    [
        ("robots", "LARGEST_TABLE", 3 * 6, "$.robots"),
        ("cuts", "LARGEST_TABLE", 2 * 2 * 6, "$.cuts"),
        ("prices", "LARGEST_TABLE", 30 * 2, "$.resources"),
        ("cuts", "LARGEST_FORMULA", 2 * 97, "$.cuts[1]"),
        ("prices", "LARGEST_SEARCH", 1, "$.robots"),
    ],
)
def test_each_size_is_accepted_up_to_its_limit(
    change: str, limit: str, size: int, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    instance, certificate = sized(change)
    monkeypatch.setattr(page, limit, size)
    assert verify_bound(instance, certificate) == certificate.bound
    monkeypatch.setattr(page, limit, size - 1)
    with pytest.raises(Refusal, match=f"at most {size - 1}|more than {size - 1}") as refused:
        verify_bound(instance, certificate)
    assert (refused.value.path, refused.value.rule) == (path, "bound/size")


def test_prices_that_keep_a_robot_waiting_for_long_are_refused_after_a_bounded_search() -> None:
    lane = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),))
    instance = Instance(lane, (Robot("r", "a", "b"),))
    prices = (*(("b", tick, 10**12) for tick in range(1000)), ("b", 9_999_999, 1))
    certificate = BoundDocument(BOUND_FORMAT, digest(instance), 0, 1, 10**7, prices, (), (), (("r", 0),))
    started = process_time()
    with pytest.raises(Refusal, match="bound"):
        verify_bound(instance, certificate)
    assert process_time() - started < 30


@pytest.mark.parametrize(("horizons", "least"), [((3000, 3000), 3007), ((10**9, 0), 10**9), ((0, 10**99), 10**99)])
def test_a_cut_with_a_large_formula_is_refused_at_once(horizons: tuple[int, int], least: int) -> None:
    (cut,) = cut_certificate().cuts
    large = msgspec.structs.replace(cut, horizons=horizons, least=least)
    started = process_time()
    with pytest.raises(Refusal, match="must have at most 5000000 clauses together") as refused:
        verify_bound(crossing(), msgspec.structs.replace(cut_certificate(), cuts=(large,)))
    assert (refused.value.path, refused.value.rule) == ("$.cuts[0]", "bound/size")
    assert process_time() - started < 20


def test_a_cut_of_a_robot_without_a_way_is_refused() -> None:
    crossed = crossing()
    instance = Instance(crossed.graph, (*crossed.robots, Robot("lost", "north", "island")))
    certificate = lower_bound(instance, steps=2)
    cut = CutDocument(("r0", "lost"), 0, 1, (0, 0), (0, 1), "1 0 1 0\n")
    with pytest.raises(Refusal, match="a robot of the group has no way to its goal"):
        verify_bound(instance, msgspec.structs.replace(certificate, cuts=(cut,)))


def test_stays_too_long_to_be_searched_are_refused_with_the_limit_named() -> None:
    lane = ResourceGraph((Resource("a", duration=200_000), Resource("b")), (("a", "b"),))
    with pytest.raises(Refusal, match="must be at most 100000, the limit, and is 200000") as refused:
        lower_bound(Instance(lane, (Robot("r", "a", "b"),)), steps=3)
    assert refused.value.rule == "bound/stay"


def test_prices_end_early_where_ticks_are_many_and_the_bound_holds_all_the_same() -> None:
    lane = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),))
    robots = (Robot("r", "a", "b", release=10**8), Robot("s", "b", "a", release=10**8))
    certificate = lower_bound(Instance(lane, robots), steps=30)
    assert certificate.horizon == 20_000
    assert verify_bound(Instance(lane, robots), certificate) == certificate.bound >= 2


def test_the_same_steps_give_the_same_certificate() -> None:
    assert write(lower_bound(crossing(), steps=30)) == write(lower_bound(crossing(), steps=30))


def test_a_certificate_is_read_as_it_was_written() -> None:
    certificate = lower_bound(crossing(), steps=30)
    assert read_bound(write(certificate)) == certificate


def test_a_robot_without_a_way_is_named_and_left_out() -> None:
    crossed = crossing()
    lost = Robot("lost", "north", "island")
    instance = Instance(crossed.graph, (crossed.robots[0], lost))
    certificate = lower_bound(instance, steps=30)
    assert certificate.robots[1] == ("lost", None)
    assert verify_bound(instance, certificate) == 2
    for wrong in ((("r0", None), ("lost", None)), (certificate.robots[0], ("lost", 0))):
        with pytest.raises(Refusal, match="bound/robots"):
            verify_bound(instance, msgspec.structs.replace(certificate, robots=wrong))


def change(**fields: object) -> Tamper:
    return lambda certificate: msgspec.structs.replace(certificate, **fields)


def reprice(price: object = None, tick: object = None, place: object = None) -> Tamper:
    """Change the first price."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        first = certificate.resources[0]
        new = (place or first[0], first[1] if tick is None else tick, first[2] if price is None else price)
        return msgspec.structs.replace(certificate, resources=(new, *certificate.resources[1:]))

    return tamper


def exchange(*row: object) -> Tamper:
    return lambda certificate: msgspec.structs.replace(certificate, exchanges=(row, *certificate.exchanges))


def of_robot(more: int) -> Tamper:
    """Claim more of the first robot, and of the bound."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        (robot, least), *rest = certificate.robots
        bound = certificate.bound + more // certificate.scale
        return msgspec.structs.replace(certificate, robots=((robot, (least or 0) + more), *rest), bound=bound)

    return tamper


@pytest.mark.parametrize(
    ("tamper", "path", "rule", "reason"),
    [
        (change(instance="0" * 64), "$.instance", "bound/instance", "it is about another instance"),
        (change(scale=3), "$.scale", "bound/scale", "must be a power of two, and is 3"),
        (change(scale=0), "$.scale", "bound/scale", "and is 0"),
        (change(scale=True), "$.scale", "bound/scale", "and is True"),
        (change(scale=4.0), "$.scale", "bound/scale", r"and is 4\.0"),
        (reprice(price=-1), "$.resources[0]", "bound/price", "-1 at . must be a price of at least 0"),
        (reprice(price=1.5), "$.resources[0]", "bound/price", "1.5 at"),
        (reprice(price=True), "$.resources[0]", "bound/price", "True at"),
        (reprice(tick=99), "$.resources[0]", "bound/price", "at 99 must be .* at a tick below"),
        (reprice(tick=-1), "$.resources[0]", "bound/price", "at -1 must be"),
        (reprice(tick=1.0), "$.resources[0]", "bound/price", r"at 1\.0 must be"),
        (reprice(place="moon"), "$.resources[0]", "bound/price", "moon must be a resource"),
        (exchange("north", "moon", 1, 1), "$.exchanges[0]", "bound/price", "north and moon must be"),
        (exchange("north", "east", 1, 1), "$.exchanges[0]", "bound/price", "with a move each way"),
        (
            lambda each: exchange("middle", "north", 0, 1)(exchange("north", "east", 1, 1)(each)),
            "$.exchanges[1]",
            "bound/price",
            "with a move each way",
        ),
        (change(robots=()), "$.robots", "bound/robots", "must name each robot of the instance once"),
        (lambda each: change(robots=each.robots[1:])(each), "$.robots", "bound/robots", "once, in its order"),
        (lambda each: change(robots=each.robots[::-1])(each), "$.robots", "bound/robots", "once, in its order"),
        (lambda each: change(robots=each.robots * 2)(each), "$.robots", "bound/robots", "once, in its order"),
        (lambda each: change(resources=each.resources * 2)(each), None, "bound/once", "must have one price at tick"),
        (of_robot(1 << 16), "$.robots[0]", "bound/robots", "robot r0 can have no more than"),
        (lambda each: change(bound=each.bound + 1)(each), "$.bound", "bound/total", "the bound must be 9,"),
        (lambda each: change(bound=each.bound - 1)(each), "$.bound", "bound/total", "and is 8"),
        (change(bound=9.0), "$.bound", "bound/total", r"and is 9\.0"),
        (lambda each: reprice(tick=10**12)(change(horizon=10**13)(each)), "$.resources", "bound/size", "would be"),
    ],
)
def test_a_tampered_certificate_is_refused(tamper: Tamper, path: str | None, rule: str, reason: str) -> None:
    instance = crossing()
    certificate = lower_bound(instance, steps=500)
    verify_bound(instance, certificate)
    with pytest.raises(Refusal, match=reason) as refused:
        verify_bound(instance, tamper(certificate))
    assert refused.value.rule == rule
    assert path in {None, refused.value.path}


def test_a_scale_is_a_power_of_two() -> None:
    scales = (*range(-8, 18), True, 1.0, 1 << 99, (1 << 99) + 1)
    assert [scale for scale in scales if bound_rules.is_scale(scale)] == [1, 2, 4, 8, 16, 1 << 99]


def test_a_certificate_is_about_no_instance_whose_digest_is_less_or_greater() -> None:
    certificate = lower_bound(crossing(), steps=2)
    for other in ("", "0" * 64, "f" * 64, certificate.instance.upper()):
        with pytest.raises(Refusal) as refused:
            verify_bound(crossing(), msgspec.structs.replace(certificate, instance=other))
        assert refused.value.rule == "bound/instance"


def test_prices_are_whole_numbers_at_ticks_before_the_horizon() -> None:
    assert [tick for tick in (-1, 0, 4, 5, 6, True, 1.0) if bound_rules.is_price(0, tick, 5)] == [0, 4]
    assert [price for price in (-1, 0, 1, 10**99, True, 1.0) if bound_rules.is_price(price, 0, 5)] == [0, 1, 10**99]


def test_a_robots_least_cost_is_claimed_as_no_more_than_it_is() -> None:
    claims = (None, -1, 0, 4, 5, 6, True, 4.0)
    assert [claimed for claimed in claims if bound_rules.is_least(claimed, 5)] == [-1, 0, 4, 5]
    assert [claimed for claimed in claims if bound_rules.is_least(claimed, None)] == [None]


def test_every_rule_of_bounds_is_listed_in_order() -> None:
    assert [each for each in vars(bound_rules).values() if isinstance(each, Rule)] == [*bound_rules.BOUND_RULES]


@pytest.mark.parametrize("price", ["1.5", "true", "1e3", '"1"', "null", "-1.0"])
def test_a_document_with_anything_but_whole_numbers_is_malformed(price: str) -> None:
    certificate = write(lower_bound(crossing(), steps=30)).decode()
    before, after = certificate.split('"resources":[["middle",', 1)
    tick, _, rest = after.split(",", 1)[0], *after.split("]", 1)
    malformed = f'{before}"resources":[["middle",{tick},{price}]{rest}'
    with pytest.raises(Refusal) as refused:
        read_bound(malformed.encode())
    assert (refused.value.path, refused.value.rule) == ("$.resources[0][2]", "document/shape")


def test_the_verifier_shares_nothing_with_the_finder_and_loads_nothing_compiled() -> None:
    names = {
        name
        for node in ast.walk(ast.parse(Path(page.__file__).read_text()))
        for name in ([node.module] if isinstance(node, ast.ImportFrom) else [])
    }
    ours = {name for name in names if name is not None and name.startswith("carp_")}
    assert ours == {
        "carp_spec",
        "carp_verify.bounds",
        "carp_verify.limits",
        "carp_spec.rule",
        "carp_verify.bound_rules",
        "carp_verify.bound_cuts",
        "carp_verify.refutation",
    }
    program = "import sys, carp_verify.verify_bound; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout.split()
    outside = {name.partition(".")[0] for name in loaded} - sys.stdlib_module_names
    assert {name for name in outside if not name.startswith("_")} <= {
        "carp_spec",
        "carp_verify",
        "msgspec",
        "typing_extensions",
    }
    assert not {"carp_optimum.bound", "carp_optimum.price_search", "carp_verify.bound_cuts"} & set(loaded)


def test_a_robot_in_a_resource_pays_its_price_once_and_all_at_most_price_times_capacity() -> None:
    for value, most, enter, leave, tick in product(range(3), (1, 2), range(3), range(1, 4), range(3)):
        graph = ResourceGraph((Resource("r", capacity=most), Resource("s")), ())
        instance = Instance(graph, (Robot("robot", "r", "s"),))
        certificate = BoundDocument(
            BOUND_FORMAT, digest(instance), 0, SCALE, HORIZON, (("r", tick, value),), (), (), ()
        )
        tariff = Tariff(instance, certificate)
        assert tariff.stay("r", enter, leave) == (value if enter <= tick < leave else 0) or leave <= enter
        assert tariff.worth == value * most


def test_who_leaves_r_for_s_at_the_tick_comes_from_there_or_stays_in_r_pays_for_the_exchange_once() -> None:
    graph = ResourceGraph((Resource("r"), Resource("s"), Resource("q")), (("r", "s"), ("r", "q")))
    instance = Instance(graph, (Robot("robot", "r", "s"),))
    certificate = BoundDocument(BOUND_FORMAT, digest(instance), 0, SCALE, HORIZON, (), (("r", "s", 2, 1),), (), ())
    tariff = Tariff(instance, certificate)
    for source, target, tick in product("rsq", "rsq", range(4)):
        assert tariff.move(source, target, tick) == ((source, target, tick) in {("r", "s", 2), ("s", "r", 2)})
    for resource, enter, leave in product("rs", range(4), range(5)):
        assert tariff.stay(resource, enter, leave) == (resource == "r" and enter < 2 < leave)


@pytest.mark.parametrize(
    ("start", "prices", "least"),
    [
        ("a", (("b", 1, 12), ("a", 0, 3), ("a", 1, 1), ("a", 2, 5)), 2 * SCALE + 4),
        ("a", (*(("a", tick, 50) for tick in range(1, 6)), *(("b", tick, 50) for tick in range(2, 6))), 6 * SCALE),
        ("b", tuple(("b", tick, 50) for tick in range(1, 6)), 6 * SCALE),
    ],
    ids=[
        "it waits where waiting has a price",
        "it passes the place where it parks later",
        "it leaves the place where it stands and parks",
    ],
)
def test_the_cheapest_plan_is_found_where(start: str, prices: tuple[tuple[str, int, int], ...], least: int) -> None:
    lane = ResourceGraph((Resource("a"), Resource("b"), Resource("c")), (("a", "b"), ("b", "c")))
    instance = Instance(lane, (Robot("robot", start, "b"),), "park")
    empty = BoundDocument(BOUND_FORMAT, digest(instance), 0, SCALE, HORIZON, prices, (), (), ())
    assert completed(instance, empty).robots == (("robot", least),)


@pytest.mark.parametrize("place", [("a", "b"), ("b", "a")])
def test_an_exchange_needs_moves_both_ways(place: tuple[str, str]) -> None:
    one_way = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),), directed=True)
    instance = Instance(one_way, (Robot("r", "a", "b"),))
    certificate = msgspec.structs.replace(lower_bound(instance, steps=1), horizon=3, exchanges=((*place, 1, 1),))
    with pytest.raises(Refusal, match="must be a resource, or two with a move each way") as refused:
        verify_bound(instance, certificate)
    assert (refused.value.path, refused.value.rule) == ("$.exchanges[0]", "bound/price")
