"""Random cases of classical multi-agent path finding, for planners that read MovingAI files."""

from dataclasses import replace

from hypothesis import strategies as st

from carp_spec import Instance, Resource, ResourceGraph
from carproof.conform.cases import Case
from carproof.formats.movingai import BLOCKED, PASSABLE, GridMap, movingai_instance
from carproof.generate.grid import cell_id
from carproof.testing.strategies import Sizes, instances

WIDTH, HEIGHT = 4, 3
SIZES = Sizes(robots=4, release=0, pace=1)


@st.composite
def _grids(draw: st.DrawFn) -> ResourceGraph:
    """Small grids, some cells blocked."""
    width, height = draw(st.integers(1, WIDTH)), draw(st.integers(1, HEIGHT))
    kinds = st.sampled_from([PASSABLE[0], PASSABLE[0], PASSABLE[0], BLOCKED[0]])
    rows = tuple("".join(draw(st.lists(kinds, min_size=width, max_size=width))) for _ in range(height))
    graph = movingai_instance(GridMap(width, height, rows), (), "park").graph
    return graph if graph.resources else ResourceGraph((Resource(cell_id(0, 0), x=0, y=0),), ())


def classical_instances() -> st.SearchStrategy[Instance]:
    """Grids with robots of different starts and different goals; most meet."""
    return instances(SIZES, _grids(), 1, starts_apart=True, goals_apart=True).map(_classical)


def _classical(instance: Instance) -> Instance:
    robots = (replace(robot, id=f"r{number}") for number, robot in enumerate(instance.robots, start=1))
    return replace(instance, robots=tuple(robots), after_goal="park")


def classical_cases() -> st.SearchStrategy[Case]:
    """Whole instances, to be planned by a planner of the program's own."""
    return classical_instances().map(lambda instance: Case("random", "plan", "plan", instance, classical=True))
