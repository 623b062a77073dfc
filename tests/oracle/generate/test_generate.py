"""The paper's maps, warehouses and fleets: shape, nesting, and equal results for equal seeds."""

from hashlib import sha256

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.running import Run

from carp_spec.instance_rules import instance_faults
from carproof import Instance, Refusal, ResourceId
from carproof.generate import Fleet, Grid, Range, Traits, Warehouse, grid_instance, warehouse_instance

SEEDS = st.integers(min_value=0, max_value=2**64 - 1)
SIDES = st.integers(min_value=1, max_value=7)


def edges_of(grid: Grid) -> set[tuple[ResourceId, ResourceId]]:
    return set(grid_instance(grid).graph.edges)


def graph_of(instance: Instance) -> "nx.Graph[ResourceId]":
    graph: nx.Graph[ResourceId] = nx.Graph(list(instance.graph.edges))
    graph.add_nodes_from(resource.id for resource in instance.graph.resources)
    return graph


def test_the_papers_maps_grow_from_a_tree_to_the_grid() -> None:
    counts = [len(edges_of(Grid(map=number))) for number in range(21)]
    assert counts == [399 + 361 * number // 20 for number in range(21)]
    assert edges_of(Grid(map=20, map_seed=1)) == edges_of(Grid(map=20, map_seed=2))
    assert edges_of(Grid(map=0, map_seed=1)) != edges_of(Grid(map=0, map_seed=2))


@given(SIDES, SIDES, st.integers(0, 19), SEEDS)
def test_maps_of_one_seed_are_nested_and_connected(width: int, height: int, number: int, seed: int) -> None:
    smaller = Grid(width, height, number, seed)
    assert edges_of(smaller) <= edges_of(Grid(width, height, number + 1, seed))
    assert nx.is_connected(graph_of(grid_instance(smaller)))
    assert nx.is_tree(graph_of(grid_instance(Grid(width, height, 0, seed))))


@given(SEEDS, st.integers(0, 20), SEEDS)
def test_an_assignment_is_the_same_on_every_map(map_seed: int, number: int, seed: int) -> None:
    fleet = Fleet(robots=9, seed=seed)
    assert grid_instance(Grid(3, 3, number, map_seed), fleet).robots == grid_instance(Grid(3, 3), fleet).robots


@given(st.integers(0, 25), SEEDS)
def test_starts_are_distinct_and_goals_are_distinct_unless_told_otherwise(robots: int, seed: int) -> None:
    fleet = grid_instance(Grid(5, 5), Fleet(robots=robots, seed=seed)).robots
    assert len({robot.start for robot in fleet}) == len({robot.goal for robot in fleet}) == robots
    with pytest.raises(Refusal, match="generate/ends"):
        grid_instance(Grid(5, 5), Fleet(robots=26, seed=seed))
    assert len(grid_instance(Grid(5, 5), Fleet(robots=26, seed=seed, distinct="none")).robots) == 26


@given(SEEDS, st.integers(1, 8))
def test_a_smaller_fleet_is_the_beginning_of_a_larger_one(seed: int, robots: int) -> None:
    larger = grid_instance(Grid(3, 3), Fleet(robots=9, seed=seed, pace=Range(1, 3))).robots
    smaller = grid_instance(Grid(3, 3), Fleet(robots=robots, seed=seed, pace=Range(1, 3))).robots
    assert [(robot.start, robot.goal) for robot in smaller] == [(robot.start, robot.goal) for robot in larger[:robots]]


@given(SEEDS, SEEDS)
def test_drawn_instances_obey_the_rules_and_the_ranges(map_seed: int, seed: int) -> None:
    traits = Traits(capacity=Range(1, 3), duration=Range(2, 4))
    fleet = Fleet(robots=9, seed=seed, release=Range(5, 9), pace=Range(1, 2))
    instance = grid_instance(Grid(3, 3, 7, map_seed), fleet, traits)
    assert not instance_faults(instance)
    assert all(
        resource.capacity in (1, 2, 3) and resource.duration in (2, 3, 4) for resource in instance.graph.resources
    )
    releases = [robot.release for robot in instance.robots]
    assert releases == sorted(releases)
    assert set(releases) <= set(range(5, 10))


@given(
    st.builds(
        Warehouse,
        columns=st.integers(1, 3),
        rows=st.integers(1, 3),
        rack_length=st.integers(1, 4),
        rack_depth=st.integers(1, 3),
        aisle=st.integers(1, 3),
        stations=st.integers(1, 5),
        start_at=st.sampled_from(["racks", "stations"]),
    ),
    SEEDS,
)
def test_warehouses_are_connected_and_robots_go_between_racks_and_stations(warehouse: Warehouse, seed: int) -> None:
    instance = warehouse_instance(warehouse, Fleet(robots=5, seed=seed, distinct="none"))
    assert not instance_faults(instance)
    assert nx.is_connected(graph_of(instance))
    racks = warehouse.columns * warehouse.rows * warehouse.rack_length * warehouse.rack_depth
    stations = [resource for resource in instance.graph.resources if resource.x == 0]
    assert len(instance.graph.resources) == (warehouse.width - 1) * warehouse.height - racks + len(stations)
    assert len(stations) == min(warehouse.stations, warehouse.height)
    ends = [robot.goal if warehouse.start_at == "racks" else robot.start for robot in instance.robots]
    assert set(ends) <= {resource.id for resource in stations}


def test_the_same_options_give_the_same_document_for_ever(carproof: Run) -> None:
    arguments = (
        "generate grid --width 3 --height 2 --map 10 --map-seed 5 --seed 7 --robots 2 --duration 1..2 --pace 1..2"
    )
    assert sha256(carproof(arguments).stdout.encode()).hexdigest()[:16] == "d02c1052c5ddf742"
