"""The lines of the protocol: reading requests and writing responses. The rules are `protocol/...`.

A request is one line of JSON, `{"id": any, "op": name, ...}`, and so is the response: `{"id": same, "result": ...}`
or `{"id": same, "error": {"kind", "path", "rule", "message"}}`. The kinds of errors:

- `document`: a document in the request is malformed, or the line is no JSON;
- `request`: the request makes no sense (its fields, its robot, its tick, plans that break a rule);
- `option`: a planner's option;
- `limit`: the line is too long, a number or the work is larger than carproof takes, or its installation lacks an extra;
- `internal`: carproof has a fault; `rule` is null, and the next request is answered normally.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, Literal, TypeVar

import msgspec

from carp_spec import Refusal
from carp_spec.documents.decoding import require_json, uncapitalized, with_values
from carp_spec.rule import DESIGN
from carproof.input_rules import Code
from carproof.requests import below

VERSION = 1
LONGEST_LINE = 64 * 2**20
NULL = msgspec.Raw(b"null")
MISSING = msgspec.Raw()
T = TypeVar("T")


class ErrorDocument(msgspec.Struct, frozen=True):
    """The reason why a request was refused."""

    kind: Literal["document", "request", "option", "limit", "internal"]
    path: str
    rule: str | None
    message: str


class Response(msgspec.Struct, frozen=True, omit_defaults=True):
    """The answer to a request: a result, or an error."""

    id: msgspec.Raw
    result: Any = msgspec.UNSET
    error: ErrorDocument | msgspec.UnsetType = msgspec.UNSET


SHORT_LINE = Code("protocol/line", f"A request is a line of at most {LONGEST_LINE // 2**20} MiB.", DESIGN)
RIGHT_FIELDS = Code(
    "protocol/request",
    "A request is a JSON object with an id, an op that the oracle has, and the fields of that op and no others.",
    DESIGN,
)
SPOKEN_VERSION = Code("protocol/version", f"The version of the protocol is {VERSION}.", DESIGN)
PROTOCOL_RULES: tuple[Code, ...] = (SHORT_LINE, RIGHT_FIELDS, SPOKEN_VERSION)


_FIELDS = msgspec.json.Decoder(dict[str, msgspec.Raw])


class Request:
    """The fields of a request that its op has not taken yet; each is decoded when it is taken."""

    def __init__(self, line: bytes) -> None:
        require_json(line)
        try:
            self._fields = _FIELDS.decode(line)
        except msgspec.ValidationError as error:
            raise Refusal("request", "$", RIGHT_FIELDS.id, "a request must be an object") from error
        self.id = self._fields.pop("id", MISSING)

    def __contains__(self, name: str) -> bool:
        """Whether the field is present and not taken yet."""
        return name in self._fields

    def take(self, name: str, decode: Callable[[bytes], T]) -> T:
        """Decode a field and take it out."""
        if name not in self._fields:
            raise Refusal("request", f"$.{name}", RIGHT_FIELDS.id, "the field must be there")
        try:
            return decode(bytes(self._fields.pop(name)))
        except Refusal as refusal:
            raise below(f"$.{name}", refusal) from refusal

    def op(self) -> str:
        """The op; the request must have an id too."""
        if self.id is MISSING:
            raise Refusal("request", "$.id", RIGHT_FIELDS.id, "the field must be there")
        op: str = self.take("op", value_of(str))
        return op

    def options(self) -> dict[str, Any]:
        """All that is left, as options of a planner."""
        return {name: self.take(name, msgspec.json.decode) for name in list(self._fields)}

    def end(self) -> None:
        """Refuse a request with fields that its op does not have."""
        for name in self._fields:
            raise Refusal("request", f"$.{name}", RIGHT_FIELDS.id, "the op has no such field")


@cache
def value_of(kind: Any) -> Callable[[bytes], Any]:  # noqa: ANN401 - msgspec's own word for a type
    """A decoder of plain values, strict as documents are."""
    decoder = msgspec.json.Decoder(kind)

    def decode(data: bytes) -> Any:  # noqa: ANN401 - a value of the kind
        try:
            return decoder.decode(data)
        except msgspec.ValidationError as error:
            message, _, path = str(error).replace("`", "").partition(" - at ")
            reason = uncapitalized(with_values(message, kind, path))
            raise Refusal("request", path or "$", RIGHT_FIELDS.id, reason) from error

    return decode


def refused(refusal: Refusal) -> ErrorDocument:
    """The error of a refusal."""
    return ErrorDocument(refusal.kind, refusal.path, refusal.rule, refusal.message)
