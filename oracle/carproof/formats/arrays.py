"""Instances on grids given as arrays of NumPy, or as nested lists.

The array has a row for each y and a column for each x. A cell is free if its entry is true or a whole number other than
0. A free cell is a resource `x,y` of capacity and duration one, joined to the free cells beside it.
"""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from carp_spec import AfterGoal, Instance, Robot
from carp_spec.rule import DESIGN
from carproof.formats.movingai import BLOCKED, PASSABLE, GridMap, movingai_instance
from carproof.generate.grid import cell_id
from carproof.input_rules import Code

if TYPE_CHECKING:
    import numpy as np

Cell: TypeAlias = tuple[int, int]
RIGHT_ARRAY = Code(
    "adapter/array",
    "A grid is an array of two dimensions with entries that are booleans or whole numbers; starts and goals are as "
    "many cells (x, y), each free.",
    DESIGN,
)


def instance_from_array(
    free: "np.typing.NDArray[Any] | Sequence[Sequence[int]]",
    starts: Iterable[Sequence[int]],
    goals: Iterable[Sequence[int]],
    after_goal: AfterGoal = "park",
) -> Instance:
    """Make an instance of a grid; the robots r1, r2, ... go from each start to the goal of the same position.

    `free[y][x]` says whether the cell (x, y) is free; starts and goals are pairs (x, y), or arrays of two columns.
    Raises `Refusal` for another shape or kind of entries, and for a start or goal that is not free.
    """
    import numpy as np  # noqa: PLC0415 - slow to load

    try:
        cells = np.asarray(free)
    except ValueError as error:
        raise RIGHT_ARRAY.refuse("$", f"the rows must be equally long: {error}") from None
    if cells.ndim != 2 or cells.dtype.kind not in "biu":  # noqa: PLR2004 - a grid has two dimensions
        message = f"it must have two dimensions of booleans or whole numbers, not {cells.ndim} of {cells.dtype}"
        raise RIGHT_ARRAY.refuse("$", message)
    rows = tuple("".join(PASSABLE[0] if cell else BLOCKED[0] for cell in row) for row in cells.tolist())
    grid = GridMap(cells.shape[1], cells.shape[0], rows)
    ends = [_cells(grid, given, name) for given, name in ((starts, "starts"), (goals, "goals"))]
    if len(ends[0]) != len(ends[1]):
        raise RIGHT_ARRAY.refuse(
            "$.goals", f"there must be {len(ends[0])} of them, one for each start, and are {len(ends[1])}"
        )
    pairs = enumerate(zip(*ends, strict=True), start=1)
    robots = [Robot(f"r{number}", cell_id(*start), cell_id(*goal)) for number, (start, goal) in pairs]
    return movingai_instance(grid, robots, after_goal, "array")


def _cells(grid: GridMap, given: Iterable[Sequence[int]], name: str) -> list[Cell]:
    import numpy as np  # noqa: PLC0415 - slow to load

    if not isinstance(cast("object", given), Iterable):
        raise RIGHT_ARRAY.refuse(f"$.{name}", f"it must be pairs of whole numbers, not {given!r}")
    found = []
    for place, pair in enumerate(given):
        cell = np.asarray(pair)
        if cell.shape != (2,) or cell.dtype.kind not in "iu":
            raise RIGHT_ARRAY.refuse(f"$.{name}[{place}]", f"it must be a pair of whole numbers, not {pair!r}")
        x, y = cell.tolist()
        if not grid.is_passable(x, y):
            raise RIGHT_ARRAY.refuse(f"$.{name}[{place}]", f"it must be a free cell of the grid, and {x},{y} is not")
        found.append((x, y))
    return found
