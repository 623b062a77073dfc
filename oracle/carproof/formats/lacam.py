"""LaCAM's and mapf-visualizer's text: after the line `solution=`, one line a tick, `t:(x,y),(x,y),...`.

x is the column and y the row, both from 0 at the top left; the k-th position is that of the instance's k-th robot.
The lines before `solution=` are not read. No line after it means that no robot has a plan.
Semantics: `walks`.
"""

import re

from carp_spec import Instance, Refusal, RobotId, Solution, total_cost
from carproof.formats.adapter import Adapter
from carproof.formats.walks import Cell, Walk, last_arrival, solution_of_walks, tick_by_tick, walks_of_solution
from carproof.input_rules import Code

_HEAD = re.compile(r"^solution=[ \t\r]*$", re.MULTILINE)
_LINE = re.compile(r"(\d{1,9}):((?:\(-?\d{1,9},-?\d{1,9}\),?)*)")
_CELL = re.compile(r"\((-?\d+),(-?\d+)\)")


RIGHT_LINES = Code(
    "adapter/lacam",
    "After the line solution= comes a line for each tick from 0: the tick, a colon, and a position (x,y) for each "
    "robot of the instance, in its order, joined by commas.",
    "output of LaCAM and input of mapf-visualizer",
)


def _positions(text: str, robots: int, file: str) -> list[list[Cell]]:
    """The cells of all robots, tick by tick."""

    def refuse(number: int, message: str) -> Refusal:
        return Refusal("document", f"{file}:{number}", RIGHT_LINES.id, message)

    lines = [line.replace(" ", "").strip() for line in text.split("\n")]
    if "solution=" not in lines:
        raise refuse(len(lines), "there must be a line solution=")
    ticks: list[list[Cell]] = []
    for number, line in enumerate(lines[lines.index("solution=") + 1 :], start=lines.index("solution=") + 2):
        if not line:
            continue
        parts = _LINE.fullmatch(line)
        if parts is None:
            raise refuse(number, "the line must be like 0:(x,y),(x,y), with whole numbers of at most nine digits")
        if int(parts[1]) != len(ticks):
            raise refuse(number, f"the line must be that of tick {len(ticks)}, and is that of {int(parts[1])}")
        cells = [(int(x), int(y)) for x, y in _CELL.findall(parts[2])]
        if len(cells) != robots:
            raise refuse(number, f"the line must have a position for each of {robots} robots, and has {len(cells)}")
        ticks.append(cells)
    return ticks


def read(text: str, instance: Instance, file: str) -> Solution:
    """Read a solution."""
    ticks = _positions(text, len(instance.robots), file)
    walks: dict[RobotId, Walk] = {
        robot.id: [(cells[position], tick) for tick, cells in enumerate(ticks)]
        for position, robot in enumerate(instance.robots)
        if ticks
    }
    return solution_of_walks(instance, walks)


def write(instance: Instance, solution: Solution) -> str:
    """Write a solution of all robots."""
    cells = tick_by_tick(walks_of_solution(instance, solution, partial=False))
    makespan = last_arrival(cells)
    starts = "".join(f"({each[0][0]},{each[0][1]})," for each in cells.values())
    goals = "".join(f"({each[-1][0]},{each[-1][1]})," for each in cells.values())
    lines = [
        f"agents={len(cells)}",
        "solver=carproof",
        "solved=1",
        f"soc={total_cost(instance, solution.plans)}",
        f"makespan={makespan}",
        f"starts={starts}",
        f"goals={goals}",
        "solution=",
    ]
    for tick in range(makespan + 1 if cells else 0):
        now = [each[min(tick, len(each) - 1)] for each in cells.values()]
        lines.append(f"{tick}:" + "".join(f"({x},{y})," for x, y in now))
    return "\n".join(lines) + "\n"


ADAPTER = Adapter(
    "lacam",
    "a line t:(x,y),(x,y),... for each tick after solution=, as LaCAM and mapf-visualizer have it",
    lambda text: "solution=" in text and _HEAD.search(text) is not None,
    read,
    write,
)
