"""A program that speaks the protocol: a process that stays up, and is started again when it fails."""

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from carp_spec.permutations import splitmix64
from carproof.conform.answers import Reply, Skipped, protocol_error, read_result, result_of
from carproof.conform.cases import Case, request_fields
from carproof.conform.findings import Fault, Finding, is_response
from carproof.conform.programs.child import Child, Limits
from carproof.protocol.lines import VERSION

STARTING = 5
"""A program that has just been started may take this many times as long for its first answer."""
SEARCHING = 0.6
"""The part of the time for an answer that a program has to search for an optimum."""
_ID_BITS = 31


def request_ids(seed: int) -> Iterator[int | str]:
    """Ids that reveal nothing: numbers and strings by turns."""
    for number in splitmix64(seed):
        yield number >> (64 - _ID_BITS) if number & 1 else f"{number:016x}"


class Program:
    """A program that speaks the protocol. It is started when it is first asked, and after each of its faults."""

    def __init__(self, command: Sequence[str], limits: Limits, seed: int = 0) -> None:
        self._command = command
        self._limits = limits
        self._ids = request_ids(seed)
        self._child: Child | None = None
        self.name = command[0]
        self.ops: tuple[str, ...] = ()

    def start(self) -> None:
        """Start the process and learn its ops; raises `Fault` if it does not say them."""
        self._child = Child(self._command, self._limits)
        result = self._request("start", {"version": VERSION}, STARTING * self._limits.seconds)
        if isinstance(result, Skipped):
            raise self._broken(protocol_error(is_response.id, "a program must answer start"))
        try:
            said = read_result("start", result)
        except Fault as fault:
            raise self._broken(fault) from fault
        self.name = f"{said.name} {said.version}"
        self.ops = said.ops

    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Ask the process, a new one if the last is gone."""
        fields = request_fields(case)
        if case.op == "optimum":
            fields["limit"] = SEARCHING * (seconds or self._limits.seconds)
        reply: Reply = self.answer(case.op, fields, seconds)
        return reply

    def answer(self, op: str, fields: dict[str, Any], seconds: float | None = None) -> Any:  # noqa: ANN401 - of the op
        """The result of a request, or `Skipped`; from a new process if the last is gone."""
        if self._child is None:
            self.start()
        result = self._request(op, fields, seconds or self._limits.seconds)
        if isinstance(result, Skipped):
            return result
        try:
            return read_result(op, result)
        except Fault as fault:
            raise self._broken(fault) from fault

    def _request(self, op: str, fields: dict[str, Any], seconds: float) -> msgspec.Raw | Skipped:
        """Send a request; a program that breaks the protocol is started again before the next one."""
        assert self._child is not None  # noqa: S101 - a promise of ours
        id = next(self._ids)
        line = msgspec.json.encode({"id": id, "op": op, **fields}) + b"\n"
        try:
            return result_of(self._child.ask(line, seconds), id)
        except Fault as fault:
            raise self._broken(fault) from fault

    def _broken(self, fault: Fault) -> Fault:
        """The fault with the end of the process's standard error; the process is ended."""
        finding = fault.finding
        stderr = finding.stderr or (self._child.stderr if self._child is not None else "")
        self.kill()
        return Fault(Finding(finding.category, finding.rule, finding.message, stderr))

    def finish(self) -> None:
        """Ask the process to stop; raises `Fault` if it does not end with 0."""
        if self._child is None:
            return
        result = self._request("stop", {}, self._limits.seconds)
        try:
            if isinstance(result, Skipped) or bytes(result).strip() != b"{}":
                raise protocol_error(is_response.id, "the result of stop must be {}")
            self._child.end(self._limits.seconds)
        except Fault as fault:
            raise self._broken(fault) from fault
        self.kill()

    def kill(self) -> None:
        """End the process."""
        if self._child is not None:
            self._child.kill()
            self._child = None
