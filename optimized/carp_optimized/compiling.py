"""Compilation by numba, typed: the same source runs uncompiled where NUMBA_DISABLE_JIT is 1."""

import sys
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from pathlib import Path
from types import CodeType
from typing import Any, ParamSpec, TypeVar, cast

import numba

from carp_optimized.references import Native

F = TypeVar("F", bound=Callable[..., object])
P = ParamSpec("P")
R = TypeVar("R")

# No compiled function makes an array, so none counts references.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "_nrt": False}


class RoomExhausted(Exception):  # noqa: N818 - nothing went wrong: the caller makes larger arrays and asks again
    """An array of the state is full."""


class TicksExhausted(Exception):  # noqa: N818 - the caller refuses the input
    """A plan would need ticks beyond the largest that the arrays hold."""


def compiled(function: F) -> F:
    """Compile a function that other compiled functions call."""
    return cast("F", numba.njit(**OPTIONS)(function))


def entry(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that Python calls, by position; the machine code is cached on disk, with all that it calls."""
    dispatcher: Any = numba.njit(cache=True, **OPTIONS)(function)
    if not hasattr(dispatcher, "signatures"):  # compilation is switched off
        return function

    is_prepared = False

    @wraps(function)
    def call(*arguments: P.args, **_: P.kwargs) -> R:
        nonlocal is_prepared
        if not is_prepared:
            is_prepared = True
            _prepare_cache(
                dispatcher, function.__code__, f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}"
            )
        return cast("R", dispatcher(*[each.address if isinstance(each, Native) else each for each in arguments]))

    return call


def _prepare_cache(dispatcher: Any, code: CodeType, name: str) -> None:  # noqa: ANN401 - numba is untyped
    """Say so where there is no machine code yet; forget code that is older than any source here or beside the function.

    Numba looks at the source of the function alone, not at those of the functions that it calls.
    """
    folders = {Path(__file__).parent, Path(code.co_filename).parent}
    newest = max(source.stat().st_mtime for folder in folders for source in folder.glob("*.py"))
    cached = list(Path(dispatcher.stats.cache_path).glob(f"{name}-*.nbi"))
    for index in cached:
        if index.stat().st_mtime < newest:
            with suppress(OSError):
                index.unlink()
    if not any(index.is_file() for index in cached):
        print(  # noqa: T201 - the first call takes long, and whoever waits shall know why
            f"carproof compiles {name}, once for this installation ...", file=sys.stderr, flush=True
        )
