"""A Python function that plans whole instances."""

import traceback
from collections.abc import Callable
from typing import Any

import msgspec

from carp_spec import Solution
from carp_spec.documents.instances import read_instance, write_instance
from carp_spec.documents.solutions import write_solution
from carproof.conform.answers import Reply, Subject, decode_solution, protocol_error
from carproof.conform.cases import Case
from carproof.conform.findings import RIGHT_RESULT, Category, Fault, Finding, is_alive


class Function(Subject):
    """A planner that takes an instance and returns a solution, or their `documents`. Nothing limits its time.

    It gets an instance of its own, and its solution is written and read as a document. So the planner cannot change the
    objects that the judges look at.
    """

    def __init__(self, planner: Callable[[Any], object], name: str, documents: bool = False) -> None:
        self._planner = planner
        self._documents = documents
        self.name = name
        self.ops = ("plan",)

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Call the function."""
        del seconds
        instance = write_instance(case.instance)
        try:
            planned = self._planner(msgspec.json.decode(instance) if self._documents else read_instance(instance))
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # pytest.skip and sys.exit are no way out
            message = f"it raised {type(error).__name__}: {str(error).partition(chr(10))[0]}"
            raise Fault(Finding(Category.CRASH, is_alive.id, message, traceback.format_exc())) from error
        if not (self._documents or isinstance(planned, Solution)):
            message = f"a planner must return a carp_spec.Solution, not {type(planned).__name__}"
            raise protocol_error(RIGHT_RESULT.id, message)
        try:
            written = write_solution(planned) if isinstance(planned, Solution) else msgspec.json.encode(planned)
        except Exception as error:
            what = "document" if self._documents else "solution"
            message = f"the planner's {what} cannot be written as JSON: {error}"
            raise protocol_error(RIGHT_RESULT.id, message) from error
        return decode_solution(written)
