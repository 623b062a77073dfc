"""Plans made tick by tick keep the law, and are found where no order of robots works."""

from dataclasses import replace

import pytest
from hypothesis import given
from tests.optimized.crowds.measuring import measured, on_grid

from carp_optimized import plan
from carp_optimized.crowds.crowd import is_stepwise
from carp_optimized.crowds.improving import total_of
from carp_optimized.crowds.stays import solution_along
from carp_optimized.lacam import search
from carp_optimized.lacam.search import STEPS, Search, plans_by_steps
from carp_spec import Carp, Instance, Resource, ResourceGraph, Robot, Solution, judge
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.testing.strategies import Sizes, instances


def keeps_the_law(instance: Instance, steps: int = STEPS) -> bool:
    """Whether plans of all robots are found that break no rule."""
    plans = plans_by_steps(instance, steps)
    if plans is None:
        return False
    verdict = judge(instance, Solution.of(instance, plans))
    assert verdict.valid
    return not verdict.unplanned


def row_with_pockets(length: int, pockets: tuple[int, ...], robots: tuple[tuple[int, int], ...]) -> Instance:
    """Cells in a row, pockets beside some of them, and robots that park, from cell to cell."""
    resources = [Resource(f"c{k}") for k in range(length)] + [Resource(f"p{k}") for k in pockets]
    edges = [(f"c{k}", f"c{k + 1}") for k in range(length - 1)] + [(f"c{k}", f"p{k}") for k in pockets]
    fleet = tuple(Robot(f"r{k}", f"c{start}", f"c{goal}") for k, (start, goal) in enumerate(robots))
    return Instance(ResourceGraph(tuple(resources), tuple(edges)), fleet, "park")


@pytest.mark.parametrize("seed", range(3))
def test_robots_on_every_cell_of_a_grid_get_plans(seed: int) -> None:
    assert keeps_the_law(on_grid(6, 36, "vanish", seed))
    assert keeps_the_law(on_grid(8, 32, "park", seed))


def test_robots_that_no_order_plans_get_plans() -> None:
    instance = on_grid(4, 14, "park", 1)
    assert plan(instance, Carp()).unplanned
    assert keeps_the_law(instance)


def test_two_robots_swap_at_a_far_pocket() -> None:
    instance = row_with_pockets(12, (9,), ((0, 1), (1, 0)))
    assert keeps_the_law(instance, steps=60)


def test_room_grows_with_the_demands_of_places_that_many_lead_to(monkeypatch: pytest.MonkeyPatch) -> None:
    edges = tuple(("hub", leaf) for leaf in range(200))
    graph = ResourceGraph((Resource("hub"), *map(Resource, range(200))), edges)
    star = Instance(graph, tuple(Robot(f"r{k}", k, k + 100) for k in range(20)))
    roomy = plans_by_steps(star)
    monkeypatch.setattr(search, "ROOM", 1)
    monkeypatch.setattr(search, "DEMANDED", 1)
    assert plans_by_steps(star) == roomy is not None
    monkeypatch.setattr(search, "MOST", 1)
    assert plans_by_steps(star) is None


@pytest.mark.parametrize("seed", range(8))
def test_robots_on_a_tree_make_room_for_one_another(seed: int) -> None:
    assert keeps_the_law(on_grid(6, 10, "park", seed, map=0), steps=1000)


def test_the_best_of_several_next_configurations_leads_to_shorter_plans() -> None:
    instance = on_grid(20, 300)
    crowd = measured(instance)

    def total(samples: int) -> int:
        search = Search(crowd, samples=samples)
        search.go(STEPS)
        assert search.paths is not None
        assert judge(instance, solution_along(instance, instance.robots, search.paths)).valid
        return total_of(search.paths)

    assert 20 * total(10) < 19 * total(1)


def test_robots_that_cannot_pass_get_no_plans() -> None:
    assert plans_by_steps(row_with_pockets(4, (), ((0, 3), (3, 0)))) is None


@pytest.mark.parametrize(
    "instance",
    [
        grid_instance(Grid(), Fleet(robots=2), Traits(capacity=Range(2, 2))),
        grid_instance(Grid(), Fleet(robots=2), Traits(duration=Range(2, 2))),
        replace(on_grid(3, 2, "park"), following="forbidden"),
        replace(on_grid(3, 1, "park"), robots=(replace(on_grid(3, 1, "park").robots[0], release=1),)),
        replace(on_grid(3, 1, "park"), robots=(replace(on_grid(3, 1, "park").robots[0], pace=2),)),
    ],
)
def test_other_instances_are_left_to_other_planners(instance: Instance) -> None:
    assert not is_stepwise(instance)
    assert plans_by_steps(instance) is None


STEPWISE = Sizes(resources=7, robots=5, capacity=1, duration=1, release=0, pace=1)


@given(instances(STEPWISE).filter(is_stepwise))
def test_plans_break_no_rule_and_are_the_same_again(instance: Instance) -> None:
    found = plans_by_steps(instance, steps=200)
    assert found == plans_by_steps(instance, steps=200)
    if found is not None:
        verdict = judge(instance, Solution.of(instance, found))
        assert (verdict.valid, verdict.unplanned) == (True, 0)
