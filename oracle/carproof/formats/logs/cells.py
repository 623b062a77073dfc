"""Logs of cells, tick by tick: where each robot was, and the cells that it served."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from carp_spec import Instance, Plan, Refusal, Visit
from carp_spec.execution.traces import Trace
from carp_spec.rule import DESIGN
from carproof.formats.walks import Cell
from carproof.generate.grid import cell_id
from carproof.input_rules import Code

RIGHT_LOG = Code("adapter/log", "A log is as its format has it, and has as many robots as its instance.", DESIGN)


@dataclass(frozen=True, slots=True)
class CellLog:
    """The cell of each robot at each tick from 0, and the cells that it served, in order."""

    walks: Sequence[Sequence[Cell]]
    stops: Sequence[Sequence[Cell]]


CellReader: TypeAlias = Callable[[str, int, str], CellLog]
"""Reads a text; the width of the map turns numbers of cells into x and y. Raises `Refusal` with the file."""


def wrong(where: str, message: str) -> Refusal:
    """The refusal of a malformed log."""
    return Refusal("document", where, RIGHT_LOG.id, message)


def trace_of(instance: Instance, log: CellLog) -> Trace:
    """The trace of a log; its k-th robot is the k-th of the instance."""
    if len(log.walks) != len(instance.robots):
        message = f"the log must have a robot for each of {len(instance.robots)}, and has {len(log.walks)}"
        raise wrong("INSTANCE", message)
    resources = {(each.x, each.y): each.id for each in instance.graph.resources}
    plans = []
    for robot, walk in zip(instance.robot, log.walks, strict=True):
        enters = [tick for tick, cell in enumerate(walk) if tick == 0 or cell != walk[tick - 1]]
        leaves: list[int | None] = [*enters[1:], None]
        cells = [walk[tick] for tick in enters]
        names = [resources.get(cell, cell_id(*cell)) for cell in cells]
        plans.append(Plan(robot, tuple(map(Visit, names, enters, leaves))))
    return Trace(max((len(walk) for walk in log.walks), default=1) - 1, tuple(plans))
