"""The pictures in the project's own pages; `python -m carproof.viewer.samples` draws them again."""

from collections.abc import Mapping
from pathlib import Path

from carp_reference import plan
from carp_reference.execution import order_of
from carp_spec import Carp
from carproof.generate import Fleet, Grid, grid_instance
from carproof.viewer.dependency_picture import dependency_still
from carproof.viewer.stills import chart_still, map_still

FOLDER = Path(__file__).parent.parent.parent / "pictures"
TITLE = "8 robots on a grid of 6 x 4"
TICK = 3


def sample_pictures() -> Mapping[str, bytes]:
    """The pictures by file name: eight robots on a small map of the paper's kind."""
    instance = grid_instance(Grid(width=6, height=4, map=12), Fleet(robots=8, seed=3))
    solution = plan(instance, Carp())
    return {
        "map.svg": map_still(instance, solution, TICK, TITLE),
        "chart.svg": chart_still(instance, solution, TITLE),
        "dependencies.svg": dependency_still(order_of(instance, solution), TITLE),
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, drawn in sample_pictures().items():
        (FOLDER / name).write_bytes(drawn)
