"""Records of plans, seen from Python: writing plans made elsewhere, reading plans, making room."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from carp_optimized.jit.references import Native
from carp_optimized.passes import record_plan
from carp_optimized.state.arrays import NEVER, Records, State
from carp_spec import Instance, Plan, ResourceId, RobotId
from carp_spec.documents.solutions import PlanColumns

T = TypeVar("T", bound=np.generic)


def write_plan(native: Native[State], instance: Instance, robot: int, plan: Plan) -> int:
    """The record of a plan that no query of the fleet has made."""
    leave = plan.visits[-1].leave
    resources = np.array([instance.graph.index[visit.resource] for visit in plan.visits], np.int32)
    enters = np.array([visit.enter for visit in plan.visits], np.int32)
    return record_plan(native, robot, resources, enters, NEVER if leave is None else leave)


def read_plan(state: State, names: Sequence[ResourceId], record: int, robots: Sequence[RobotId]) -> PlanColumns:
    """The plan of a record; resources and robots are given by their indices."""
    records = state.records
    first = int(records.visits_at[record])
    end = first + int(records.visits[record])
    last = int(records.leave[record])
    return PlanColumns(
        robots[int(records.robot[record])],
        tuple(map(names.__getitem__, records.resource[first:end].tolist())),
        tuple(records.enter[first:end].tolist()),
        None if last == NEVER else last,
    )


def enlarged(records: Records) -> Records:
    """The same records with twice the room; the new half takes no memory until it is used."""
    return Records._make([*(_with_room(each, 2 * len(each)) for each in records[:-1]), records.used.copy()])


def _with_room(array: npt.NDArray[T], length: int) -> npt.NDArray[T]:
    larger = np.zeros((length, *array.shape[1:]), array.dtype)
    larger[: len(array)] = array
    return larger
