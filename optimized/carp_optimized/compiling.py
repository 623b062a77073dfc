"""Compilation by numba, typed: the same source runs uncompiled where NUMBA_DISABLE_JIT is 1."""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache, wraps
from inspect import unwrap
from pathlib import Path
from stat import S_ISDIR
from tempfile import gettempdir
from typing import Any, ParamSpec, TypeVar, cast

import numba

from carp_optimized.references import Native

F = TypeVar("F", bound=Callable[..., object])
P = ParamSpec("P")
R = TypeVar("R")

# No compiled function makes an array, so none counts references.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "_nrt": False}
INNER: dict[str, Any] = {**OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_ENTRIES: list[Callable[..., object]] = []
"""The entries of the modules that are loaded."""


class RoomExhausted(Exception):  # noqa: N818 - nothing went wrong: the caller makes larger arrays and asks again
    """The places for windows, or the scratch of a query, are full."""


class RecordsExhausted(Exception):  # noqa: N818 - the same
    """The records are full."""


class TicksExhausted(Exception):  # noqa: N818 - the caller refuses the input
    """A plan would need ticks beyond the largest that the arrays hold."""


def compiled(function: F) -> F:
    """Compile a function that other compiled functions call, once for all whole numbers, whatever their types there."""
    return cast("F", _with_whole_numbers(numba.njit(**INNER)(function)))


def inlined(function: F) -> F:
    """The same for a function called often, and in few places: it becomes a part of those that call it."""
    return cast("F", _with_whole_numbers(numba.njit(forceinline=True, **INNER)(function)))


def _with_whole_numbers(dispatcher: Any) -> Any:  # noqa: ANN401 - numba is untyped
    """The dispatcher, made to take any whole number for one of 64 bits."""
    if hasattr(dispatcher, "get_call_template"):  # compilation is switched on
        template = dispatcher.get_call_template
        dispatcher.get_call_template = lambda types, names: template([_widest(each) for each in types], names)
    return dispatcher


def _widest(type: Any) -> Any:  # noqa: ANN401 - numba is untyped
    """The type of 64 bits in place of a constant's or a shorter number's, which numba compiles apart."""
    plain = numba.types.unliteral(type)  # type: ignore[no-untyped-call]
    return numba.types.int64 if plain in numba.types.signed_domain else plain


def entry(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that Python calls, by position; the machine code is cached on disk, with all that it calls."""
    dispatcher = _dispatcher(function)
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
                say_that_it_compiles(call.cache is not None)  # type: ignore[attr-defined]
        return cast("R", dispatcher(*[each.address if type(each) is Native else each for each in arguments]))

    kept_in = dispatcher.stats.cache_path
    call.cache = None if kept_in is None else Path(kept_in)  # type: ignore[attr-defined]
    _ENTRIES.append(call)
    return call


def _dispatcher(function: Callable[P, R]) -> Any:  # noqa: ANN401 - numba is untyped
    """The function, to be compiled; numba keeps its machine code where it can, else among the temporary files."""
    with suppress(RuntimeError):  # neither the sources' folder nor the user's can be written
        return numba.njit(cache=True, **OPTIONS)(function)
    if (folder := _temporary_cache()) is not None:
        os.environ["NUMBA_CACHE_DIR"] = str(folder)
        numba.config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]
        with suppress(RuntimeError):
            return numba.njit(cache=True, **OPTIONS)(function)
    return numba.njit(**OPTIONS)(function)


@cache
def _temporary_cache() -> Path | None:
    """A folder that the user alone can write, as machine code from it is run; `None` if there can be none."""
    try:
        folder = Path(gettempdir()) / f"carproof-{os.getuid()}"
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    is_own = S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077
    return folder if is_own else None


def is_compiled() -> bool:
    """Whether the machine code of all entries that are loaded is on disk."""
    return all(map(is_cached, _ENTRIES))


def is_cached(function: Callable[..., object]) -> bool:
    """Whether an entry's machine code is on disk; otherwise its first call compiles it.

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
def say_that_it_compiles(is_kept: bool) -> None:
    """Announce the compilation once on standard error, with its time and whether it will happen again."""
    how_often = "once" if is_kept else "in each process, as it finds no folder in which to keep that"
    message = f"carproof compiles its planner, {how_often}: it takes about a minute ..."
    with suppress(OSError):
        print(message, file=sys.stderr, flush=True)  # noqa: T201 - no command does this, so none can say it
