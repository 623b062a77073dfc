"""What a program answers, decoded as strictly as documents are."""

from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import msgspec

from carp_spec import Plan, Refusal, ResourceId, Solution, Visit, read_solution
from carp_spec.bounds import BoundDocument
from carp_spec.documents import VerdictDocument, is_json
from carproof.conform.cases import Case
from carproof.conform.findings import Category, Fault, Finding, is_accepted, is_response, is_result

T = TypeVar("T")
MOST_SHOWN = 200


@dataclass(frozen=True, slots=True)
class Skipped:
    """The program does not offer what was asked."""

    why: str


@dataclass(frozen=True, slots=True)
class NotAsked:
    """The program cannot be asked this: its kind of input has no words for it."""

    why: str


@dataclass(frozen=True, slots=True)
class QueryAnswer:
    """The answer to `query`."""

    plan: Plan | None


@dataclass(frozen=True, slots=True)
class OptimumAnswer:
    """The answer to `optimum`; `solution` is `None` where there is no solution with a plan for each robot."""

    cost: int | None
    lower: int | None
    proved: bool
    solution: Solution | None


Answer: TypeAlias = QueryAnswer | Solution | VerdictDocument | OptimumAnswer | BoundDocument
Reply: TypeAlias = Answer | Skipped | NotAsked


class _Response(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    id: msgspec.Raw
    result: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET
    skipped: str | msgspec.UnsetType = msgspec.UNSET
    error: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET


class StartResult(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a program says of itself."""

    name: str
    version: str
    ops: tuple[str, ...]


class _QueryResult(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    plan: tuple[tuple[ResourceId, int, int | None], ...] | None


class _OptimumResult(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    cost: int | None
    lower: int | None
    proved: bool
    solution: msgspec.Raw


def protocol_error(rule: str, message: str) -> Fault:
    """The program broke the protocol."""
    return Fault(Finding(Category.PROTOCOL_ERROR, rule, message))


def shown(data: bytes) -> str:
    """The beginning of a line, printable."""
    text = data[:MOST_SHOWN].decode("utf-8", "backslashreplace")
    return repr(text) + (f" and {len(data) - MOST_SHOWN} more bytes" if len(data) > MOST_SHOWN else "")


def _decoded(data: bytes | msgspec.Raw, kind: type[T], rule: str, what: str) -> T:
    try:
        return msgspec.json.decode(data, type=kind)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError, ValueError) as error:
        reason = str(error).replace("`", "")
        raise protocol_error(rule, f"{what}: {reason[:1].lower()}{reason[1:]}, in {shown(bytes(data))}") from error


def result_of(line: bytes, id: object) -> msgspec.Raw | Skipped:
    """The result in a response to the request with the id."""
    if not is_json(line):
        raise protocol_error(is_response.id, f"the response must obey {is_json.id}: {shown(line)}")
    response = _decoded(line, _Response, is_response.id, "the response is not as it must be")
    fields = {name for name in ("id", "result", "skipped", "error") if getattr(response, name) is not msgspec.UNSET}
    if not is_response(fields):
        message = f"the response must have one of result, skipped and error: {shown(line)}"
        raise protocol_error(is_response.id, message)
    if not _same_id(bytes(response.id), id):
        raise protocol_error(is_response.id, f"the id must be {id!r}, not {shown(bytes(response.id))}")
    if isinstance(response.skipped, str):
        return Skipped(response.skipped)
    if not is_accepted(None if response.error is msgspec.UNSET else response.error):
        error = bytes(response.error) if isinstance(response.error, msgspec.Raw) else b""
        message = f"the program refuses a right request: {shown(error)}"
        raise Fault(Finding(Category.WRONG_ANSWER, is_accepted.id, message))
    return response.result if isinstance(response.result, msgspec.Raw) else msgspec.Raw(b"null")


def _same_id(data: bytes, id: object) -> bool:
    decoded = msgspec.json.decode(data)
    return type(decoded) is type(id) and bool(decoded == id)


def start_result(data: msgspec.Raw) -> StartResult:
    """The result of `start`."""
    return _decoded(data, StartResult, is_result.id, "the result of start is not as it must be")


def decode_answer(case: Case, data: msgspec.Raw) -> Answer:
    """The result of a case's op."""
    what = f"the result of {case.op} is not as it must be"
    if case.op == "check":
        return _decoded(data, VerdictDocument, is_result.id, what)
    if case.op == "bound":
        return _decoded(data, BoundDocument, is_result.id, what)
    if case.op == "query":
        visits = _decoded(data, _QueryResult, is_result.id, what).plan
        robot = case.instance.robots[0].id if case.robot is None else case.robot
        return QueryAnswer(None if visits is None else Plan(robot, tuple(Visit(*visit) for visit in visits)))
    if case.op == "optimum":
        found = _decoded(data, _OptimumResult, is_result.id, what)
        solution = None if bytes(found.solution) == b"null" else decode_solution(bytes(found.solution))
        return OptimumAnswer(found.cost, found.lower, found.proved, solution)
    return decode_solution(bytes(data))


def decode_solution(data: bytes) -> Solution:
    """A solution document."""
    try:
        return read_solution(data)
    except Refusal as refusal:
        message = f"the solution is not as it must be, at {refusal}; it is {shown(data)}"
        raise protocol_error(is_result.id, message) from refusal
    except (ValueError, RecursionError) as error:
        raise protocol_error(is_result.id, f"the solution cannot be read: {error}") from error
