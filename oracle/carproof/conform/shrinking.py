"""The search for a random case that fails, and for the smallest that fails in the same way.

Hypothesis draws random cases, and shrinks a failing one in half of the time. Then one thing after the other is taken
away (`smaller`), until nothing can be taken away or the time is over. The first outcome of each case is remembered. So
a program that answers the same question differently, or the end of the time, cannot confuse it.
"""

from collections.abc import Callable
from random import Random
from time import monotonic
from typing import TYPE_CHECKING

from carproof.conform.cases import Case
from carproof.conform.findings import Category
from carproof.conform.judging.outcome import Outcome
from carproof.conform.smaller import smallest

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

SHRINK_SECONDS = 15.0
_LEAST_SECONDS = 0.25
_PATIENCE = 20

Ask = Callable[[Case, float | None], Outcome]


class FailureSearch:
    """Looks for a case that fails, and then for smaller ones that fail alike; `best` is the smallest so far.

    It is `minimal` if nothing more can be taken away from it, and it `repeats` if it fails again when it is asked once
    more. `may_ask` is whether a program can be asked a case.
    """

    def __init__(
        self, ask: Ask, limit: float, shrink_seconds: float, may_ask: Callable[[Case], bool] = lambda _: True
    ) -> None:
        self._ask = ask
        self._may_ask = may_ask
        self._limit = limit
        self._shrink_seconds = shrink_seconds
        self._slowest = 0.0
        self._deadline = self._ends = 0.0
        self._fails: dict[int, bool] = {}  # by hash, as large cases would fill the memory
        self._first: Outcome | None = None
        self.best: Outcome | None = None
        self.minimal = False
        self.repeats = True

    def run(self, cases: "SearchStrategy[Case]", examples: int, seed: int) -> None:
        """Draw at most `examples` cases."""
        from hypothesis import Phase, Verbosity, find, settings  # noqa: PLC0415 - loaded only where used
        from hypothesis.errors import NoSuchExample, Unsatisfiable  # noqa: PLC0415

        limits = settings(
            max_examples=examples,
            deadline=None,
            database=None,
            phases=(Phase.generate, Phase.shrink),
            verbosity=Verbosity.quiet,
        )
        try:
            find(cases, self._is_failure, settings=limits, random=Random(seed))  # noqa: S311 - cases, no secrets
        except (NoSuchExample, Unsatisfiable):
            return
        self._shrink()

    def run_on(self, outcome: Outcome) -> None:
        """Shrink a failure that was found otherwise."""
        self._slowest = outcome.seconds
        self._begin(outcome)
        self._shrink()

    def _shrink(self) -> None:
        """Take away what can be taken away, in the time that is left."""
        assert self.best is not None  # noqa: S101 - a promise of ours
        self._ends = self._deadline
        _, ended = smallest(self.best.case, self._is_failure, lambda: monotonic() >= self._deadline)
        self.minimal = ended and monotonic() < self._deadline
        self._confirm()

    def _is_failure(self, case: Case) -> bool:
        if self._first is None:
            outcome = self._ask(case, None)
            if outcome.finding is None:
                self._slowest = max(self._slowest, outcome.seconds)
                return False
            self._begin(outcome)
        key = hash(case)
        if key not in self._fails and monotonic() < self._ends and self._may_ask(case):
            self._fails[key] = self._fails_alike(case)
        return self._fails.get(key, False)

    def _begin(self, outcome: Outcome) -> None:
        self._first = self.best = outcome
        self._fails[hash(outcome.case)] = True
        started = monotonic()
        self._deadline, self._ends = started + self._shrink_seconds, started + self._shrink_seconds / 2

    def _fails_alike(self, case: Case) -> bool:
        assert self._first is not None  # noqa: S101 - a promise of ours
        # The time is short for a program that is slow only where it fails.
        outcome = self._ask(case, min(self._limit, max(_LEAST_SECONDS, _PATIENCE * self._slowest)))
        if outcome.finding is None or outcome.finding.key != self._first.fault.key:
            return False
        if self.best is None or case.size <= self.best.case.size:
            self.best = outcome
        return True

    def _confirm(self) -> None:
        """Ask the smallest case once more, with the full time limit; what took too long must do so again.

        If it does not, the first takes its place, and is asked once more.
        """
        assert self.best is not None and self._first is not None  # noqa: S101, PT018 - promises of ours
        again = self._ask(self.best.case, None)
        self.repeats = again.finding is not None and again.finding.key == self.best.fault.key
        self.minimal = self.minimal and self.repeats
        if self.best.fault.category != Category.TIMEOUT:
            return
        if self.repeats:
            self.best = again
        elif self.best is not self._first:
            self.best = self._first
            self._confirm()
