"""Compilation by numba, typed: the same source runs uncompiled where NUMBA_DISABLE_JIT is 1."""

import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache, wraps
from inspect import unwrap
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba

from carp_optimized.references import Native

F = TypeVar("F", bound=Callable[..., object])
P = ParamSpec("P")
R = TypeVar("R")

# No compiled function makes an array, so none counts references.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "_nrt": False}


class RoomExhausted(Exception):  # noqa: N818 - nothing went wrong: the caller makes larger arrays and asks again
    """The places for windows, or the scratch of a query, are full."""


class RecordsExhausted(Exception):  # noqa: N818 - the same
    """The records are full."""


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
            if not is_cached(call):
                _forget(call)
                say_that_it_compiles()
        return cast("R", dispatcher(*[each.address if type(each) is Native else each for each in arguments]))

    call.cache = Path(dispatcher.stats.cache_path)  # type: ignore[attr-defined]
    return call


def is_cached(function: Callable[..., object]) -> bool:
    """Whether an entry's machine code is on disk; its first call compiles it else.

    Code that is older than any source here or beside the function does not count: numba looks at the source of the
    function alone, not at those of the functions that it calls.
    """
    folders = {Path(__file__).parent, Path(unwrap(function).__code__.co_filename).parent}
    newest = max(source.stat().st_mtime for folder in folders for source in folder.glob("*.py"))
    return any(index.stat().st_mtime >= newest for index in _indices(function))


def _indices(function: Callable[..., object]) -> list[Path]:
    """Numba's files about the machine code of an entry; none where compilation is switched off."""
    cache: Path | None = getattr(function, "cache", None)
    name = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}"
    return [] if cache is None else list(cache.glob(f"{name}-*.nbi"))


def _forget(function: Callable[..., object]) -> None:
    """Remove old machine code, which numba would take for current."""
    for index in _indices(function):
        with suppress(OSError):
            index.unlink()


@cache
def say_that_it_compiles() -> None:
    """Tell whoever waits why it takes so long, once."""
    message = "carproof compiles its planner, once: it takes about half a minute ..."
    print(message, file=sys.stderr, flush=True)  # noqa: T201 - no command does this, so none can say it
