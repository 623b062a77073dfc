"""Random cases of classical multi-agent path finding, for planners that read MovingAI files."""

from hypothesis import strategies as st

from carp_spec import Instance, Robot
from carproof.conform.cases import Case
from carproof.generate.grid import cell_id
from carproof.movingai import BLOCKED, PASSABLE, GridMap, movingai_instance

WIDTH, HEIGHT, ROBOTS = 4, 3, 4


@st.composite
def classical_instances(draw: st.DrawFn) -> Instance:
    """Small grids, some cells blocked, with robots of different starts and different goals; most meet."""
    width, height = draw(st.integers(1, WIDTH)), draw(st.integers(1, HEIGHT))
    kinds = st.sampled_from([PASSABLE[0], PASSABLE[0], PASSABLE[0], BLOCKED[0]])
    rows = tuple("".join(draw(st.lists(kinds, min_size=width, max_size=width))) for _ in range(height))
    grid = GridMap(width, height, rows)
    cells = [cell_id(x, y) for y in range(height) for x in range(width) if grid.is_passable(x, y)]
    if not cells:
        grid, cells = GridMap(1, 1, (PASSABLE[0],)), [cell_id(0, 0)]
    starts, goals = draw(st.permutations(cells)), draw(st.permutations(cells))
    count = draw(st.integers(1, min(ROBOTS, len(cells))))
    ends = list(zip(starts, goals, strict=True))[:count]
    robots = [Robot(f"r{number}", start, goal) for number, (start, goal) in enumerate(ends, start=1)]
    return movingai_instance(grid, robots, "park")


def classical_cases() -> st.SearchStrategy[Case]:
    """Whole instances, to be planned by a planner of the program's own."""
    return classical_instances().map(lambda instance: Case("random", "plan", "plan", instance, classical=True))
