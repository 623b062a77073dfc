"""Reading and writing of any document: JSON, its format, and its shape.

Reading is strict. It refuses an unknown field, and a boolean or 1.0 in place of a whole number, and names the path and
the rule.
"""

import gc
import json
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from reprlib import repr as shown
from typing import Annotated, Final, TypeAlias, TypeVar

import msgspec

from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, rule
from carp_spec.shapes import SHAPE, require_shape

MOST_DIGITS: Final = 100
TOO_LONG: Final = b"0" * (MOST_DIGITS + 1)
EACH_DIGIT_AS_0: Final = bytes.maketrans(b"123456789", b"0" * 9)
ESCAPE: Final = b"\\u"  # the escape of half a surrogate pair is not text, though Python's parser accepts it
UNREADABLE: Final = (msgspec.DecodeError, UnicodeDecodeError, RecursionError)
Tick: TypeAlias = Annotated[int, msgspec.Meta(extra_json_schema={"minimum": 0})]
Positive: TypeAlias = Annotated[int, msgspec.Meta(extra_json_schema={"minimum": 1})]
D = TypeVar("D", bound=msgspec.Struct)
Q = TypeVar("Q")


class _Headed(msgspec.Struct, frozen=True):
    format: str


def _members(members: list[tuple[str, object]]) -> dict[str, object]:
    found = dict(members)
    if len(found) < len(members):
        counts = Counter(name for name, _ in members)
        name = next(name for name in found if counts[name] > 1)
        raise ValueError(f"an object has the name {name!r} {counts[name]} times")
    return found


def _whole_number(digits: str) -> int:
    if len(digits) > MOST_DIGITS and len(digits.removeprefix("-")) > MOST_DIGITS:
        raise ValueError(f"a whole number has more than {MOST_DIGITS} digits")
    return int(digits)


_DECODER: Final = json.JSONDecoder(object_pairs_hook=_members, parse_int=_whole_number)


def _parsed(data: bytes) -> object:
    return _DECODER.decode(data.decode())


def _place(data: bytes, error: str) -> str:
    """Line and column of a syntax error, each counted from 1, as a part of a sentence."""
    position = re.search(r"\(byte (\d+)\)", error)
    try:
        data.decode()
    except UnicodeDecodeError as undecoded:
        end = undecoded.start
    else:
        if position is None and "truncated" not in error:
            return ""
        end = len(data) if position is None else int(position[1])
    lines = data[:end].decode(errors="replace").split("\n")
    return f", and is not at line {len(lines)}, column {len(lines[-1]) + 1}"


def require_json(data: bytes) -> None:
    """Raise `Refusal` if the data is no JSON."""
    if decode_quickly(data, object) is not None:
        return
    try:
        msgspec.json.decode(data)
        _parsed(data)
    except (*UNREADABLE, ValueError) as error:
        message = f"the document must be JSON in UTF-8{_place(data, str(error))}: {error}"
        raise Refusal("document", "$", is_json.id, message) from error


@rule(
    "document/json",
    "A document is one JSON value in UTF-8; no object in it has a name twice, and no whole number has more than "
    f"{MOST_DIGITS} digits.",
    DESIGN,
)
def is_json(data: bytes) -> bool:
    try:
        require_json(data)
    except Refusal:
        return False
    return True


def _format(data: bytes) -> str | None:
    try:
        return msgspec.json.decode(data, type=_Headed).format
    except UNREADABLE:
        return None


@rule("document/format", "A document's format names its kind and version, like carproof-instance/1.", DESIGN)
def has_format(data: bytes, format: str) -> bool:
    return _format(data) == format


def uncapitalized(sentence: str) -> str:
    """The sentence as part of another: with a small first letter, unless its first word is an abbreviation."""
    return sentence if sentence[1:2].isupper() else sentence[:1].lower() + sentence[1:]


def with_values(message: str, kind: object, path: str) -> str:
    """Msgspec's message about a value of the kind; about one of a few allowed values, it lists these."""
    if not message.startswith("Invalid enum value"):
        return message
    from msgspec import inspect  # noqa: PLC0415 - most documents are right

    def values(kind: inspect.Type, names: Sequence[str]) -> Sequence[object]:
        if isinstance(kind, inspect.LiteralType):
            return kind.values
        fields = kind.fields if isinstance(kind, inspect.StructType) else ()
        return [each for field in fields if field.encode_name in names[:1] for each in values(field.type, names[1:])]

    allowed = " or ".join(map(str, values(inspect.type_info(kind), re.findall(r"\.(\w+)", path))))
    return f"{message}, it must be {allowed}" if allowed else message


def _shape_error(data: bytes, kind: type[D]) -> tuple[str, str] | None:
    """Where the document departs from its kind: the path, and what would be right there."""
    try:
        msgspec.json.decode(data, type=kind)
    except UNREADABLE as error:
        message, found, path = str(error).rpartition(" - at `")
        reason = with_values(message if found else path, kind, path if found else "$")
        return (path.rstrip("`") if found else "$", uncapitalized(reason).replace("`", ""))
    return None


@rule(
    SHAPE,
    "A document has exactly the fields and types of its JSON Schema; true, 1.0 and 1e3 are no whole numbers.",
    DESIGN,
)
def has_shape(data: bytes, kind: type[msgspec.Struct]) -> bool:
    return _shape_error(data, kind) is None


def decode(data: bytes, kind: type[D], format: str, exact: type[D] | None = None) -> D:
    """Decode a document of the kind, or raise `Refusal` with its first error.

    `exact` is a kind of the same documents that names errors more exactly. With it, `kind` has no defaults but `UNSET`.
    """
    document = decode_quickly(data, kind, has_defaults=exact is None)
    if document is not None:
        return document
    require_json(data)
    found = _format(data)
    if found != format:
        instead = f", and is {found}" if found and found.isprintable() and len(found) <= MOST_DIGITS else ""
        raise Refusal("document", "$.format", has_format.id, f"the format must be {format}{instead}")
    wrong = _shape_error(data, exact or kind)
    if wrong is not None:
        raise Refusal("document", wrong[0], has_shape.id, wrong[1])
    return msgspec.json.decode(data, type=kind)


def decode_quickly(data: bytes, kind: type[Q], *, has_defaults: bool = False) -> Q | None:
    """The document, or nothing if `decode` must look closer; it reads no document that `decode` refuses.

    msgspec keeps the last member of a name. Written again, the document has each member once, and the same strings, as
    they hold no escaped colon. So it has fewer colons only if the data has a name twice. Where the kind has defaults
    other than `UNSET`, absent members would be written, so it is read once more, as any JSON. msgspec also takes longer
    numbers than `decode`.
    """
    require_shape(data, bytes)
    if ESCAPE in data or TOO_LONG in data.translate(EACH_DIGIT_AS_0):
        return None
    try:
        data.decode()
        document = msgspec.json.decode(data, type=kind)
        again = msgspec.json.encode(msgspec.json.decode(data) if has_defaults else document)
    except (*UNREADABLE, ValueError):
        return None
    return document if data.count(b":") == again.count(b":") else None


@contextmanager
def without_collection() -> Iterator[None]:
    """Collect no garbage: where a million values are made there is none, and to look for it takes longer than that."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def write(document: object) -> bytes:
    """Write a document as one line of JSON; raises `Refusal` for a text that UTF-8 cannot express."""
    try:
        return msgspec.json.encode(document) + b"\n"
    except UnicodeEncodeError as error:
        message = f"all text must be such that UTF-8 can express it, not {shown(error.object)}"
        raise Refusal("document", "$", is_json.id, message) from None
