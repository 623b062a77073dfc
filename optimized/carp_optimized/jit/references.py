"""Named tuples of arrays as compiled functions see them: one address of a table, instead of some hundred arguments.

Numba passes an array as seven words, and a named tuple of sixty arrays as sixty times that: making them from Python's
objects takes longer than a query, and so does compiling functions that hand them on. A `Native` keeps a table of the
addresses and sizes of the arrays, and a compiled function gets the address of the table. `state.windows.start[slot]`
then means what it means in Python, except that no index counts from the end. With NUMBA_BOUNDSCHECK=1 each is checked,
also uncompiled.

No two fields may share an array: the compiled code reads again only what a write to the same field can have changed.
"""

# mypy: disable-error-code="misc, no-untyped-call, untyped-decorator, override"
# ruff: noqa: ANN401, SLF001 - numba is untyped, and made of mixins

import operator
import typing
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, Generic, TypeVar, cast

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel import models
from numba.core.imputils import lower_builtin, lower_getattr_generic
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import intrinsic, register_model

from carp_optimized.jit.kinds import Ints, IntTable, Longs, LongTable, Numbers, ShortTable

F = TypeVar("F", bound=tuple[Any, ...])

WORD = ir.IntType(64)
ARRAYS: dict[object, tuple[type[np.generic], int]] = {
    Ints: (np.int32, 1),
    Longs: (np.int64, 1),
    Numbers: (np.uint64, 1),
    IntTable: (np.int32, 2),
    ShortTable: (np.int16, 2),
    LongTable: (np.int64, 2),
}


class _Checked(np.ndarray[Any, Any]):
    """An array in which no index counts from the end."""

    def __getitem__(self, index: Any) -> Any:
        return super().__getitem__(_not_from_the_end(index))

    def __setitem__(self, index: Any, value: Any) -> None:
        super().__setitem__(_not_from_the_end(index), value)


def _not_from_the_end(index: Any) -> Any:
    if isinstance(index, int | np.integer) and index < 0:
        raise IndexError(f"the index {index} counts from the end")
    return index


def _checked(fields: Any) -> Any:
    """The named tuple with such arrays."""
    if isinstance(fields, tuple):
        return fields._make(map(_checked, fields))  # type: ignore[attr-defined]
    return fields.view(_Checked) if isinstance(fields, np.ndarray) else fields


def is_uncompiled() -> bool:
    """Whether compilation is switched off."""
    return bool(numba.config.DISABLE_JIT)  # type: ignore[attr-defined]


class Native(Generic[F]):
    """A named tuple of arrays, ints and named tuples, with the table of where compiled functions find them.

    The arrays must live as long as the table is used; ints are those of the time at which it was made.
    """

    __slots__ = ("address", "fields", "table")

    def __init__(self, fields: F) -> None:
        """Raises `TypeError` for an array that is not as its field says, or is that of two: numba would not notice."""
        self.fields = fields
        self.table = np.array([*_words(fields, {})], np.int64)
        self.address = self.table.ctypes.data


def _words(fields: tuple[Any, ...], known: dict[int, str]) -> Iterator[int]:
    """The words of the table; `known` are the fields by the addresses of their arrays."""
    for (name, array), value in zip(_arrays(type(fields)), fields, strict=True):
        if array is not None:
            dtype, dimensions = array
            field = f"{type(fields).__qualname__}.{name}"
            if value.dtype != dtype or value.ndim != dimensions or not value.flags.c_contiguous:
                raise TypeError(f"{field} is an array of another kind")
            if value.size > 0 and known.setdefault(value.ctypes.data, field) != field:
                raise TypeError(f"{field} is also the array of {known[value.ctypes.data]}")
            yield value.ctypes.data
            yield from value.shape
        elif isinstance(value, tuple):
            yield from _words(value, known)
        else:
            yield int(value)


@cache
def _hints(kind: type) -> tuple[tuple[str, Any], ...]:
    hints = typing.get_type_hints(kind, include_extras=True)
    return tuple((name, hints[name]) for name in kind._fields)  # type: ignore[attr-defined]


@cache
def _arrays(kind: type) -> tuple[tuple[str, tuple[type[np.generic], int] | None], ...]:
    """The fields, with the kinds of those that are arrays."""
    return tuple((name, ARRAYS.get(hint)) for name, hint in _hints(kind))


class View(types.Type):
    """An array of a field, known by its address and its sizes alone."""

    def __init__(self, dtype: types.Type, dimensions: int, field: str) -> None:
        self.dtype = dtype
        self.dimensions = dimensions
        self.field = field
        super().__init__(name=f"View({dtype}, {dimensions}, {field})")

    @property
    def item(self) -> types.Type:
        """The value at an index: a row, or a number with as many bits as sums have."""
        if self.dimensions > 1:
            return View(self.dtype, self.dimensions - 1, self.field)
        return types.uint64 if self.dtype == types.uint64 else types.int64

    @property
    def words(self) -> int:
        """The number of words that it takes in the table."""
        return 1 + self.dimensions


@register_model(View)
class _ViewModel(models.StructModel):
    def __init__(self, manager: Any, kind: View) -> None:
        sizes = [(f"size{axis}", types.intp) for axis in range(kind.dimensions)]
        super().__init__(manager, kind, [("data", types.CPointer(kind.dtype)), *sizes])


class Reference(types.Type):
    """The address of the table of a named tuple; `fields` gives for each name its type and its first word."""

    def __init__(self, kind: type) -> None:
        self.fields: dict[str, tuple[types.Type, int]] = {}
        self.words = 0
        for name, hint in _hints(kind):
            field: types.Type = types.boolean if hint is bool else types.int64
            if hint in ARRAYS:
                dtype, dimensions = ARRAYS[hint]
                field = View(numba.from_dtype(np.dtype(dtype)), dimensions, f"{kind.__qualname__}.{name}")
            elif hint not in {bool, int}:
                field = Reference(hint)
            self.fields[name] = field, self.words
            self.words += getattr(field, "words", 1)
        super().__init__(name=f"Reference({kind.__module__}.{kind.__qualname__})")


@register_model(Reference)
class _ReferenceModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Reference) -> None:
        super().__init__(manager, kind, WORD.as_pointer())


def dereference(kind: type[F]) -> Callable[[Native[F]], F]:
    """The conversion of a `Native` handed to a compiled function into the named tuple."""
    reference = Reference(kind)

    def lower(context: Any, builder: Any, _: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(reference))

    def at(_: Any, address: Any) -> Any:
        return reference(address), lower

    if is_uncompiled():
        is_checked = bool(numba.config.BOUNDSCHECK)  # type: ignore[attr-defined]
        return lambda native: cast("F", _checked(native.fields)) if is_checked else native.fields
    return cast("Callable[[Native[F]], F]", intrinsic(at))


def _word(builder: Any, table: Any, number: int) -> Any:
    """Read a word of a table; none changes while a compiled function is at work, so each is read but once."""
    word = builder.load(builder.gep(table, [WORD(number)]))
    word.set_metadata("invariant.load", builder.module.add_metadata([]))
    return word


@infer_getattr
class _ReferenceAttributes(AttributeTemplate):
    key = Reference

    def generic_resolve(self, reference: Any, name: str) -> Any:
        return reference.fields[name][0] if name in reference.fields else None


@lower_getattr_generic(Reference)
def _lower_field(context: Any, builder: Any, reference: Reference, table: Any, name: str) -> Any:
    field, first = reference.fields[name]
    if isinstance(field, Reference):
        return builder.gep(table, [WORD(first)])
    if isinstance(field, View):
        view = cgutils.create_struct_proxy(field)(context, builder)
        view.data = builder.inttoptr(_word(builder, table, first), context.get_data_type(field.dtype).as_pointer())
        for axis in range(field.dimensions):
            setattr(view, f"size{axis}", _word(builder, table, first + 1 + axis))
        return view._getvalue()
    value = _word(builder, table, first)
    return context.cast(builder, value, types.int64, field)


@infer_getattr
class _ViewAttributes(AttributeTemplate):
    key = View

    def resolve_size(self, view: View) -> types.Type | None:
        return types.intp if view.dimensions == 1 else None


@lower_getattr_generic(View)
def _lower_size(context: Any, builder: Any, kind: View, value: Any, _: str) -> Any:
    return cgutils.create_struct_proxy(kind)(context, builder, value).size0


@infer_global(operator.getitem)
class _ReadItem(AbstractTemplate):
    def generic(self, arguments: Any, keywords: Any) -> Any:
        view, index = arguments
        if not keywords and isinstance(view, View) and isinstance(index, types.Integer):
            return signature(view.item, view, types.intp)
        return None


@infer_global(operator.setitem)
class _WriteItem(AbstractTemplate):
    def generic(self, arguments: Any, keywords: Any) -> Any:
        view, index, _ = arguments
        if not keywords and isinstance(view, View) and view.dimensions == 1 and isinstance(index, types.Integer):
            return signature(types.none, view, types.intp, view.item)
        return None


def place_in(context: Any, builder: Any, kind: View, value: Any, index: Any) -> Any:
    """The address of the value at the index."""
    view = cgutils.create_struct_proxy(kind)(context, builder, value)
    if context.enable_boundscheck:
        with builder.if_then(builder.icmp_unsigned(">=", index, view.size0), likely=False):
            context.call_conv.return_user_exc(builder, IndexError, ("index is out of bounds",))
    for axis in range(1, kind.dimensions):
        index = builder.mul(index, getattr(view, f"size{axis}"))
    return builder.gep(view.data, [index])


def _of_field(builder: Any, kind: View, access: Any) -> Any:
    """The access, marked as one to an array of that field, which no write to an array of another field changes."""
    add = builder.module.add_metadata
    field = add([kind.field, add(["field"]), WORD(0)])
    access.set_metadata("tbaa", add([field, field, WORD(0)]))
    return access


@lower_builtin(operator.getitem, View, types.intp)
def _lower_read(context: Any, builder: Any, signed: Any, arguments: Any) -> Any:
    kind = signed.args[0]
    place = place_in(context, builder, kind, arguments[0], arguments[1])
    if kind.dimensions == 1:
        number = _of_field(builder, kind, builder.load(place))
        return context.cast(builder, number, kind.dtype, kind.item)
    view = cgutils.create_struct_proxy(kind)(context, builder, arguments[0])
    row = cgutils.create_struct_proxy(kind.item)(context, builder)
    row.data = place
    for axis in range(1, kind.dimensions):
        setattr(row, f"size{axis - 1}", getattr(view, f"size{axis}"))
    return row._getvalue()


@lower_builtin(operator.setitem, View, types.intp, types.Any)
def _lower_write(context: Any, builder: Any, signed: Any, arguments: Any) -> Any:
    kind = signed.args[0]
    place = place_in(context, builder, kind, arguments[0], arguments[1])
    _of_field(builder, kind, builder.store(context.cast(builder, arguments[2], kind.item, kind.dtype), place))
    return context.get_dummy_value()
