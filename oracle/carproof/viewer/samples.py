"""The pictures in the project's own pages; `python -m carproof.viewer.samples` draws them again."""

from collections.abc import Mapping
from pathlib import Path

from carp_reference import plan
from carp_reference.execution import order_of
from carp_spec import Carp, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit
from carproof.generate import Fleet, Grid, grid_instance
from carproof.viewer.dependency_picture import dependency_still
from carproof.viewer.stills import view_chart, view_map

FOLDER = Path(__file__).parent.parent.parent / "pictures"
TITLE = "8 robots on a grid of 6 x 4"
TICK = 3


def finding() -> tuple[Instance, Solution]:
    """The smallest case on which the planner of the tutorial is wrong."""
    cells = (Resource(0, x=0, y=0), Resource(1, x=1, y=0))
    instance = Instance(ResourceGraph(cells, ((0, 1),)), (Robot(0, 0, 1), Robot(1, 1, 0)))
    plans = (Plan(0, (Visit(0, 0, 1), Visit(1, 1, 2))), Plan(1, (Visit(1, 0, 1), Visit(0, 1, 2))))
    return instance, Solution(plans, (0, 1))


def sample_pictures() -> Mapping[str, bytes]:
    """The pictures by file name: eight robots on a small map of the paper's kind, and two that exchange places."""
    instance = grid_instance(Grid(width=6, height=4, map=12), Fleet(robots=8, seed=3))
    solution = plan(instance, Carp())
    swap, swapped = finding()
    return {
        "finding-map.svg": view_map(swap, swapped, at=1, title="two robots exchange their cells"),
        "finding-chart.svg": view_chart(swap, swapped, title="two robots exchange their cells"),
        "map.svg": view_map(instance, solution, at=TICK, title=TITLE),
        "chart.svg": view_chart(instance, solution, title=TITLE),
        "dependencies.svg": dependency_still(order_of(instance, solution), TITLE),
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, drawn in sample_pictures().items():
        (FOLDER / name).write_bytes(drawn)
