"""Logs of cells, tick by tick: where each robot was, and the cells that it served."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from carp_spec import Instance, Plan, Visit
from carp_spec.documents.decoding import without_collection
from carp_spec.execution.traces import Trace
from carp_spec.rule import DESIGN
from carproof.formats.walks import Cell, namer
from carproof.input_rules import Code

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

RIGHT_LOG = Code("adapter/log", "A log is as its format has it, and has as many robots as its instance.", DESIGN)


@dataclass(frozen=True, slots=True)
class CellLog:
    """The cell of each robot at each tick from 0, and the cells that it served, in order.

    A walk has the shape (ticks, 2): x and y at each tick, below a billion.
    """

    walks: Sequence["npt.NDArray[np.int32]"]
    stops: Sequence[Sequence[Cell]]


CellReader: TypeAlias = Callable[[str, int, str], CellLog]
"""Reads a text; the width of the map turns numbers of cells into x and y. Raises `Refusal` with the file."""


@without_collection()
def trace_of(instance: Instance, log: CellLog) -> Trace:
    """The trace of a log; its k-th robot is the k-th of the instance."""
    if len(log.walks) != len(instance.robots):
        message = f"the log must have a robot for each of {len(instance.robots)}, and has {len(log.walks)}"
        raise RIGHT_LOG.refuse("INSTANCE", message)
    name = namer(instance)
    ticks = range(max(map(len, log.walks), default=1))
    shared = [*ticks]  # one object a tick, however many visits begin at it
    plans = []
    for robot, walk in zip(instance.robot, log.walks, strict=True):
        enters = [0, *((walk[1:] != walk[:-1]).any(axis=1).nonzero()[0] + 1).tolist()]
        cells = map(tuple, walk[enters].tolist())
        names = map(name, cells)
        entered = [*map(shared.__getitem__, enters)]
        plans.append(Plan(robot, tuple(map(Visit, names, entered, [*entered[1:], None]))))
    return Trace(ticks[-1], tuple(plans))
