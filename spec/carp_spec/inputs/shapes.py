"""The types of values: where a value departs from the annotations of its class, at the path of its document."""

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass
from reprlib import repr as shown
from types import NoneType
from typing import Any, get_args, get_origin

from carp_spec.refusal import Refusal

SHAPE = "document/shape"
PATHS = {"resources": ".nodes", "resource": "[0]", "enter": "[1]", "leave": "[2]"}
"""The fields of which the path is not the name."""
ENDS = (".source", ".target")
WORDS = {str: "a string", int: "a whole number", bool: "true or false", tuple: "a tuple", NoneType: "None"}


def require_shape(value: object, kind: Any, path: str = "$") -> None:  # noqa: ANN401 - any type
    """Raise `Refusal` unless the value and all that it holds are of their types; `True` and 1.0 are no whole numbers.

    Lists are no tuples, because what has been looked at must not change.
    """
    kinds = get_args(kind) or (kind,)
    is_list = ... in kinds
    if is_dataclass(kind) and type(value) is kind:
        for name, of in _given(kind).items():
            require_shape(getattr(value, name), of, path + PATHS.get(name, f".{name}"))
    elif get_origin(kind) is tuple and type(value) is tuple and (is_list or len(value) == len(kinds)):
        for place, each in enumerate(() if _are(value, kinds[0]) else value):
            require_shape(each, kinds[0], path + (f"[{place}]" if is_list else ENDS[place]))
    elif get_origin(kind) is tuple or not (type(value) in kinds or (type(value) is str and value in kinds)):
        right = "a tuple" if get_origin(kind) is tuple else " or ".join(_word(each) for each in kinds)
        raise Refusal("document", path, SHAPE, f"it must be {right}, not {shown(value)}")


def _word(kind: Any) -> str:  # noqa: ANN401 - a type, or a value of a `Literal`
    return WORDS.get(kind) or (f'"{kind}"' if isinstance(kind, str) else f"of the class {kind.__name__}")


def _given(kind: Any) -> Mapping[str, Any]:  # noqa: ANN401 - a class
    """The fields of a class that its maker gives, with their types."""
    return {name: kind.__annotations__[name] for name in kind.__match_args__}


def _are(values: Sequence[object], kind: Any) -> bool:  # noqa: ANN401 - any type
    """Whether all values are of the type, as far as that is seen quickly."""
    if is_dataclass(kind):
        same = {*map(type, values)} <= {kind}
        return same and all(_are([getattr(each, name) for each in values], of) for name, of in _given(kind).items())
    return {*map(type, values)} <= {*(get_args(kind) or (kind,))}
