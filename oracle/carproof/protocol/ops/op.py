"""An op of the protocol: a handler with its request and its result, and the JSON of these.

Each parameter of the handler is a field of the request, or several if it holds options (`OPTIONS`). A type in
`DOCUMENTS` stands in JSON as its document; any other type is one that msgspec reads and writes.
"""

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, asdict, dataclass
from functools import cache
from inspect import signature
from types import NoneType
from typing import Any, Literal, Union, get_args, get_type_hints

import msgspec

from carp_spec import Instance, Neighbourhood, Planner, Robot, Solution
from carp_spec.documents.bounds import BoundDocument, read_bound
from carp_spec.documents.instances import (
    InstanceDocument,
    RobotDocument,
    instance_document,
    read_instance,
    robot_document,
    robot_of,
)
from carp_spec.documents.query_certificates import QueryCertificateDocument, read_query_certificate
from carp_spec.documents.solutions import (
    SolutionDocument,
    TraceDocument,
    read_solution,
    read_trace,
    solution_document,
    trace_document,
)
from carp_spec.execution.traces import Trace
from carp_spec.inputs.options import require_polish_options
from carproof.api.fleet import Fleet
from carproof.engines import Engine
from carproof.planner_options import PLANNERS, planner_named
from carproof.protocol.lines import Request, value_of


@dataclass(frozen=True, slots=True)
class Form:
    """The JSON form of a type: the document's class, its reader, and its writer."""

    document: type[msgspec.Struct]
    read: Callable[[bytes], Any]
    make: Callable[[Any], Any] = lambda document: document


DOCUMENTS: Mapping[Any, Form] = {
    Instance: Form(InstanceDocument, read_instance, instance_document),
    Robot: Form(RobotDocument, lambda data: robot_of(value_of(RobotDocument)(data)), robot_document),
    Solution: Form(SolutionDocument, read_solution, solution_document),
    BoundDocument: Form(BoundDocument, read_bound),
    Trace: Form(TraceDocument, read_trace, trace_document),
    QueryCertificateDocument: Form(QueryCertificateDocument, read_query_certificate),
}


@dataclass(frozen=True, slots=True)
class PolishOptions:
    """The rounds or seconds of a polish, and the seed."""

    iterations: int | None = None
    seconds: float | None = None
    seed: int = 0


def _planner(request: Request) -> Planner | None:
    if "planner" in request:
        return planner_named(request.take("planner", value_of(str)), request.options())
    options = request.options()
    return planner_named(Neighbourhood.name, options) if options else None


def _polish_options(request: Request) -> PolishOptions:
    names = [each.name for each in dataclasses.fields(PolishOptions) if each.name in request]
    options = PolishOptions(**{name: request.take(name, msgspec.json.decode) for name in names})
    require_polish_options(options.iterations, options.seconds, options.seed)
    return options


@dataclass(frozen=True, slots=True)
class Options:
    """Options that stand in a request beside its other fields: their classes, and the function that reads them.

    Where there are several classes, the field `planner` names one.
    """

    kinds: tuple[type[Any], ...]
    take: Callable[[Request], Any]


OPTIONS: Mapping[Any, Options] = {
    Neighbourhood: Options((Neighbourhood,), lambda request: planner_named(Neighbourhood.name, request.options())),
    Planner | None: Options(tuple(PLANNERS.values()), _planner),
    PolishOptions: Options((PolishOptions,), _polish_options),
}


@dataclass(frozen=True, slots=True)
class Field:
    """A field of a request in JSON; a field without default is required."""

    name: str
    type: Any
    default: Any = MISSING


@dataclass(frozen=True, slots=True)
class Session:
    """What a server has between requests: its planners, and the fleets that it keeps, by name."""

    engine: Engine
    fleets: dict[str, Fleet] = dataclasses.field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Op:
    """An op: `parts` are the parameters of its handler that a request has, `result` is what the handler returns.

    The other parameters of a handler, `session` and `engine`, are `given` by the server.
    """

    name: str
    parts: tuple[Field, ...]
    result: Any
    handle: Callable[..., Any]
    given: frozenset[str]

    def read(self, request: Request) -> dict[str, Any]:
        """Read the fields of a request; raises `Refusal` for the first wrong one, and for an unknown one."""
        values = {}
        for part in self.parts:
            if part.type in OPTIONS:
                values[part.name] = OPTIONS[part.type].take(request)
            elif part.default is MISSING or part.name in request:
                values[part.name] = request.take(part.name, reader_of(part.type))
        request.end()
        return values

    def call(self, values: Mapping[str, Any], session: Session) -> Any:  # noqa: ANN401 - the op's own result
        """What the handler returns."""
        ours = {"session": session, "engine": session.engine}
        return self.handle(**values, **{name: ours[name] for name in self.given})

    def answer(self, request: Request, session: Session) -> object:
        """The result of a request, as JSON holds it."""
        return made(self.call(self.read(request), session))

    def request_fields(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The fields of a request besides id and op; what is `None` is left out."""
        fields: dict[str, Any] = {}
        for part in self.parts:
            value = values.get(part.name)
            if value is None or part.type not in OPTIONS:
                fields[part.name] = made(value)
                continue
            name = {"planner": value.name} if len(OPTIONS[part.type].kinds) > 1 else {}
            fields |= {**name, **asdict(value)}
        return {name: value for name, value in fields.items() if value is not None}

    @property
    def title(self) -> str:
        """Its name in the schema."""
        return "".join(word.capitalize() for word in re.split("[-/]", self.name))

    @property
    def statement(self) -> str:
        """The description of the op, from its handler."""
        return " ".join((self.handle.__doc__ or "").split())

    @property
    def fields(self) -> Iterator[Field]:
        """The fields of its request besides id and op."""
        for part in self.parts:
            if part.type not in OPTIONS:
                yield Field(part.name, document_of(part.type), part.default)
                continue
            kinds = OPTIONS[part.type].kinds
            if len(kinds) > 1:
                yield Field("planner", Literal[tuple(PLANNERS)], Neighbourhood.name)
            yield from {each.name: each for kind in kinds for each in _fields_of(kind)}.values()


def _fields_of(kind: type[Any]) -> list[Field]:
    hints = get_type_hints(kind)
    return [Field(each.name, hints[each.name], each.default) for each in dataclasses.fields(kind)]


def op_of(handle: Callable[..., Any]) -> Op:
    """The op of a handler, by its annotations; `_` in the handler's name is `-` in the op's, and `/` after fleet."""
    hints = get_type_hints(handle)
    name = handle.__name__.replace("fleet_", "fleet/").replace("_", "-")
    given = frozenset({"session", "engine"} & hints.keys())
    parameters = [each for each in signature(handle).parameters.values() if each.name not in given]
    parts = (
        Field(each.name, hints[each.name], MISSING if each.default is each.empty else each.default)
        for each in parameters
    )
    return Op(name, tuple(parts), hints["return"], handle, given)


def _required(hint: Any) -> Any:  # noqa: ANN401 - a type hint
    """The type of a field that is present; a field that may be left out must not be null."""
    kinds = tuple(kind for kind in get_args(hint) if kind is not NoneType)
    return Union[kinds] if NoneType in get_args(hint) else hint  # noqa: UP007 - made of a tuple


def document_of(hint: Any) -> Any:  # noqa: ANN401 - a type hint
    """The type of what JSON holds."""
    kind = _required(hint)
    return DOCUMENTS[kind].document if kind in DOCUMENTS else kind


@cache
def reader_of(hint: Any) -> Callable[[bytes], Any]:  # noqa: ANN401 - a type hint
    """The decoder of a field or a result."""
    kind = _required(hint)
    return DOCUMENTS[kind].read if kind in DOCUMENTS else value_of(kind)


def made(value: object) -> Any:  # noqa: ANN401 - whatever msgspec writes
    """The JSON value of a field or a result."""
    return DOCUMENTS[type(value)].make(value) if type(value) in DOCUMENTS else value
