"""Random plans, right and wrong."""

from hypothesis import settings
from hypothesis import strategies as st
from tests.profiles import draws

from carp_spec import Instance, Plan, RobotId, Solution, Visit
from carproof.testing.strategies import Sizes, instances

FEWER = settings(max_examples=draws(250))
"""For tests with large examples."""

IDS = st.one_of(st.integers(-5, 5), st.text(max_size=3))
NOWHERE = "nowhere"
SIZES = Sizes(capacity=3, groups=2, stops=3, service=3)


@st.composite
def walks(draw: st.DrawFn, instance: Instance, robot: RobotId) -> Plan:
    """A plan that follows the rules by and large, and breaks any of them now and then."""
    graph = instance.graph
    anywhere = st.sampled_from([*graph.index, NOWHERE])
    slip = st.sampled_from([0, 0, 0, 0, 0, 1, -1])
    resource = draw(st.just(instance.robot[robot].start) | anywhere)
    tick = instance.robot[robot].release + draw(slip)
    visits: list[Visit] = []
    for _ in range(draw(st.integers(0, 5))):
        stay = draw(st.integers(-1, 6) | st.none())
        visits.append(Visit(resource, tick, None if stay is None else tick + stay))
        tick += (0 if stay is None else stay) + draw(slip)
        following = graph.successors.get(resource, ())
        resource = draw(st.sampled_from(following) if following and draw(slip) == 0 else anywhere)
    if draw(st.booleans()) and visits:
        stop = instance.robot[robot].stops[-1]
        leave = None if instance.after_goal == "park" else visits[-1].enter + instance.stay(robot, stop)
        visits[-1] = Visit(stop.resource, visits[-1].enter, leave)
    return Plan(robot, tuple(visits))


@st.composite
def instances_with_plans(draw: st.DrawFn) -> tuple[Instance, tuple[Plan, ...]]:
    """An instance and plans of some of its robots; a robot may have two."""
    instance = draw(instances(SIZES))
    robots = draw(st.lists(st.sampled_from(list(instance.robot)), max_size=5)) if instance.robots else []
    return instance, tuple(draw(walks(instance, robot)) for robot in robots)


TICKS = st.integers(-3, 12) | st.integers()


@st.composite
def solutions(draw: st.DrawFn) -> Solution:
    """Any solution that a document can hold, about any robots and resources."""
    visits = st.builds(Visit, IDS, TICKS, st.none() | TICKS)
    plans = st.builds(Plan, IDS, st.lists(visits, max_size=4).map(tuple))
    robots = st.lists(IDS, max_size=4).map(tuple)
    return Solution(draw(st.lists(plans, max_size=4).map(tuple)), draw(robots), draw(robots))
