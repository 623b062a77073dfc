"""A program that executes plans: it decides at each tick which robots go on."""

from typing import Any

from carp_spec import RobotId
from carp_spec.execution.traces import Trace
from carproof.conform.answers import Reply, protocol_error
from carproof.conform.cases import EXECUTION, Case
from carproof.conform.findings import answers_enough
from carproof.conform.judging.driving import execution
from carproof.conform.programs.program import Program
from carproof.protocol.ops import OPS


class Executor:
    """A program that decides at each tick which robots enter their next visit, by the op `drive`."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self.ops: tuple[str, ...] = (EXECUTION,)

    @property
    def name(self) -> str:
        """The program's name."""
        return self._program.name

    def start(self) -> None:
        """Start the program; raises `Fault` if it does not offer the op."""
        self._program.start()
        if "drive" not in self._program.ops:
            raise protocol_error(answers_enough.id, "the answer to start of an executor must name drive")

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """The trace of the execution, up to the first collision or the last tick."""

        def decide(trace: Trace, ready: tuple[RobotId, ...]) -> Any:  # noqa: ANN401 - of the op
            asked = {"instance": case.instance, "solution": case.solution, "trace": trace, "ready": ready}
            return self._program.answer("drive", OPS["drive"].request_fields(asked), seconds)

        return execution(case, decide)

    def finish(self) -> None:
        """Ask the program to stop; raises `Fault` if it does not end with 0."""
        self._program.finish()

    def kill(self) -> None:
        """End the program."""
        self._program.kill()
