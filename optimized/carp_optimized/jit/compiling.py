"""Compilation by numba, typed: the same source runs uncompiled where NUMBA_DISABLE_JIT is 1."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, wraps
from hashlib import sha256
from importlib.util import find_spec
from inspect import unwrap
from pathlib import Path
from stat import S_ISDIR
from tempfile import gettempdir
from typing import Any, ParamSpec, TypeVar, cast

import numba
from numba.core import event
from numba.core.registry import cpu_target

from carp_optimized.jit.references import Native

F = TypeVar("F", bound=Callable[..., object])
P = ParamSpec("P")
R = TypeVar("R")

# No compiled function makes an array, so none counts references.
OPTIONS: dict[str, Any] = {"error_model": "numpy", "_nrt": False}
INNER: dict[str, Any] = {**OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_FUNCTIONS: list[Callable[..., object]] = []
"""The functions to compile of the modules that are loaded."""


class RoomExhausted(Exception):  # noqa: N818 - nothing went wrong: the caller makes larger arrays and asks again
    """The places for windows, or the scratch of a query, are full."""


class RecordsExhausted(Exception):  # noqa: N818 - the same
    """The records are full."""


class TicksExhausted(Exception):  # noqa: N818 - the caller refuses the input
    """A plan would need ticks beyond the largest that the arrays hold."""


def compiled(function: F) -> F:
    """Compile a function that other compiled functions call, once for all whole numbers, whatever their types there."""
    _FUNCTIONS.append(function)
    return cast("F", _with_whole_numbers(numba.njit(**INNER)(function)))


def inlined(function: F) -> F:
    """The same for a function called often, and in few places: it becomes a part of those that call it."""
    _FUNCTIONS.append(function)
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
    _FUNCTIONS.append(function)
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


def is_compiled(package: str) -> bool:
    """Whether all that a package calls was compiled on such a machine, from these sources, and the code is kept."""
    if numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        return True
    record = _record(package)
    newest = _newest(_folder("carp_optimized"), _folder(package))
    return record is not None and record.exists() and record.stat().st_mtime >= newest


def note_that_it_is_compiled(package: str) -> None:
    """Note this beside the machine code, if that is kept."""
    record = _record(package)
    if record is not None:
        with suppress(OSError):
            record.parent.mkdir(parents=True, exist_ok=True)
            record.touch()


def is_kept() -> bool:
    """Whether there is machine code, and a folder in which to keep it."""
    return _record("carp_optimized") is not None


@cache
def _record(package: str) -> Path | None:
    """The file that is as old as the machine code of a package for this processor, numba and Python."""
    kept_in = getattr(getattr(_dispatcher(_folder), "stats", None), "cache_path", None)
    machine = (package, numba.__version__, sys.version, *cpu_target.target_context.codegen().magic_tuple())
    return None if kept_in is None else Path(kept_in) / f"compiled-{sha256(repr(machine).encode()).hexdigest()[:16]}"


def _folder(package: str) -> Path:
    found = find_spec(package)
    assert found is not None  # noqa: S101 - one of ours
    assert found.origin is not None  # noqa: S101 - which has an `__init__`
    return Path(found.origin).parent


@contextmanager
def watched(advance: Callable[[], None]) -> Iterator[None]:
    """Call a function each time that a function of ours has been compiled; there are `to_compile()`."""

    class Listener(event.Listener):
        def on_start(self, event: Any) -> None:  # noqa: ANN401 - numba is untyped
            """Wait for the end."""

        def on_end(self, event: Any) -> None:  # noqa: ANN401 - numba is untyped
            if event.data["dispatcher"].py_func in _FUNCTIONS:
                advance()

    with event.install_listener("numba:compile", Listener()):
        yield


def to_compile() -> int:
    """How many functions there are to compile in the modules that are loaded."""
    return len(_FUNCTIONS)


def is_cached(function: Callable[..., object]) -> bool:
    """Whether an entry's machine code is on disk; otherwise its first call compiles it.

    Code that is older than any source of this package or the function's does not count: numba looks at the source of
    the function alone, not at those of the functions that it calls.
    """
    newest = _newest(_package(Path(__file__)), _package(Path(unwrap(function).__code__.co_filename)))
    return any(index.stat().st_mtime >= newest for index in _indices(function))


def _newest(*packages: Path) -> float:
    """When the newest source of packages was changed, in any of their folders."""
    return max(source.stat().st_mtime for package in {*packages} for source in package.rglob("*.py"))


def _package(source: Path) -> Path:
    """The folder of the whole package to which a source belongs."""
    return ([folder for folder in source.parents if (folder / "__init__.py").is_file()] or [source.parent])[-1]


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
