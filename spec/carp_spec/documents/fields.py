"""Classes of documents made from those of the model, and values of either made from the other.

A field of the model is described in its class alone: name, type, default, and for a number its `Number`.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from functools import cache, reduce
from operator import attrgetter, or_
from types import GenericAlias
from typing import Annotated, Any, TypeVar, cast, get_args

import msgspec
from msgspec import NODEFAULT, UNSET, UnsetType

from carp_spec.shapes import Number

D = TypeVar("D", bound=msgspec.Struct)
K = TypeVar("K")


def describes(kind: type[Any], *others: str) -> Callable[[type[D]], type[D]]:
    """Add to a document's class the fields of a class of the model, but for those that it has, and the others.

    A number and a truth are always written. Anything else is left out where it has its default.
    """

    def decorate(document: type[D]) -> type[D]:
        present = {*others, *document.__struct_fields__}
        more = [_described(each) for each in fields(kind) if each.init and each.name not in present]
        names = {"__doc__": document.__doc__, "__module__": document.__module__}
        described = msgspec.defstruct(
            document.__name__, more, bases=(document,), namespace=names, frozen=True, forbid_unknown_fields=True
        )
        return cast("type[D]", described)

    return decorate


def _described(field: Any) -> tuple[str, Any] | tuple[str, Any, Any]:  # noqa: ANN401 - a field of a dataclass
    least = [each.least for each in get_args(field.type) if isinstance(each, Number)]
    item = _item(field.type)
    of = field.type if item is None else GenericAlias(tuple, (_document_of(item), ...))
    if field.default is MISSING:
        return field.name, of
    if least:
        return field.name, Annotated[int, msgspec.Meta(extra_json_schema={"minimum": least[0]})], field.default
    if isinstance(field.default, bool):
        return field.name, of, field.default
    kinds = get_args(of) if field.default is None else (of,)
    return field.name, reduce(or_, (each for each in kinds if each is not type(None)), UnsetType), UNSET


def _document_of(kind: Any) -> type[msgspec.Struct]:  # noqa: ANN401 - a class of the model
    """The class of the documents of values that stand in another's, with the words of the model."""
    names = {"__doc__": kind.__doc__, "__module__": kind.__module__}
    return describes(kind)(msgspec.defstruct(f"{kind.__name__}Document", (), namespace=names, frozen=True))


def converted(source: Any, kind: Callable[..., K], **given: Any) -> K:  # noqa: ANN401 - a value of the model or of a document
    """A value of the model from one of its document's class, or the other way: their fields have the same names.

    What is given has been converted.
    """
    missing = (name for name in _fields(kind) if name not in given)
    return kind(**given, **{name: next(iter(_column([source], kind, name))) for name in missing})


def all_converted(sources: Sequence[Any], kind: Callable[..., K]) -> tuple[K, ...]:
    """Each of the values of one class, converted."""
    return tuple(map(kind, *(_column(sources, kind, name) for name in _fields(kind))))


def _column(sources: Sequence[Any], kind: Callable[..., Any], name: str) -> Iterable[Any]:
    """The values of one field; the default of the source's class becomes the other's."""
    default, item = _fields(kind)[name]
    source: Any = type(sources[0]) if sources else None
    present = _fields(source) if sources else {}
    if name not in present:
        return [default] * len(sources)
    values = map(attrgetter(name), sources)
    left_out = present[name][0]
    if item is None and default in (MISSING, left_out):
        return values
    return [default if each == left_out else each if item is None else all_converted(each, item) for each in values]


@cache
def _fields(kind: Any) -> Mapping[str, tuple[object, type[Any] | None]]:  # noqa: ANN401 - a class of fields
    """The default of each field that is given, and the class of the items of one that holds values with fields."""
    if is_dataclass(kind):
        return {each.name: (each.default, _item(each.type)) for each in fields(kind) if each.init}
    return {
        each.name: (MISSING if each.default is NODEFAULT else each.default, _item(each.type))
        for each in msgspec.structs.fields(kind)
    }


def _item(kind: Any) -> type[Any] | None:  # noqa: ANN401 - any type
    inside = get_args(kind)
    if inside[1:] == (...,):
        return inside[0] if is_dataclass(inside[0]) or hasattr(inside[0], "__struct_fields__") else None
    return next(filter(None, map(_item, inside)), None)
