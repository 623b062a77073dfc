"""The answers of a program, decoded as strictly as documents."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, TypeAlias

import msgspec

from carp_spec import Refusal, Solution
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.decoding import UNREADABLE, require_json, uncapitalized
from carp_spec.documents.verdicts import VerdictDocument
from carp_spec.execution.traces import Trace
from carproof.conform.cases import Case
from carproof.conform.findings import RIGHT_RESULT, Category, Fault, Finding, is_accepted, is_response
from carproof.optima import OptimumDocument
from carproof.protocol.ops import OPS
from carproof.protocol.ops.op import reader_of
from carproof.protocol.ops.planning import QueryDocument

MOST_SHOWN = 200


@dataclass(frozen=True, slots=True)
class Skipped:
    """There is no answer: the program does not offer one, or it cannot even be `asked`, for want of words."""

    why: str
    asked: bool = True


Answer: TypeAlias = QueryDocument | Solution | VerdictDocument | OptimumDocument | BoundDocument | Trace
Reply: TypeAlias = Answer | Skipped


class Subject(ABC):
    """A subject that answers cases, with its name in reports and the ops that it offers."""

    name = ""
    ops: tuple[str, ...] = ()

    @abstractmethod
    def ask(self, case: Case, seconds: float | None = None) -> Reply:
        """Its reply, within this many seconds (`None`: the usual limit); raises `Fault` without a reply to judge."""

    def start(self) -> None:  # noqa: B027 - not all do
        """Get ready; raises `Fault` if that fails."""

    def finish(self, *, restart: bool = False) -> None:  # noqa: B027 - not all do
        """End, started again before if it was killed and `restart` asks for it; raises `Fault` if that fails."""

    def kill(self) -> None:  # noqa: B027 - not all do
        """Leave nothing behind."""


class _Response(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    id: msgspec.Raw
    result: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET
    skipped: str | msgspec.UnsetType = msgspec.UNSET
    error: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET


def protocol_error(rule: str, message: str) -> Fault:
    """The program broke the protocol."""
    return Fault(Finding(Category.PROTOCOL_ERROR, rule, message))


def shown(data: bytes) -> str:
    """The beginning of a line, printable."""
    text = data[:MOST_SHOWN].decode("utf-8", "backslashreplace")
    return repr(text) + (f" and {len(data) - MOST_SHOWN} more bytes" if len(data) > MOST_SHOWN else "")


def result_of(line: bytes, id: object) -> msgspec.Raw | Skipped:
    """The result in a response to the request with the id."""
    try:
        require_json(line)
        response = msgspec.json.decode(line, type=_Response)
    except Refusal as error:
        message = f"the response must obey {error.rule}: {error.message}, in {shown(line)}"
        raise protocol_error(is_response.id, message) from error
    except (*UNREADABLE, ValueError) as error:
        reason = str(error).replace("`", "")
        message = f"the response is not as it must be: {uncapitalized(reason)}, in {shown(line)}"
        raise protocol_error(is_response.id, message) from error
    fields = {name for name in ("id", "result", "skipped", "error") if getattr(response, name) is not msgspec.UNSET}
    if not is_response(fields):
        message = f"the response must have one of result, skipped and error: {shown(line)}"
        raise protocol_error(is_response.id, message)
    if not _same_id(bytes(response.id), id):
        raise protocol_error(is_response.id, f"the id must be {id!r}, not {shown(bytes(response.id))}")
    if isinstance(response.skipped, str):
        return Skipped(response.skipped)
    if not is_accepted(None if response.error is msgspec.UNSET else response.error):
        refusal = bytes(response.error) if isinstance(response.error, msgspec.Raw) else b""
        message = f"the program refuses a right request: {shown(refusal)}"
        raise Fault(Finding(Category.WRONG_ANSWER, is_accepted.id, message))
    return response.result if isinstance(response.result, msgspec.Raw) else msgspec.Raw(b"null")


def _same_id(data: bytes, id: object) -> bool:
    decoded = msgspec.json.decode(data)
    return type(decoded) is type(id) and bool(decoded == id)


def read_result(op: str, data: bytes | msgspec.Raw) -> Any:  # noqa: ANN401 - the result of the op
    """The result of an op, read as its type in the table says."""
    what = f"the result of {op} is not as it must be"
    try:
        return reader_of(OPS[op].result)(bytes(data))
    except Refusal as refusal:
        message = f"{what}: {refusal.path}: {refusal.message}, in {shown(bytes(data))}"
        raise protocol_error(RIGHT_RESULT.id, message) from refusal
    except (*UNREADABLE, ValueError) as error:
        raise protocol_error(RIGHT_RESULT.id, f"{what}: {error}") from error


def decode_solution(data: bytes) -> Solution:
    """A solution, as the result of `plan` is one."""
    solution: Solution = read_result("plan", data)
    return solution
