"""Instances from the MovingAI benchmarks: `.map` and `.scen` files.

A cell `.`, `G`, `S` or `E` (of the League of Robot Runners) is passable; `@`, `O`, `T` or `W` is blocked. Cells are
resources of capacity and duration one, joined to those beside them; robots are the first agents of the scenario. With
`park` this is the benchmarks' classical problem. The lengths in a scenario are for octile moves, so they are not read.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from carp_spec import AfterGoal, Instance, Refusal, Robot
from carp_spec.inputs.values import require_instance
from carp_spec.rule import is_between
from carp_spec.shapes import require_shape
from carproof.generate.grid import cell_edges, cell_graph, cell_id
from carproof.generate.options import MOST_RESOURCES, Traits, size_is_bounded
from carproof.input_rules import Code

SOURCE = "Sturtevant 2012, Benchmarks for grid-based pathfinding; decision of carproof"
PASSABLE = ".GSE"
BLOCKED = "@OTW"
_HEADER = {
    "type": "type octile",
    "height": "height and a whole number",
    "width": "width and a whole number",
    "map": "map",
}
_FIELDS = 9


@dataclass(frozen=True, slots=True)
class GridMap:
    """A map: its rows, from the top."""

    width: int
    height: int
    rows: tuple[str, ...]

    def is_passable(self, x: int, y: int) -> bool:
        """Whether a robot can be in the cell; outside the map it cannot."""
        return 0 <= x < self.width and 0 <= y < self.height and self.rows[y][x] in PASSABLE


RIGHT_MAP = Code(
    "movingai/map",
    "A map file begins with the lines type, height H, width W and map; then come H rows of W cells, each one of "
    f"{PASSABLE} (passable) or {BLOCKED} (blocked).",
    SOURCE,
)
RIGHT_SCENARIO = Code(
    "movingai/scenario",
    "A scenario file begins with the line version 1; each further line has nine fields: bucket, map, width, height, "
    "start x and y, goal x and y, length. Width and height are the map's, start and goal are passable cells of it.",
    SOURCE,
)
CLASSICAL = Code(
    "movingai/instance",
    "An instance that is written as a map and a scenario is classical: it has cells of a grid, each joined to those "
    "beside it, and robots that park, are released at 0, start in distinct cells and end in distinct ones; capacities, "
    "durations and paces are 1.",
    SOURCE,
)
MOVINGAI_RULES: tuple[Code, ...] = (RIGHT_MAP, RIGHT_SCENARIO, CLASSICAL)


def read_map(data: bytes, file: str = "map") -> GridMap:
    """Read a map; raises `Refusal` with file and line."""
    lines = _lines(data)
    header = [line.split() for line in (*lines[:4], "", "", "", "")]
    for number, (word, right) in enumerate(_HEADER.items()):
        is_number = len(header[number]) == 2 and _is_number(header[number][1])  # noqa: PLR2004 - a word and its value
        if header[number][:1] != [word] or (word in ("height", "width") and not is_number):
            raise RIGHT_MAP.refuse(f"{file}:{number + 1}", f"the line must be: {right}")
    grid = GridMap(width=int(header[2][1]), height=int(header[1][1]), rows=tuple(lines[4:]))
    if len(grid.rows) != grid.height:
        message = f"the map must have {grid.height} rows, and has {len(grid.rows)}"
        raise RIGHT_MAP.refuse(f"{file}:{len(lines)}", message)
    for number, row in enumerate(grid.rows, start=5):
        if len(row) != grid.width:
            raise RIGHT_MAP.refuse(f"{file}:{number}", f"the row must have {grid.width} cells, and has {len(row)}")
        for cell in row:
            if cell not in PASSABLE + BLOCKED:
                raise RIGHT_MAP.refuse(f"{file}:{number}", f"a cell must be one of {PASSABLE}{BLOCKED}, not {cell!r}")
    return grid


def read_scenario(data: bytes, grid: GridMap, agents: int | None, file: str = "scenario") -> tuple[Robot, ...]:
    """Read the first agents of a scenario, all if no number is given; raises `Refusal` with file and line."""
    lines = _lines(data)
    if not lines or lines[0].split() not in (["version", "1"], ["version", "1.0"]):
        raise RIGHT_SCENARIO.refuse(f"{file}:1", "the line must be: version 1")
    numbered = [(number, line) for number, line in enumerate(lines[1:], start=2) if line.strip()]
    if agents is not None and agents > len(numbered):
        message = f"{agents} agents are asked for, and the scenario has {len(numbered)}"
        raise RIGHT_SCENARIO.refuse(f"{file}:{len(lines)}", message)
    return tuple(
        _agent(position, line, grid, f"{file}:{number}")
        for position, (number, line) in enumerate(numbered[:agents], start=1)
    )


def _agent(position: int, line: str, grid: GridMap, where: str) -> Robot:
    fields = line.split("\t") if "\t" in line else line.split()
    if len(fields) != _FIELDS or not all(map(_is_number, fields[2:8])):
        message = "the line must have nine fields: bucket, map, width, height, start x, y, goal x, y, length"
        raise RIGHT_SCENARIO.refuse(where, message)
    width, height, *ends = map(int, fields[2:8])
    if (width, height) != (grid.width, grid.height):
        message = f"the map must be {width} x {height}, and is {grid.width} x {grid.height}"
        raise RIGHT_SCENARIO.refuse(where, message)
    for name, (x, y) in (("start", ends[:2]), ("goal", ends[2:])):
        if not grid.is_passable(x, y):
            raise RIGHT_SCENARIO.refuse(where, f"the {name} must be a passable cell of the map, and {x},{y} is not")
    return Robot(f"r{position}", cell_id(*ends[:2]), cell_id(*ends[2:]))


def read_movingai(map: bytes, scenario: bytes, agents: int | None = None, after_goal: AfterGoal = "park") -> Instance:
    """Read an instance from the contents of a map and a scenario file, with its first agents or all.

    Raises `Refusal` with the file and the line that is wrong.
    """
    require_shape(map, bytes, "map")
    require_shape(scenario, bytes, "scenario")
    if not (agents is None or is_between(agents, 0)):
        raise Refusal(
            "option", "$.agents", RIGHT_SCENARIO.id, f"it must be a whole number of at least 0, not {agents!r}"
        )
    grid = read_map(map)
    return movingai_instance(grid, read_scenario(scenario, grid, agents), after_goal)


def movingai_instance(grid: GridMap, robots: Sequence[Robot], after_goal: AfterGoal, file: str = "map") -> Instance:
    """Make an instance of a map and robots."""
    cells = [(x, y) for y in range(grid.height) for x in range(grid.width) if grid.is_passable(x, y)]
    if not size_is_bounded(len(cells), 1):
        message = f"the map must have at most {MOST_RESOURCES} passable cells, and has {len(cells)}"
        raise Refusal("limit", file, size_is_bounded.id, message)
    no_chance: Iterator[int] = iter(())
    instance = Instance(cell_graph(cells, list(cell_edges(cells)), Traits(), no_chance), tuple(robots), after_goal)
    require_instance(instance)
    return instance


def _lines(data: bytes) -> list[str]:
    """The lines without their ends, and without empty lines at the end of the file."""
    return data.decode(errors="replace").rstrip().replace("\r\n", "\n").split("\n") if data.strip() else []


def _is_number(field: str) -> bool:
    return field.isascii() and field.isdigit() and len(field) < 10  # noqa: PLR2004 - more digits than any map has
