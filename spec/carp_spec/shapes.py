"""The types of values: where a value departs from the annotations of its class, at the path of its document."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from functools import cache, wraps
from operator import attrgetter
from reprlib import repr as shown
from types import NoneType
from typing import Annotated, Any, TypeVar, cast, get_args, get_origin

import msgspec

from carp_spec.refusal import Refusal

T = TypeVar("T")
SHAPE = "document/shape"
PATHS = {
    "ResourceGraph.resources": ".nodes",
    "Visit.resource": "[0]",
    "Visit.enter": "[1]",
    "Visit.leave": "[2]",
}
"""The fields that have another path than their name."""
ENDS = (".source", ".target")
"""The members of an edge, a pair of one type."""
WORDS = {str: "a string", bytes: "bytes", int: "a whole number", bool: "true or false", NoneType: "None"}


@dataclass(frozen=True, slots=True)
class Number:
    """Of a whole number of the model: the least that it can be, and the feature of an instance in which it is more.

    It annotates the type of a field. Schemas, random drawing, features and smaller questions follow from it.
    """

    least: int
    feature: str


def numbers_of(kind: type[Any]) -> Mapping[str, Number]:
    """The whole numbers of a class of the model, by the names of their fields."""
    annotations = kind.__annotations__.items()
    return {name: each for name, of in annotations for each in get_args(of) if isinstance(each, Number)}


def require_shape(value: object, kind: Any, path: str = "$") -> None:  # noqa: ANN401 - any type
    """Raise `Refusal` unless the value and all that it holds are of their types; `True` and 1.0 are no whole numbers.

    Lists are no tuples, because what has been looked at must not change.
    """
    kinds, is_tuple, given = _parts(kind)
    is_list = ... in kinds
    if given is not None and isinstance(value, kind):
        for name, of in given.items():
            require_shape(getattr(value, name), of, path + PATHS.get(f"{kind.__name__}.{name}", f".{name}"))
    elif is_list and type(value) is tuple:
        for place, each in enumerate(() if _all_are(kinds[0])(value) else value):
            require_shape(each, kinds[0], f"{path}[{place}]")
    elif is_tuple and type(value) is tuple and len(value) == len(kinds):
        names = ENDS if kinds[:1] * 2 == kinds else [f"[{place}]" for place in range(len(kinds))]
        for each, of, name in zip(value, kinds, names, strict=True):
            require_shape(each, of, path + name)
    elif is_tuple or not (type(value) in kinds or (type(value) is str and value in kinds)):
        right = "a tuple" if is_tuple else " or ".join(_word(each) for each in kinds)
        raise Refusal("document", path, SHAPE, f"it must be {right}, not {shown(value)}")


def require_each(values: object, kind: Any, path: str) -> None:  # noqa: ANN401 - any type
    """Raise `Refusal` unless it is a sequence of values of the type."""
    require_shape(tuple(values) if isinstance(values, Sequence) else values, tuple[kind, ...], path)


def of_shape(path: str) -> Callable[[Callable[[T], None]], Callable[[T], None]]:
    """Make a method of a class raise `Refusal` where it fails because the fields are malformed."""

    def decorate(method: Callable[[T], None]) -> Callable[[T], None]:
        @wraps(method)
        def refusing(self: T) -> None:
            try:
                method(self)
            except (AttributeError, TypeError, ValueError):
                require_shape(self, type(self), path)
                raise

        return refusing

    return decorate


def _word(kind: Any) -> str:  # noqa: ANN401 - a type, or a value of a `Literal`
    return WORDS.get(kind) or (f'"{kind}"' if isinstance(kind, str) else f"of the class {kind.__name__}")


@cache
def _parts(kind: Any) -> tuple[tuple[Any, ...], bool, Mapping[str, Any] | None]:  # noqa: ANN401 - any type
    """The types that a type is made of, whether it is a tuple, and the fields that the maker of a class gives."""
    if get_origin(kind) is Annotated:
        return _parts(get_args(kind)[0])
    given = None
    if is_dataclass(kind) or isinstance(kind, msgspec.StructMeta):
        names = cast("tuple[str, ...]", cast("Any", kind).__match_args__)
        given = {name: kind.__annotations__[name] for name in names}
    return get_args(kind) or (kind,), get_origin(kind) is tuple, given


@cache
def _all_are(kind: Any) -> Callable[[Sequence[Any]], bool]:  # noqa: ANN401 - any type
    """A function that tells whether all values are of the type, as far as that is seen quickly."""
    kinds, is_tuple, given = _parts(kind)
    if is_tuple:
        of_members = [_all_are(each) for each in kinds if each is not ...]

        def are_lists(values: Sequence[Any]) -> bool:
            return {*map(type, values)} <= {tuple} and of_members[0]([each for value in values for each in value])

        def are_tuples(values: Sequence[Any]) -> bool:
            same = {*map(type, values)} <= {tuple} and {*map(len, values)} <= {len(kinds)}
            return same and all(are([value[place] for value in values]) for place, are in enumerate(of_members))

        return are_lists if ... in kinds else are_tuples
    if given is not None:
        fields = [(attrgetter(name), _all_are(of)) for name, of in given.items()]

        def are_of_class(values: Sequence[Any]) -> bool:
            return {*map(type, values)} <= {kind} and all(are([*map(get, values)]) for get, are in fields)

        return are_of_class
    allowed = {*kinds}
    return lambda values: {*map(type, values)} <= allowed
