"""A background search, which runs beside another one and decides nothing by the clock.

The search gives its results with the work that it has done, in units that are the same on every machine. The other one
asks for the result after an amount of work, and waits for it if need be. So its answers depend neither on the clock nor
on whether the search has a process of its own: without one it runs where it is asked.
"""

from collections import deque
from collections.abc import Callable, Iterator
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Generic, TypeAlias, TypeVar

from carp_spec import Refusal

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

Result = TypeVar("Result")
Look: TypeAlias = Callable[[], None]
Search: TypeAlias = Callable[[Look], Iterator[tuple[int, Result]]]
"""Gives results with the work up to each, which rises. It ends where a `Refusal` is raised, too."""
PATIENCE = 0.05
"""Seconds between two looks at the clock of one who waits."""


class BackgroundSearch(Generic[Result]):
    """A search and its results so far; `look` is called now and then by one who waits, and may raise an exception.

    With a process of its own, which is spawned, the search must be one that can be pickled.
    """

    def __init__(self, search: Search[Result], look: Look, *, own_process: bool) -> None:
        self._look = look
        self._found: deque[tuple[int, Result | None]] = deque()
        self._result: Result | None = None
        self._work = 0
        self.has_ended = False
        """Whether all results of the search are known."""
        self._process: BaseProcess | None = None
        self._receiver: Connection | None = None
        if own_process:
            spawning = get_context("spawn")
            self._receiver, sender = spawning.Pipe(duplex=False)
            self._process = spawning.Process(target=_run, args=(search, sender), daemon=True)
            self._process.start()
            sender.close()
        else:
            self._steps = _changes(search(look))

    def result(self, work: int) -> Result | None:
        """The last result before the search has done more than this work; `None` if it had none."""
        while self._work <= work and not self.has_ended:
            while self._receiver is not None and not self._receiver.poll(PATIENCE):
                self._look()
            self._take()
        return self._last(work)

    def latest(self) -> Result | None:
        """The last result that is known; which one that is depends on the clock."""
        self.read()
        return self._last(self._work)

    def read(self) -> None:
        """Take in what the search has found; its process waits if this is not called for long."""
        while self._receiver is not None and not self.has_ended and self._receiver.poll():
            self._take()

    def close(self) -> None:
        """End the search."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None
        if self._receiver is not None:
            self._receiver.close()

    def _last(self, work: int) -> Result | None:
        while self._found and self._found[0][0] <= work:
            _, result = self._found.popleft()
            self._result = self._result if result is None else result
        return self._result

    def _take(self) -> None:
        try:
            step = next(self._steps) if self._receiver is None else self._receiver.recv()
        except (EOFError, StopIteration, Refusal):
            self.has_ended = True
            return
        if isinstance(step, Exception):
            raise step
        self._found.append(step)
        self._work = step[0]


def _changes(steps: Iterator[tuple[int, Result]]) -> Iterator[tuple[int, Result | None]]:
    """The steps, with `None` for a result that is the one before."""
    before = None
    for work, result in steps:
        yield work, None if result is before else result
        before = result


def _run(search: Search[Result], sender: Connection) -> None:
    """Send all steps of the search, or the exception that ended it.

    It looks at no clock: one who waits does that, and ends the process.
    """
    try:
        for step in _changes(search(lambda: None)):
            sender.send(step)
    except (Refusal, OSError):
        pass  # it has ended, or nobody listens any more
    except Exception as error:  # noqa: BLE001 - raised where the results are read
        sender.send(error)
