"""Blocks of windows compared at once: sets of slots as bits, without a branch that depends on ticks."""

# mypy: disable-error-code="misc, no-untyped-call, untyped-decorator"
# ruff: noqa: ANN401 - numba is untyped

from collections.abc import Callable
from typing import Any, TypeAlias, cast

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

from carp_optimized.jit.kinds import Ints
from carp_optimized.jit.references import WORD, is_uncompiled, place_in

Below: TypeAlias = Callable[[Ints, int, int], int]
OfBits: TypeAlias = Callable[[int], int]

BLOCK = 8
INT = ir.IntType(32)


def _below(numbers: Ints, first: int, limit: int) -> int:
    """Which of the `BLOCK` numbers from the index `first` on are below the limit."""
    return sum(1 << k for k in range(BLOCK) if numbers[first + k] < limit)


def _width(bits: int) -> int:
    """One more than the number of the highest bit; 0 of none."""
    return bits.bit_length()


def _lowest(bits: int) -> int:
    """The number of the lowest bit; there must be one."""
    return (bits & -bits).bit_length() - 1


def _compiled_below(_: Any, numbers: Any, first: Any, limit: Any) -> Any:  # noqa: ARG001 - only types
    def lower(context: Any, builder: Any, signed: Any, arguments: Any) -> Any:
        block = _block(context, builder, signed.args[0], arguments[0], arguments[1])
        return _bits(builder, builder.icmp_signed("<", block, _repeated(builder, arguments[2])))

    return types.int64(numbers, types.int64, types.int64), lower


def _compiled_width(_: Any, bits: Any) -> Any:  # noqa: ARG001
    def lower(_: Any, builder: Any, __: Any, arguments: Any) -> Any:
        return builder.sub(WORD(64), builder.ctlz(arguments[0], ir.IntType(1)(0)))

    return types.int64(types.int64), lower


def _compiled_lowest(_: Any, bits: Any) -> Any:  # noqa: ARG001
    def lower(_: Any, builder: Any, __: Any, arguments: Any) -> Any:
        return builder.cttz(arguments[0], ir.IntType(1)(0))

    return types.int64(types.int64), lower


def _block(context: Any, builder: Any, kind: Any, view: Any, first: Any) -> Any:
    if context.enable_boundscheck:
        place_in(context, builder, kind, view, builder.add(first, WORD(BLOCK - 1)))
    place = place_in(context, builder, kind, view, first)
    return builder.load(builder.bitcast(place, ir.VectorType(INT, BLOCK).as_pointer()), align=4)


def _repeated(builder: Any, number: Any) -> Any:
    vector = ir.Constant(ir.VectorType(INT, BLOCK), [ir.Undefined] * BLOCK)
    for lane in range(BLOCK):
        vector = builder.insert_element(vector, builder.trunc(number, INT), INT(lane))
    return vector


def _bits(builder: Any, truths: Any) -> Any:
    return builder.zext(builder.bitcast(truths, ir.IntType(BLOCK)), WORD)


below: Below = _below if is_uncompiled() else cast("Below", intrinsic(_compiled_below))
width: OfBits = _width if is_uncompiled() else cast("OfBits", intrinsic(_compiled_width))
lowest: OfBits = _lowest if is_uncompiled() else cast("OfBits", intrinsic(_compiled_lowest))
