"""A planner as people write them: MovingAI files in, LaCAM's text or coordinate paths out, one robot after the other.

With `--forget swaps` or `parked` it has that bug. A robot without a way leaves all without plans.
"""

import argparse
import sys
from pathlib import Path

Cell = tuple[int, int]


def read_cells(map: Path) -> set[Cell]:
    rows = map.read_text().splitlines()[4:]
    return {(x, y) for y, row in enumerate(rows) for x, kind in enumerate(row) if kind in ".GS"}


def read_ends(scen: Path, agents: int) -> list[tuple[Cell, Cell]]:
    fields = [list(map(int, line.split()[4:8])) for line in scen.read_text().splitlines()[1 : agents + 1]]
    return [((x, y), (goal_x, goal_y)) for x, y, goal_x, goal_y in fields]


class Others:
    """The paths of the robots before; each stays at its end."""

    def __init__(self, forgotten: str) -> None:
        self.paths: list[list[Cell]] = []
        self.forgotten = forgotten

    @property
    def end(self) -> int:
        return max((len(path) for path in self.paths), default=0)

    def at(self, tick: int) -> list[Cell | None]:
        after = self.forgotten == "parked"
        return [path[tick] if tick < len(path) else None if after else path[-1] for path in self.paths]

    def allow(self, here: Cell, there: Cell, tick: int) -> bool:
        now, then = self.at(tick), self.at(tick + 1)
        swaps = self.forgotten != "swaps" and (there, here) in zip(now, then, strict=True)
        return there not in then and not swaps

    def leave_alone(self, goal: Cell, tick: int) -> bool:
        return all(goal not in self.at(later) for later in range(tick, self.end + 1))


def path_of(cells: set[Cell], start: Cell, goal: Cell, others: Others) -> list[Cell] | None:
    """Breadth first in space and time."""
    level = {start: [start]} if start not in others.at(0) else {}
    for tick in range(others.end + len(cells) + 1):
        if goal in level and others.leave_alone(goal, tick):
            return level[goal]
        following: dict[Cell, list[Cell]] = {}
        for (x, y), path in level.items():
            for there in ((x, y), (x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
                if there in cells and there not in following and others.allow((x, y), there, tick):
                    following[there] = [*path, there]
        level = following
    return None


def lacam(paths: list[list[Cell]]) -> str:
    end = max(map(len, paths), default=0)
    ticks = [[path[min(tick, len(path) - 1)] for path in paths] for tick in range(end)]
    lines = [f"{tick}:" + "".join(f"({x},{y})," for x, y in cells) for tick, cells in enumerate(ticks)]
    return "\n".join(["solver=grid", f"solved={int(end > 0)}", "solution=", *lines, ""])


def coordinates(paths: list[list[Cell]]) -> str:
    return "".join(
        f"Agent {agent}: " + "".join(f"({x},{y})->" for x, y in path) + "\n" for agent, path in enumerate(paths)
    )


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("map", type=Path)
    parser.add_argument("scen", type=Path)
    parser.add_argument("agents", type=int)
    parser.add_argument("--forget", default="")
    parser.add_argument("--paths", action="store_true")
    parser.add_argument("-o", dest="output", type=Path)
    options = parser.parse_args()
    cells, others = read_cells(options.map), Others(options.forget)
    for start, goal in read_ends(options.scen, options.agents):
        path = path_of(cells, start, goal, others)
        if path is None:
            others.paths = []
            break
        others.paths.append(path)
    text = coordinates(others.paths) if options.paths else lacam(others.paths)
    if options.output is None:
        sys.stdout.write(text)
    else:
        options.output.write_text(text)


main()
