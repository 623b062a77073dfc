"""The decisions of the neighbourhood planner: exact distances, and the choices made by them."""

from fractions import Fraction
from itertools import islice
from math import isqrt

from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import instance_on, plan_of
from tests.spec.strategies import FEWER

from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Visit
from carp_spec.neighbourhood_rules import distance, nearest, neighbourhood_orders
from carp_spec.permutations import splitmix64

PLACES = tuple(
    Resource(name, x=x, y=y)
    for name, x, y in (("a", 0, 0), ("b", 3, 4), ("c", -1, 1), ("d", 1000, -7), ("e", None, None), ("f", 2, 0))
)


@st.composite
def journeys(draw: st.DrawFn) -> tuple[Robot, Plan]:
    """A robot and a plan that starts at its release and ends at its goal; the moves do not matter here."""
    id = draw(st.integers())
    release = draw(st.integers(0, 6))
    names = draw(st.lists(st.sampled_from("abcdef"), min_size=1, max_size=4))
    stays = draw(st.lists(st.integers(1, 5), min_size=len(names), max_size=len(names)))
    enters = [release + sum(stays[:at]) for at in range(len(names))]
    visits = tuple(Visit(name, enter, enter + stay) for name, enter, stay in zip(names, enters, stays, strict=True))
    return Robot(id, names[0], names[-1], release), Plan(id, visits)


def place(robot: Robot, plan: Plan, tick: int) -> tuple[int, int]:
    """Where a robot is at the tick, found by walking through its plan."""
    at = robot.start if tick < robot.release else robot.goal
    for visit in plan.visits:
        if visit.leave is not None and visit.enter <= tick < visit.leave:
            at = visit.resource
    resource = next(each for each in PLACES if each.id == at)
    return (0, 0) if resource.x is None or resource.y is None else (resource.x, resource.y)


@FEWER
@given(one=journeys(), other=journeys())
def test_distance_is_the_mean_of_the_distances_tick_by_tick(one: tuple[Robot, Plan], other: tuple[Robot, Plan]) -> None:
    (robot, plan), (second, other_plan) = one, other
    if robot.id == second.id:
        second, other_plan = robot, plan
    first = min(robot.release, second.release)
    last = max(plan.visits[-1].enter, other_plan.visits[-1].enter)
    terms = []
    for tick in range(first, last + 1):
        (x, y), (u, v) = place(robot, plan, tick), place(second, other_plan, tick)
        terms.append(isqrt(((x - u) ** 2 + (y - v) ** 2) * 2**32))
    instance = Instance(ResourceGraph(PLACES, ()), (robot, second))
    expected = Fraction(sum(terms), len(terms))
    assert distance(instance, plan, other_plan) == distance(instance, other_plan, plan) == expected


@given(dx=st.integers(-(10**9), 10**9), dy=st.integers(-(10**9), 10**9))
def test_each_term_is_the_floor_of_the_scaled_euclidean_distance(dx: int, dy: int) -> None:
    graph = ResourceGraph((Resource("a", x=5, y=-5), Resource("b", x=5 + dx, y=dy - 5)), ())
    instance = instance_on(graph, Robot("r", "a", "a"), Robot("s", "b", "b"))
    term = distance(instance, plan_of("r", ("a", 0, 1)), plan_of("s", ("b", 0, 1)))
    assert term.denominator == 1
    assert term**2 <= 2**32 * (dx**2 + dy**2) < (term + 1) ** 2


@FEWER
@given(st.lists(st.lists(st.integers(0, 9).map(Fraction), min_size=1, max_size=3), min_size=1, max_size=5))
def test_nearest_is_the_first_with_the_least_distance_to_any_member(distances: list[list[Fraction]]) -> None:
    chosen = nearest(distances)
    least = min(member for robot in distances for member in robot)
    assert least in distances[chosen]
    assert not any(least in robot for robot in distances[:chosen])


def test_means_are_compared_as_fractions() -> None:
    third = Fraction(10**30, 3 * 10**30 - 1)
    assert nearest([[third], [Fraction(1, 3)]]) == 1


def test_rounds_of_one_robot_share_its_stream() -> None:
    stream = splitmix64(3)
    first, second = (list(neighbourhood_orders(4, 5, stream)) for _ in range(2))
    assert first != second
    assert list(islice(neighbourhood_orders(3, None, stream), 2)) == [(0, 1, 2), (0, 2, 1)]


def test_dividing_by_one_term_too_few_takes_the_farther_robot_for_the_nearer() -> None:
    """An error of the paper, with the figures of docs/explanation/errata.md."""
    graph = ResourceGraph((Resource("a", x=0, y=0), Resource("b", x=5, y=0), Resource("c", x=6, y=0)), ())
    robots = (Robot("new", "a", "a"), Robot("near", "b", "b"), Robot("far", "c", "c"))
    instance = Instance(graph, robots)
    new = plan_of("new", ("a", 0, 1))
    near, far = plan_of("near", ("b", 0, 1), ("b", 1, 2)), plan_of("far", ("c", 0, 10), ("c", 10, 11))
    ours = [distance(instance, new, plan) / 2**16 for plan in (near, far)]
    assert ours == [5, 6]
    papers = [mean * terms / (terms - 1) for mean, terms in zip(ours, (2, 11), strict=True)]
    assert papers == [10, Fraction(66, 10)]
