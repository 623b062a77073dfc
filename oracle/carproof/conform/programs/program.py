"""A program that speaks the protocol: a process that stays up, and is started again when it fails."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import msgspec

from carp_spec import RobotId
from carp_spec.execution.traces import Trace
from carp_spec.permutations import splitmix64
from carproof.conform.answers import Reply, Skipped, Subject, protocol_error, read_result, result_of
from carproof.conform.cases import EXECUTION, Case, request_fields
from carproof.conform.findings import Fault, is_response
from carproof.conform.judging.driving import execution
from carproof.conform.programs.child import Child, Limits
from carproof.protocol.lines import VERSION
from carproof.protocol.ops import OPS

STARTING = 5
"""A program that has just been started may take this many times as long for its first answer."""
SEARCHING = 0.6
"""The part of the time for an answer that a program has to search for an optimum."""
_ID_BITS = 31


def request_ids(seed: int) -> Iterator[int | str]:
    """Ids that reveal nothing: numbers and strings by turns."""
    for number in splitmix64(seed):
        yield number >> (64 - _ID_BITS) if number & 1 else f"{number:016x}"


class Program(Subject):
    """A program that speaks the protocol. It is started when it is first asked, and after each of its faults."""

    def __init__(self, command: Sequence[str], limits: Limits, seed: int = 0) -> None:
        self._command = command
        self._limits = limits
        self._ids = request_ids(seed)
        self._child: Child | None = None
        self.name = command[0]

    def start(self) -> None:
        """Start the process and learn its ops; raises `Fault` if it does not say them."""
        self._child = Child(self._command, self._limits)
        with self._ended_by_faults(self._child):
            result = self._request(self._child, "start", {"version": VERSION}, STARTING * self._limits.seconds)
            if isinstance(result, Skipped):
                raise protocol_error(is_response.id, "a program must answer start")
            said = read_result("start", result)
        self.name = f"{said.name} {said.version}"
        self.ops = said.ops

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Ask the process, or let it drive an execution up to the first collision or the last tick."""

        def decide(trace: Trace, ready: tuple[RobotId, ...]) -> Any:  # noqa: ANN401 - of the op
            asked = {"instance": case.instance, "solution": case.solution, "trace": trace, "ready": ready}
            return self.answer("drive", OPS["drive"].request_fields(asked), seconds)

        if case.op == EXECUTION:
            return execution(case, decide)
        fields = request_fields(case)
        if case.op == "optimum":
            fields["limit"] = SEARCHING * (seconds or self._limits.seconds)
        reply: Reply = self.answer(case.op, fields, seconds)
        return reply

    def answer(self, op: str, fields: dict[str, Any], seconds: float | None = None) -> Any:  # noqa: ANN401 - of the op
        """The result of a request, or `Skipped`; from a new process if the last is gone."""
        if self._child is None:
            self.start()
        assert self._child is not None  # noqa: S101 - it has been started
        with self._ended_by_faults(self._child):
            result = self._request(self._child, op, fields, seconds or self._limits.seconds)
            return result if isinstance(result, Skipped) else read_result(op, result)

    def _request(self, child: Child, op: str, fields: dict[str, Any], seconds: float) -> msgspec.Raw | Skipped:
        id = next(self._ids)
        line = msgspec.json.encode({"id": id, "op": op, **fields}) + b"\n"
        return result_of(child.ask(line, seconds), id)

    @contextmanager
    def _ended_by_faults(self, child: Child) -> Iterator[None]:
        """End a process that breaks the protocol; the fault has the end of its standard error."""
        try:
            yield
        except Fault as fault:
            self.kill()
            finding = fault.finding
            raise Fault(replace(finding, stderr=finding.stderr or child.stderr)) from fault

    def finish(self, *, restart: bool = False) -> None:
        """Ask the process to stop, or a new one if that is gone; raises `Fault` if it does not end with 0."""
        if self._child is None and restart:
            self.start()
        if self._child is None:
            return
        with self._ended_by_faults(self._child):
            result = self._request(self._child, "stop", {}, self._limits.seconds)
            if isinstance(result, Skipped) or bytes(result).strip() != b"{}":
                raise protocol_error(is_response.id, "the result of stop must be {}")
            self._child.end(self._limits.seconds)
        self.kill()

    def kill(self) -> None:
        """End the process."""
        if self._child is not None:
            self._child.kill()
            self._child = None
