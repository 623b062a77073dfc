"""Classes of documents made from those of the model, and values of either made from the other.

A field of the model is described in its class alone: name, type, default, and for a number its `Number`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from functools import cache, reduce
from operator import attrgetter, or_
from types import GenericAlias
from typing import Annotated, Any, TypeAlias, TypeVar, cast, get_args

import msgspec
from msgspec import NODEFAULT, UNSET, UnsetType

from carp_spec.shapes import Number

D = TypeVar("D", bound=msgspec.Struct)
K = TypeVar("K")
Fields: TypeAlias = Mapping[str, tuple[object, type[Any] | None]]


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
    getters = _getters(cast("Any", type(source)), kind)
    return kind(**given, **{name: get(source) for name, get in getters if name not in given})


def all_converted(sources: Sequence[Any], kind: Callable[..., K]) -> tuple[K, ...]:
    """Each of the values of one class, converted."""
    getters = _getters(cast("Any", type(sources[0])), kind) if sources else ()
    return tuple(map(kind, *(map(get, sources) for _, get in getters))) if getters else ()


@cache
def _getters(source: Any, kind: Any) -> Sequence[tuple[str, Callable[[Any], Any]]]:  # noqa: ANN401 - classes
    """How to get each field of a class from a value of another; the default of one becomes that of the other."""
    return [(name, _getter(name, *field, _fields(source))) for name, field in _fields(kind).items()]


def _getter(name: str, default: object, item: type[Any] | None, present: Fields) -> Callable[[Any], Any]:
    if name not in present:
        return lambda _: default
    get: Callable[[Any], Any] = attrgetter(name)
    left_out, _ = present[name]
    if item is not None:
        return lambda source: default if get(source) == left_out else all_converted(get(source), item)
    if default in (MISSING, left_out):
        return get
    return lambda source: default if (value := get(source)) == left_out else value


@cache
def _fields(kind: Any) -> Fields:  # noqa: ANN401 - a class of fields
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
