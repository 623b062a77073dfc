"""The MAPF tracker's moves: for each robot of the instance, in its order, a line like `5r2d3w`.

`l` and `r` lower and raise x, `d` and `u` lower and raise y, and `w` waits; a number repeats the letter after it. In
the tracker's own files y grows downwards, so there `u` moves down. The walk begins at the robot's start. The tracker's
tables (CSV) with one row and a column `path` or `solution_plan` are read too. Semantics: `walks`.
"""

import re
from itertools import pairwise

from carp_spec import Instance, RobotId, Solution
from carproof.formats.adapter import Adapter, first_line
from carproof.formats.walks import Cell, Walk, require_bounded, require_walks, solution_of_walks, walks_of_solution
from carproof.input_rules import Code

_STEPS = {"l": (-1, 0), "r": (1, 0), "d": (0, -1), "u": (0, 1), "w": (0, 0)}
_LETTERS = {step: letter for letter, step in _STEPS.items()}
_RUNS = re.compile(r"(?:\d{0,9}[lrudw])*")
_RUN = re.compile(r"(\d*)([lrudw])")
_COLUMNS = ("path", "solution_plan")
_ROW = re.compile(r'(?:"[^"]*"|[^",\n]+)(?:,(?:"[^"]*"|[^",\n]+))*\n*')
_FIELD = re.compile(r'"([^"]*)"|([^",\n]+)')


RIGHT_MOVES = Code(
    "adapter/mapf-tracker",
    "There is a line for each robot of the instance, of the letters l, r, u, d and w, each with a number before it or "
    "none; or a table with one row, whose column path or solution_plan holds these lines.",
    "files of the MAPF tracker",
)


def _lines(text: str, robots: int, file: str) -> list[str]:
    """The moves of each robot."""
    moves, first = _cell_of_table(text, file) if _is_table(text) else (text, 1)
    lines = [line.strip() for line in moves.removesuffix("\n").split("\n")] if moves else []
    for number, line in enumerate(lines, start=first):
        if _RUNS.fullmatch(line) is None:
            message = "the line must be of the letters l, r, u, d and w and numbers before them"
            raise RIGHT_MOVES.refuse(f"{file}:{number}", message)
    if len(lines) != robots:
        message = f"there must be a line for each of {robots} robots, not {len(lines)}"
        raise RIGHT_MOVES.refuse(f"{file}:{first + len(lines) - 1}", message)
    return lines


def _names(head: str) -> list[str]:
    """The names of a table's columns."""
    return [name.strip().strip('"') for name in head.split(",")]


def _is_table(text: str) -> bool:
    head = first_line(text)
    return any(column in head for column in _COLUMNS) and any(name in _COLUMNS for name in _names(head))


def _cell_of_table(text: str, file: str) -> tuple[str, int]:
    """The cell that holds the moves, and the line on which it begins."""
    head, _, row = text.partition("\n")
    names = _names(head)
    columns = [position for position, name in enumerate(names) if name in _COLUMNS]
    fields = [quoted or plain for quoted, plain in _FIELD.findall(row)] if _ROW.fullmatch(row) else []
    if len(columns) != 1 or len(fields) != len(names):
        message = f"the table must have one row, and one of the columns {' and '.join(_COLUMNS)}"
        raise RIGHT_MOVES.refuse(f"{file}:1", message)
    return fields[columns[0]], 2


def read(text: str, instance: Instance, file: str) -> Solution:
    """Read a solution."""
    require_walks(instance)
    lines = _lines(text, len(instance.robots), file)
    require_bounded(sum(_moves(line) for line in lines), file)
    walks: dict[RobotId, Walk] = {}
    for robot, line in zip(instance.robots, lines, strict=True):
        start = instance.graph.resource[robot.start]
        walks[robot.id] = _walk((start.x or 0, start.y or 0), line)
    return solution_of_walks(instance, walks)


def _moves(line: str) -> int:
    """The number of cells that the line names, without waiting."""
    return sum(int(count or 1) for count, letter in _RUN.findall(line) if letter != "w")


def _walk(start: Cell, line: str) -> Walk:
    (x, y), tick = start, 0
    walk = [(start, 0)]
    for count, letter in _RUN.findall(line):
        dx, dy = _STEPS[letter]
        if letter == "w":
            tick += int(count or 1)
            continue
        for _ in range(int(count or 1)):
            x, y, tick = x + dx, y + dy, tick + 1
            walk.append(((x, y), tick))
    return walk


def write(instance: Instance, solution: Solution) -> str:
    """Write a solution of all robots."""
    walks = walks_of_solution(instance, solution, partial=False)
    return "".join(_runs(walk) + "\n" for walk in walks.values())


def _runs(walk: Walk) -> str:
    runs: list[tuple[str, int]] = []
    for ((x, y), enter), ((next_x, next_y), leave) in pairwise(walk):
        step = (next_x - x, next_y - y)
        if step not in _LETTERS:
            message = f"the format cannot hold it: the move from {x},{y} to {next_x},{next_y} is not to a cell beside"
            raise RIGHT_MOVES.refuse("SOLUTION", message)
        for letter, count in (("w", leave - enter - 1), (_LETTERS[step], 1)):
            if count and runs and runs[-1][0] == letter:
                runs[-1] = (letter, runs[-1][1] + count)
            elif count:
                runs.append((letter, count))
    return "".join(f"{count if count > 1 else ''}{letter}" for letter, count in runs)


def _looks_like(text: str) -> bool:
    return _is_table(text) or (bool(text.strip()) and all(_RUNS.fullmatch(line.strip()) for line in text.split("\n")))


ADAPTER = Adapter(
    "mapf-tracker",
    "a line of moves like 5r2d3w for each robot (u is y + 1), or the tracker's table with one row",
    _looks_like,
    read,
    write,
)
