"""The search for a case that fails, and for the smallest that fails in the same way.

When a case fails, one thing after the other is taken away (`smaller`), until nothing can be taken away or the time is
over. The first outcome of each case is remembered. So a program that answers the same question differently, or the end
of the time, cannot confuse it.
"""

from collections.abc import Callable, Iterable
from time import monotonic

from carproof.conform.cases import Case
from carproof.conform.findings import Category
from carproof.conform.judging.outcome import Outcome
from carproof.conform.smaller import smallest

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
        self._fails: dict[int, bool] = {}  # by hash, as large cases would fill the memory
        self.best: Outcome | None = None
        self.minimal = False
        self.repeats = True

    def run(self, cases: Iterable[Case]) -> None:
        """Ask the cases up to the first that fails, and shrink it."""
        slowest = 0.0
        for case in cases:
            outcome = self._ask(case, None)
            if outcome.finding is not None:
                self.shrink(outcome, slowest)
                return
            slowest = max(slowest, outcome.seconds)

    def shrink(self, first: Outcome, slowest: float) -> None:
        """Take away from a case that fails what can be taken away, in the time; `slowest` is what answers took."""
        self.best, self._slowest = first, slowest
        self._fails[hash(first.case)] = True
        deadline = monotonic() + self._shrink_seconds
        _, self.minimal = smallest(first.case, self._is_failure, lambda: monotonic() >= deadline)
        self._confirm(first)

    def _is_failure(self, case: Case) -> bool:
        key = hash(case)
        if key not in self._fails and self._may_ask(case):
            self._fails[key] = self._fails_alike(case)
        return self._fails.get(key, False)

    def _fails_alike(self, case: Case) -> bool:
        assert self.best is not None  # noqa: S101 - a promise of ours
        # The time is short for a program that is slow only where it fails.
        outcome = self._ask(case, min(self._limit, max(_LEAST_SECONDS, _PATIENCE * self._slowest)))
        if outcome.finding is None or outcome.finding.key != self.best.fault.key:
            return False
        if case.size <= self.best.case.size:
            self.best = outcome
        return True

    def _confirm(self, first: Outcome) -> None:
        """Ask the smallest case once more, with the full time limit; what took too long must do so again.

        If it does not, the first takes its place, and is asked once more.
        """
        assert self.best is not None  # noqa: S101 - a promise of ours
        again = self._ask(self.best.case, None)
        self.repeats = again.finding is not None and again.finding.key == self.best.fault.key
        self.minimal = self.minimal and self.repeats
        if self.best.fault.category != Category.TIMEOUT:
            return
        if self.repeats:
            self.best = again
        elif self.best is not first:
            self.best = first
            self._confirm(first)
