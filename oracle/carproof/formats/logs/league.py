"""The output of the League of Robot Runners, 2023 and 2024: an action a tick, F, R, C, W or T.

A robot starts at [row, column, heading]. One that turns stays in its cell, so positions alone are judged. 2023 has for
each robot the tasks finished, [task, tick, "finished"], and tasks [task, row, column]. 2024 has events [tick, robot,
task, errands done], and tasks [task, release, [row, column, row, column, ...]]. Both may be left out.
Source: Input_Output_Format.md of the Start-Kit of MAPF-Competition, and the archive of its best solutions.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from carproof.formats.logs.cells import RIGHT_LOG, CellLog
from carproof.formats.walks import MOST_CELLS, Cell, require_bounded

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

HEADINGS = ("E", "S", "W", "N")
MOVES = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""Of the headings, which turn clockwise in this order; y grows downwards."""
ACTIONS = frozenset("FRCWT")
"""F goes forward, R turns clockwise and C against it; the others wait."""


class Output(msgspec.Struct, frozen=True):
    """The fields that are read."""

    start: list[tuple[int, int, str]]
    actualPaths: list[str]  # noqa: N815 - as in the file
    teamSize: int | None = None  # noqa: N815 - as in the file
    events: list[list[Any]] = []
    tasks: list[tuple[int, int, list[int] | int]] = []


def read(text: str, width: int, file: str) -> CellLog:
    """Read an output."""
    del width
    try:
        output = msgspec.json.decode(text, type=Output)
    except (msgspec.DecodeError, RecursionError) as error:
        raise RIGHT_LOG.refuse(file, f"it must be an output of the League of Robot Runners: {error}") from error
    if output.teamSize not in (None, len(output.start)):
        raise RIGHT_LOG.refuse(f"{file}: $.teamSize", f"it must be {len(output.start)}, the number of starts")
    if len(output.actualPaths) != len(output.start):
        message = (
            f"there must be a path for each of {len(output.start)} starts, and there are {len(output.actualPaths)}"
        )
        raise RIGHT_LOG.refuse(f"{file}: $.actualPaths", message)
    require_bounded(sum(len(path) // 2 + 2 for path in output.actualPaths), file)
    walks = []
    for number, ((row, column, heading), path) in enumerate(zip(output.start, output.actualPaths, strict=True)):
        is_start = heading in HEADINGS and all(0 <= each < MOST_CELLS for each in (row, column))
        if not (is_start and {*path[::2]} <= ACTIONS and {*path[1::2]} <= {","} and (len(path) % 2 or not path)):
            message = "a robot must start in a cell with heading E, S, W or N, and do F, R, C, W or T at each tick"
            raise RIGHT_LOG.refuse(f"{file}: $.actualPaths[{number}]", message)
        walks.append(_walk((column, row), HEADINGS.index(heading), path[::2]))
    stops: list[list[Cell]] = [[] for _ in walks]
    for robot, cell in _served(output, file):
        stops[robot].append(cell)
    return CellLog(walks, stops)


def _walk(start: Cell, heading: int, actions: str) -> "npt.NDArray[np.int32]":
    import numpy as np  # noqa: PLC0415 - slow to load

    done = np.frombuffer(actions.encode(), np.uint8)
    turns = (done == ord("R")).astype(np.int32) - (done == ord("C"))
    headings = (heading + np.cumsum(turns) - turns) % len(MOVES)
    steps = np.array(MOVES, np.int32)[headings] * (done == ord("F"))[:, np.newaxis]
    return np.cumsum(np.vstack([np.array([start], np.int32), steps]), axis=0, dtype=np.int32)


def _served(output: Output, file: str) -> Iterator[tuple[int, Cell]]:
    """The cells served by each robot, in the order of time."""
    errands = {task: _errands(rest) for task, *rest in output.tasks}
    if len(errands) < len(output.tasks):
        raise RIGHT_LOG.refuse(f"{file}: $.tasks", "a task must be given once")
    for number, event in enumerate(output.events):
        message = "each event must name a robot, a task, and how many of its errands are done"
        try:
            done = [*_done(number, event, errands)]
        except msgspec.ValidationError:
            raise RIGHT_LOG.refuse(f"{file}: $.events[{number}]", message) from None
        for robot, task, count in done:
            if not (0 <= robot < len(output.start) and task in errands and 0 <= count <= len(errands[task])):
                raise RIGHT_LOG.refuse(f"{file}: $.events[{number}]", message)
            if count:
                yield robot, errands[task][count - 1]


def _done(number: int, event: list[Any], errands: Mapping[int, Sequence[Cell]]) -> Iterator[tuple[int, int, int]]:
    """The robot, the task and how many of its errands are done: of one event, or of all those of the robot `number`."""
    if event and isinstance(event[0], int):
        yield msgspec.convert(event, tuple[int, int, int, int])[1:]
        return
    for task, _, what in msgspec.convert(event, list[tuple[int, int, str]]):
        if what == "finished":
            yield number, task, len(errands.get(task, ()))


def _errands(task: Sequence[Any]) -> Sequence[Cell]:
    """The cells of a task, from what stands behind its number."""
    release_or_row, places = task
    numbers = places if isinstance(places, list) else [release_or_row, places]
    return [*zip(numbers[1::2], numbers[::2], strict=False)]
