"""The test vectors that a program can be asked. It sees their questions alone; the judges find the answers anew."""

from collections.abc import Iterator, Sequence

from carp_spec import Carp, Neighbourhood, Planner, planner_named
from carp_spec.vectors import Vector, vectors
from carproof.conform.cases import ASKED_OPS, Case, Op
from carproof.conform.levels import Level

_NO_OPTIONS = frozenset({"solution", "robot", "now", "planner", "limit"})


def vector_cases(ops: Sequence[str], level: Level, whole: bool) -> Iterator[Case]:
    """The vectors of the ops that are offered; those with malformed documents are for readers of documents.

    A program need not know of instances that forbid following.
    """
    for vector in vectors():
        op = next((op for op in ASKED_OPS if op == vector.op), None)
        is_known = "refused" not in vector.answer and "following" not in (vector.instance or {})
        if op is not None and op in ops and is_known and _is_asked(vector, level, whole):
            yield _case(vector, op, whole)


def _is_asked(vector: Vector, level: Level, whole: bool) -> bool:
    """Whether the level speaks of it: below `exact` programs are asked for no planner but CARP."""
    if vector.op == "plan":
        return whole or level >= Level.EXACT or isinstance(_planner(vector), Carp)
    return vector.op != "optimum" or level >= Level.COMPLETE


def _planner(vector: Vector) -> Planner:
    options = {name: value for name, value in vector.input.items() if name not in _NO_OPTIONS}
    return planner_named(vector.input.get("planner", Neighbourhood.name), options)


def _case(vector: Vector, op: Op, whole: bool) -> Case:
    planner = None if whole or op not in ("plan", "add") else _planner(vector)
    instance = vector.read_instance()
    if "solution" not in vector.input:
        return Case("vectors", vector.id, op, instance, planner=planner)
    robot, now = vector.input.get("robot"), vector.input.get("now", 0)
    return Case("vectors", vector.id, op, instance, vector.read_solution(), robot, now, planner)
