"""A Python function that plans whole instances."""

import traceback
from collections.abc import Callable
from typing import Any

import msgspec

from carp_spec import Instance, Solution
from carp_spec.documents.instances import read_instance, write_instance
from carp_spec.documents.solutions import write_solution
from carproof.conform.answers import NotAsked, Reply, decode_solution, protocol_error
from carproof.conform.cases import Case
from carproof.conform.findings import RIGHT_RESULT, Category, Fault, Finding, is_alive

Document = dict[str, Any]


def by_documents(planner: Callable[[Document], Document]) -> Callable[[Instance], Solution]:
    """A planner of documents as one of models."""

    def plan(instance: Instance) -> Solution:
        document = planner(msgspec.json.decode(write_instance(instance)))
        try:
            data = msgspec.json.encode(document)
        except (TypeError, ValueError, OverflowError) as error:
            raise protocol_error(
                RIGHT_RESULT.id, f"the planner's document cannot be written as JSON: {error}"
            ) from error
        return decode_solution(data)

    return plan


def _written(solution: Solution) -> bytes:
    try:
        return write_solution(solution)
    except Exception as error:
        raise protocol_error(RIGHT_RESULT.id, f"the planner's solution cannot be written as JSON: {error}") from error


class Function:
    """A planner that is called with an instance and returns a solution. Nothing limits its time.

    It gets an instance of its own, and its solution is written and read as a document. So the planner cannot change the
    objects that the judges look at.
    """

    def __init__(self, planner: Callable[[Instance], Solution], name: str) -> None:
        self._planner = planner
        self.name = name
        self.ops: tuple[str, ...] = ("plan",)

    def start(self) -> None:
        """It is there."""

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Call the function."""
        del seconds
        if case.op != "plan" or case.planner is not None:
            return NotAsked("it plans whole instances, by a planner of its own")
        try:
            solution: object = self._planner(read_instance(write_instance(case.instance)))
        except (Fault, KeyboardInterrupt):
            raise
        except BaseException as error:  # pytest.skip and sys.exit are no way out
            message = f"it raised {type(error).__name__}: {str(error).partition(chr(10))[0]}"
            raise Fault(Finding(Category.CRASH, is_alive.id, message, traceback.format_exc())) from error
        if not isinstance(solution, Solution):
            message = f"a planner must return a carp_spec.Solution, not {type(solution).__name__}"
            raise protocol_error(RIGHT_RESULT.id, message)
        return decode_solution(_written(solution))

    def finish(self) -> None:
        """Nothing runs on."""

    def kill(self) -> None:
        """Nothing runs on."""
