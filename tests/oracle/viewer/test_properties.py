"""Every solution that can be read can be seen: sound ones, broken ones and nonsense."""

from collections import Counter
from collections.abc import Iterable

from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.viewer.viewing import picture_of, scene_of
from tests.profiles import draws

from carp_spec import Instance, Plan, Solution, Visit, judge
from carproof.testing.strategies import instances
from carproof.viewer.lanes import lasts
from carproof.viewer.page import view
from carproof.viewer.stills import view_chart, view_map

TICKS = st.integers(-5, 20)
LATEST = 25
FEW = settings(max_examples=draws(60))


@st.composite
def nonsense(draw: st.DrawFn) -> tuple[Instance, Solution]:
    """An instance, and plans that visit anything at any time, of anybody."""
    instance = draw(instances())
    robot = st.sampled_from([*instance.robot, "nobody", 77])
    resource = st.sampled_from([*instance.graph.index, "nowhere", 88])
    visits = st.lists(st.builds(Visit, resource, TICKS, st.none() | TICKS), max_size=4).map(tuple)
    plans = st.lists(st.builds(Plan, robot, visits), max_size=4).map(tuple)
    robots = st.lists(robot, max_size=3).map(tuple)
    return instance, draw(st.builds(Solution, plans, robots, robots))


@FEW
@given(nonsense())
def test_the_page_shows_every_visit_and_violation(case: tuple[Instance, Solution]) -> None:
    instance, solution = case
    scene = scene_of(view(instance, solution, title="any").decode())
    shown = sorted(
        (track["label"], scene["places"][scene["stands"][stand]["place"]]["label"], enter, str(leave))
        for track in scene["tracks"]
        for stand, enter, leave in track["stays"]
    )
    assert shown == sorted(
        (str(plan.robot), str(visit.resource), visit.enter, str(visit.leave))
        for plan in solution.plans
        for visit in plan.visits
    )
    assert [each["message"] for each in scene["violations"]] == [
        each.message for each in judge(instance, solution).violations
    ]


@FEW
@given(nonsense())
def test_no_two_robots_stand_in_one_lane_at_a_time(case: tuple[Instance, Solution]) -> None:
    scene = scene_of(view(*case, title="any").decode())
    assert none_overlap((stand, enter, leave) for track in scene["tracks"] for stand, enter, leave in track["stays"])


def none_overlap(stays: Iterable[tuple[int, int, int | None]]) -> bool:
    taken = Counter(
        (lane, tick)
        for lane, enter, leave in stays
        if lasts(enter, leave)
        for tick in range(enter, LATEST if leave is None else leave)
    )
    return max(taken.values(), default=1) == 1


@FEW
@given(nonsense(), TICKS)
def test_the_stills_show_who_is_in_a_resource_of_the_map(case: tuple[Instance, Solution], tick: int) -> None:
    instance, solution = case
    there = [
        [visit for visit in plan.visits if visit.enter <= tick and (visit.leave is None or tick < visit.leave)]
        for plan in solution.plans
    ]
    on_the_map = [visits for visits in there if visits and visits[-1].resource in instance.graph.index]
    assert len(picture_of(view_map(instance, solution, at=tick, title="any").decode())[-1]) == len(on_the_map)
    assert picture_of(view_chart(instance, solution, title="any").decode()).get("class") == "chart"
