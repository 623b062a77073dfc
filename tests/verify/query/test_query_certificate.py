"""The checker of query certificates: it accepts what is true and shown, and nothing else."""

import tracemalloc
from collections.abc import Sequence
from dataclasses import replace
from time import process_time

import msgspec
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tests.spec.making import plan_of
from tests.verify.query.examples import (
    EAST,
    OVER_STOPS,
    QUESTIONS,
    VANISHING,
    WESTWARDS,
    Question,
    beside,
    fleets,
    town,
)

import carp_optimized.certifying
import carp_reference
import carp_verify.query.rules
from carp_spec import Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit
from carp_spec.documents.query_certificates import QUERY_FORMAT, QueryCertificateDocument, ServedLayer, certificate_of
from carp_spec.model import Following, Group
from carp_spec.windows import Window
from carp_verify.query.verify import Traffic, verify_query
from carproof.testing.strategies import FleetUnderWay, Sizes, fleets_under_way

SMALL_TICKS = st.integers(-1, 12)


def arrival(plan: Plan | None) -> int | None:
    return None if plan is None else plan.visits[-1].enter


@pytest.mark.parametrize("name", QUESTIONS)
def test_an_honest_certificate_is_accepted(name: str) -> None:
    question = QUESTIONS[name]
    plan, certificate = question.certified()
    assert verify_query(question.instance, question.solution, certificate) == arrival(plan)


@given(fleets_under_way(Sizes(resources=5, robots=4, release=3, groups=2, stops=3, service=4)))
def test_certificates_of_both_planners_are_accepted_with_the_arrival_of_the_plan(fleet: FleetUnderWay) -> None:
    for question in fleets(Question(fleet.instance, fleet.solution, fleet.robot, fleet.now)):
        certifier = carp_optimized.certifying.Certifier(question.instance)
        certifier.commit([plan for plan in question.solution.plans if plan.robot != question.robot])
        best = carp_reference.query(question.instance, question.solution.plans, question.robot, question.now)
        for plan, certificate in (
            question.certified(),
            certifier.certify(question.robot, question.followed, question.now),
        ):
            assert plan == best
            assert verify_query(question.instance, question.solution, certificate) == arrival(best)


@given(fleets_under_way(Sizes(groups=2, stops=3, service=3)), st.data())
def test_whatever_is_accepted_is_true(fleet: FleetUnderWay, data: st.DataObject) -> None:
    """The certificate of another question, with labels lost or moved, another bound, and a changed potential."""
    question = Question(fleet.instance, fleet.solution, fleet.robot, fleet.now)
    other = replace(question, now=data.draw(st.sampled_from([0, fleet.now])))
    other = replace(other, robot=data.draw(st.sampled_from([*fleet.instance.robot])))
    certificate = other.certified()[1]
    layers = [_changed(layer, data) for layer in certificate.layers]
    layers = layers[: data.draw(st.sampled_from([len(layers), len(layers), 1]))]
    changed = certificate_of(
        data.draw(st.sampled_from([certificate.robot, question.robot])),
        data.draw(st.sampled_from([0, fleet.now])),
        data.draw(st.sampled_from([certificate.bound, None]) | SMALL_TICKS),
        layers,
    )
    assert question.rule_broken(changed) is not None or question.is_true(changed)


def _changed(layer: ServedLayer, data: st.DataObject) -> ServedLayer:
    """The layer, or one with labels lost or moved, or with a changed potential."""

    def moved() -> int:
        return data.draw(st.sampled_from([0, 0, 0, 1, -1]))

    labels = tuple((resource, tick + moved()) for resource, tick in layer.labels)
    labels = labels[: data.draw(st.integers(0, len(labels)))]
    potential = tuple((resource, ticks + moved()) for resource, ticks in layer.potential)
    return ServedLayer(
        data.draw(st.sampled_from([layer.labels, labels])),
        data.draw(st.sampled_from([layer.potential, potential, ()])),
    )


@pytest.mark.parametrize("name", OVER_STOPS)
def test_of_a_certificate_over_stops_nothing_can_be_left_out_or_changed(name: str) -> None:
    """A label is needed, a lower potential proves less and a higher one would prove too much."""
    question = QUESTIONS[name]
    honest = question.certified()[1]
    layers = honest.layers

    def broken_with(served: int, labels: object, potential: object) -> str | None:
        layer = ServedLayer(labels, potential)  # type: ignore[arg-type]
        forged = certificate_of(
            honest.robot, honest.now, honest.bound, [*layers[:served], layer, *layers[served + 1 :]]
        )
        return question.rule_broken(forged)

    for served, (labels, potential) in enumerate((each.labels, each.potential) for each in layers):
        for k, (resource, tick) in enumerate(labels):
            assert broken_with(served, (*labels[:k], *labels[k + 1 :]), potential) == "query-certificate/closed"
            later = (*labels[:k], (resource, tick + 1), *labels[k + 1 :])
            assert broken_with(served, later, potential) == "query-certificate/closed"
        for k, (resource, ticks) in enumerate(potential):
            higher = (*potential[:k], (resource, ticks + 1), *potential[k + 1 :])
            assert broken_with(served, labels, higher) == "query-certificate/potential"
            assert broken_with(served, labels, (*potential[:k], *potential[k + 1 :])) is not None
    if honest.bound is not None:
        assert question.rule_broken(msgspec.structs.replace(honest, bound=honest.bound + 1)) is not None


@pytest.mark.parametrize("labels", [[("b", 1)], [("b", 2)], *([(cell, tick) for cell in "abcde"] for tick in (0, -1))])
def test_labels_that_lead_on_to_no_labels_show_nothing(labels: Sequence[tuple[str, int]]) -> None:
    question = QUESTIONS["alone"]
    later = msgspec.structs.replace(question.certified()[1], bound=5, labels=tuple(labels))
    assert question.rule_broken(later) == "query-certificate/closed"


def test_plans_that_break_a_rule_or_are_of_one_robot_or_of_none_are_refused() -> None:
    certificate = QUESTIONS["head-on"].certified()[1]
    jumping, stranger = plan_of("s", ("d", 0, 1), ("a", 1, 2)), plan_of("moon", ("a", 0, 1))
    for plans in ((jumping,), (WESTWARDS, WESTWARDS), (stranger,)):
        assert beside(VANISHING, "r", *plans).rule_broken(certificate) == "query-certificate/plans"


TICKS = st.integers(1, 6)
WAYS = st.lists(st.tuples(st.integers(0, 12), TICKS | st.none(), TICKS | st.none(), st.booleans()), max_size=6)
LAST = 30


@example([(2, 2, 4, False), (5, 3, 3, True)], 1, 2, "allowed")  # b is full from the tick on at which the group is not
@example([(2, 2, 4, False), (5, 2, 3, True)], 1, 2, "allowed")  # and before that
@example([(2, 2, 2, False)], 2, 2, "forbidden")  # who goes on within the group takes up its room once
@given(WAYS, st.integers(1, 3), st.none() | st.integers(1, 3), st.sampled_from(("allowed", "forbidden")))
def test_the_free_windows_are_those_of_counting_robots_tick_by_tick(
    ways: Sequence[tuple[int, int | None, int | None, bool]], capacity: int, together: int | None, following: Following
) -> None:
    """Those of b, which may be in a group with c: robots are in b, then perhaps in c, or the other way round."""
    instance = replace(town("vanish", capacity=capacity), following=following)
    if together is not None:
        instance = replace(instance, graph=replace(instance.graph, groups=(Group("g", ("b", "c"), together),)))
    traffic = Traffic(instance)
    own, grouped = [0] * (LAST + 1), [0] * (LAST + 1)
    for robot, (enter, first, second, turned) in enumerate(ways):
        here, there = ("c", "b") if turned else ("b", "c")
        visits = [Visit(here, enter, None if first is None else enter + first)]
        if first is not None:
            visits.append(Visit(there, enter + first, None if second is None else enter + first + second))
        traffic.commit(Plan(robot, tuple(visits)))
        for tick in range(LAST + 1):
            at = {
                each.resource
                for each in visits
                if each.enter <= tick and (each.leave is None or tick < each.leave + instance.gap)
            }
            own[tick] += "b" in at
            grouped[tick] += bool(at)
    has_room = [own[at] < capacity and (together is None or grouped[at] < together) for at in range(LAST + 1)]
    free = [has_room[tick] and has_room[tick + instance.gap] for tick in range(LAST)]
    for tick in range(LAST):
        ahead = [at for at in range(tick, LAST) if at == tick or free[at] != free[at - 1]]
        starts = [at for at in ahead if free[at]]
        ends = [next((end for end in range(at, LAST) if not free[end]), None) for at in starts]
        began = max((at + 1 for at in range(tick) if not free[at]), default=0)
        expected = [Window(began if at == tick else at, end) for at, end in zip(starts, ends, strict=True)]
        assert list(traffic.windows("b", tick)) == expected
        assert traffic.window_at("b", tick) == (expected[0] if free[tick] else None)


def test_a_size_that_is_too_large_is_refused_before_anything_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    question = QUESTIONS["head-on"]
    certificate = question.certified()[1]
    monkeypatch.setattr(carp_verify.query.rules, "LARGEST_CHECK", 10)
    assert question.rule_broken(certificate) == "query-certificate/size"
    far = msgspec.structs.replace(certificate, labels=certificate.labels * 3_000_000)
    monkeypatch.undo()
    assert question.rule_broken(far) == "query-certificate/size"


def test_labels_that_lead_nowhere_and_the_moves_of_each_stop_count_in_the_size(monkeypatch: pytest.MonkeyPatch) -> None:
    one_way = ResourceGraph((Resource("s"), Resource("g")), (("s", "g"),), directed=True)
    instance = Instance(one_way, (Robot("r", "s", "g"),))
    labels, potential = (("g", 1),) * 10, (("s", 1), ("g", 0))
    certificate = QueryCertificateDocument(QUERY_FORMAT, "r", 0, 1, labels, potential)
    nobody = Solution((), (), ("r",))
    monkeypatch.setattr(carp_verify.query.rules, "LARGEST_CHECK", 10 + 10 + 3)
    assert verify_query(instance, nobody, certificate) == 1
    monkeypatch.setattr(carp_verify.query.rules, "LARGEST_CHECK", 10 + 10 + 3 - 1)
    with pytest.raises(Refusal, match="23 windows and moves"):
        verify_query(instance, nobody, certificate)


def test_labels_and_potentials_of_resources_that_there_are_not_mean_nothing() -> None:
    question = QUESTIONS["head-on"]
    certificate = question.certified()[1]
    more = msgspec.structs.replace(
        certificate,
        labels=(*certificate.labels, ("moon", 0), ("a", -5), ("a", 10**99)),
        potential=(*certificate.potential, ("moon", 1)),
    )
    assert question.rule_broken(more) is None


@pytest.mark.parametrize("name", ["head-on", "ended"])
def test_a_bound_that_is_lower_is_accepted_too(name: str) -> None:
    question = QUESTIONS[name]
    certificate = question.certified()[1]
    assert certificate.bound is not None
    for bound in (certificate.bound - 1, 0, -(10**99)):
        assert question.rule_broken(msgspec.structs.replace(certificate, bound=bound)) is None


def test_ticks_of_any_size_are_checked() -> None:
    far = 10**90
    slow = town("vanish", Robot("r", "a", "d", release=far, pace=far))
    question = beside(slow, "r")
    assert verify_query(slow, question.solution, question.certified()[1]) == 5 * far


def test_a_window_late_in_time_needs_a_label_if_the_robot_fits_into_it() -> None:
    instance = town("vanish", Robot("r", "a", "c"), Robot("s", "c", "d"), Robot("t", "e", "c"))
    before, behind = plan_of("s", ("c", 0, 10), ("d", 10, 11)), plan_of("t", ("e", 0, 12), ("b", 12, 14), ("c", 14, 16))
    question = beside(instance, "r", before, behind)
    plan, certificate = question.certified()
    assert arrival(plan) == 10
    later = msgspec.structs.replace(certificate, bound=16, labels=(*certificate.labels, ("b", 14)))
    assert question.rule_broken(later) == "query-certificate/closed"


def test_a_plan_that_has_ended_is_as_early_as_its_last_visit() -> None:
    question = beside(VANISHING, "s", WESTWARDS, now=20)
    assert verify_query(VANISHING, question.solution, question.certified()[1]) == 4


def test_where_following_is_forbidden_a_plan_that_keeps_no_free_tick_is_no_rival() -> None:
    instance = replace(town("vanish", EAST, replace(EAST, id="s")), following="forbidden")
    question = beside(instance, "r", plan_of("s", ("a", 0, 1), ("b", 1, 2), ("c", 2, 4), ("d", 4, 5)))
    plan, certificate = question.certified()
    assert (plan, certificate.bound) == (None, None)
    assert verify_query(instance, question.solution, certificate) is None


def test_many_stays_in_one_resource_are_counted_once() -> None:
    def seconds(many: int) -> float:
        hall = ResourceGraph((Resource("hall", many),), ())
        robots = tuple(Robot(number, "hall", "hall", release=many - number) for number in range(many))
        traffic = Traffic(Instance(hall, robots, "park"))
        started = process_time()
        for robot in robots:
            traffic.commit(Plan(robot.id, (Visit("hall", robot.release, None),)))
        assert list(traffic.windows("hall", 0)) == [Window(0, many)]
        return process_time() - started

    assert min(seconds(16_000) for _ in range(3)) < 20 * min(seconds(2_000) for _ in range(3))


def test_moves_between_many_groups_take_no_memory_for_each_two() -> None:
    groups = tuple(Group(f"{each}{number}", (each,)) for each in "ab" for number in range(500))
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),), groups=groups)
    traffic = Traffic(Instance(graph, ()))
    tracemalloc.start()
    for tick in range(4):
        traffic.commit(Plan(tick, (Visit("a", 2 * tick, 2 * tick + 1), Visit("b", 2 * tick + 1, 2 * tick + 2))))
    assert [traffic.is_exchange(tick, "b", "a") for tick in range(4)] == [False, True, False, True]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10_000_000
