"""Logs of what robots did, from other systems: one module a format. Read, they are traces, which the law judges."""

from collections.abc import Mapping
from itertools import groupby

from carp_spec import Instance, Refusal, Robot, Stop
from carp_spec.documents.solutions import read_trace
from carp_spec.execution.traces import Trace
from carproof.formats.logs import league, rhcr, table
from carproof.formats.logs.cells import RIGHT_LOG, CellLog, CellReader, trace_of
from carproof.formats.movingai import GridMap, movingai_instance
from carproof.generate.grid import cell_id

CELL_LOGS: Mapping[str, tuple[CellReader, str]] = {
    "league": (league.read, "output of the League of Robot Runners, 2023 and 2024"),
    "rhcr": (rhcr.read, "paths.txt of RHCR"),
}
LOGS: Mapping[str, str] = {
    "trace": "a carproof-trace/1",
    "csv": "a table with the columns robot, tick and resource",
    **{name: about for name, (_, about) in CELL_LOGS.items()},
}
"""The formats with their descriptions."""


def read_log(data: bytes, instance: Instance, format: str, file: str = "log") -> Trace:
    """Read a log in the format named; raises `Refusal` for a malformed one."""
    if format == "trace":
        return read_trace(data)
    if format == "csv":
        return table.read(RIGHT_LOG.text(data, file), instance, file)
    width = 1 + max((each.x or 0 for each in instance.graph.resources), default=0)
    return trace_of(instance, _cells(data, format, width, file))


def read_log_on_map(data: bytes, grid: GridMap, format: str, file: str = "log") -> tuple[Instance, Trace]:
    """Read a log of cells, and make the instance that it is about: its robots, from 0 on, and the stops it names.

    A robot of which the log names no stop has one where it is at the end. Raises `Refusal` for a malformed log.
    """
    log = _cells(data, format, grid.width, file)
    robots = []
    for number, (walk, served) in enumerate(zip(log.walks, log.stops, strict=True)):
        start, end = walk[0].tolist(), walk[-1].tolist()
        there = served or [next((cell for cell in walk[::-1].tolist() if grid.is_passable(*cell)), end)]
        stops = tuple(Stop(cell_id(*cell)) for cell, _ in groupby(there))
        robots.append(Robot(number, cell_id(*start), stops=stops))
    instance = movingai_instance(grid, robots, "park", file)
    return instance, trace_of(instance, log)


def _cells(data: bytes, format: str, width: int, file: str) -> CellLog:
    if format not in CELL_LOGS:
        message = f"a log on a map must be one of {', '.join(CELL_LOGS)}, not {format}"
        raise Refusal("option", "$.from", RIGHT_LOG.id, message)
    return CELL_LOGS[format][0](RIGHT_LOG.text(data, file), width, file)
