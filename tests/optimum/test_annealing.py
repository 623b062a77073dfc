"""Simulated annealing of a polish: lawful and reproducible plans, never worse than those given, and no dead ends."""

from collections.abc import Callable
from itertools import count, pairwise

from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import worth

from carp_optimized import plan, polish
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.annealing import anneal
from carp_optimized.improve.repair import repair
from carp_optimized.polishing import play, to_polish
from carp_optimized.state.arrays import CHANCE
from carp_spec import Carp, Instance, Resource, ResourceGraph, Robot, judge, total_cost
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

ROUNDS = 4000


def ticking() -> Callable[[], float]:
    """A clock that is a second later at each look, so that one call of the planner takes a second."""
    seconds = count()
    return lambda: next(seconds)


def lane_with_robots_at_both_ends(robots: int, length: int) -> Instance:
    """As many robots at each end go through the lane to goals of their own beyond the other end."""
    lane = [f"lane-{place}" for place in range(length)]
    ends = [(side, f"{side}-{number}") for number in range(robots) for side in ("left", "right")]
    near = {"left": lane[0], "right": lane[-1]}
    far = {"left": lane[-1], "right": lane[0]}
    edges = [*pairwise(lane)]
    edges += [edge for side, name in ends for edge in ((f"from-{name}", near[side]), (far[side], f"to-{name}"))]
    names = [*lane, *(name for _, end in ends for name in (f"from-{end}", f"to-{end}"))]
    graph = ResourceGraph(tuple(Resource(name) for name in names), tuple(edges))
    return Instance(graph, tuple(Robot(name, f"from-{name}", f"to-{name}") for _, name in ends))


@given(planned_instances(Sizes(resources=8, robots=12)), st.integers(1, 4), st.integers(0, 2**64 - 1))
def test_annealed_plans_are_lawful_and_never_worse(planned: PlannedInstance, seconds: int, seed: int) -> None:
    instance = planned.instance
    annealed = anneal(instance, planned.solution, seconds, seed=seed, clock=ticking())
    assert judge(instance, annealed).valid
    assert worth(instance, annealed) <= worth(instance, planned.solution)
    assert annealed == anneal(instance, planned.solution, seconds, seed=seed, clock=ticking())


def test_rounds_that_raise_the_total_lead_out_of_where_a_polish_ends() -> None:
    instance = grid_instance(Grid(12, 12, map=4), Fleet(robots=50, seed=1))
    start = repair(instance, plan(instance, Carp()))
    polished = [polish(instance, start, iterations=4 * ROUNDS, seed=seed) for seed in range(3)]
    annealed = [anneal(instance, start, 4 * ROUNDS // 50, seed=seed, clock=ticking()) for seed in range(3)]
    assert sum(total_cost(instance, each.plans) for each in annealed) < sum(
        total_cost(instance, each.plans) for each in polished
    )


def test_robots_that_share_a_lane_in_both_directions_learn_to_take_turns() -> None:
    instance = lane_with_robots_at_both_ends(robots=10, length=8)
    start = plan(instance, Carp())
    costs = [total_cost(instance, polish(instance, start, iterations=200, seed=seed).plans) for seed in range(4)]
    assert total_cost(instance, start.plans) == 1700
    assert max(costs) > min(costs) == 440
    for seed in range(4):
        fleet = PlannedFleet(instance)
        fleet.commit(start.plans)
        polishing = to_polish(fleet, seed)
        polishing.fields.counts[CHANCE] = 1
        play(fleet, polishing, 200)
        assert fleet.worth == (0, 440)


def test_a_time_ends_by_the_clock_and_robots_left_out_are_planned_first() -> None:
    instance = grid_instance(Grid(map=5), Fleet(robots=100, seed=1))
    given = plan(instance, Carp())
    assert given.unplanned
    played: list[int] = []
    after = anneal(instance, given, 800, clock=ticking(), advance=lambda *at: played.append(at[0]))
    assert not after.unplanned
    assert played[0] == 50
    assert len(played) < 800
