"""A linear programme that grows by rows and columns, solved by HiGHS: all contact with it.

The simplex method begins where it ended before. It computes in floating point, so what it says is a proposal.
"""

from collections.abc import Callable, Sequence

import highspy
import numpy as np
import numpy.typing as npt

from carp_optimized.jit.kinds import Longs

Floats = npt.NDArray[np.float64]
DUAL_SIMPLEX = 1
ITERATIONS_BETWEEN_LOOKS = 64


class _Quiet(highspy.Highs):
    """HiGHS without the line that it prints as soon as it calls back."""

    def enableCallbacks(self) -> None:  # noqa: N802 - its name there
        self.silent()
        super().enableCallbacks()  # type: ignore[no-untyped-call]


class LinearProgramme:
    """The least cost of shares of columns, each at least 0.

    `shares` and `objective` are those of the last solution, `duals` what a unit more in each row would spare.
    """

    def __init__(self) -> None:
        self._check: Callable[[], None] = lambda: None
        self._failure: Exception | None = None
        self._iterations = 0
        self._highs = _Quiet()  # type: ignore[no-untyped-call]
        for option, value in (("threads", 1), ("simplex_strategy", DUAL_SIMPLEX)):
            self._highs.setOptionValue(option, value)
        self._highs.cbSimplexInterrupt.subscribe(self._look)
        self.rows = 0
        self.shares: Floats = np.zeros(0)
        self.duals: Floats = np.zeros(0)
        self.objective = 0.0

    def _look(self, event: highspy.HighsCallbackEvent) -> None:
        event.interrupt(interrupt_value=False)  # the last interruption is still there
        self._iterations += 1
        if self._iterations % ITERATIONS_BETWEEN_LOOKS != 0:
            return
        try:
            self._check()
        except Exception as failure:  # noqa: BLE001 - it is raised again once HiGHS has stopped
            self._failure = failure
            event.interrupt()

    def add_rows(self, least: float, most: Sequence[float], columns: Sequence[Longs], counts: Sequence[Longs]) -> int:
        """Add rows between the least and these sums, each of columns so many times; the number of the first."""
        first = self.rows
        self.rows += len(most)
        sizes = [each.size for each in columns]
        starts = np.cumsum([0, *sizes])[:-1].astype(np.int32)
        index = np.concatenate([np.zeros(0, np.int64), *columns]).astype(np.int32)
        value = np.concatenate([np.zeros(0, np.int64), *counts]).astype(np.float64)
        lower = np.full(len(most), least)
        upper = np.array(most, np.float64)
        self._highs.addRows(len(most), lower, upper, index.size, starts, index, value)
        return first

    def drop_row(self, row: int) -> None:
        """Let the row allow anything."""
        self._highs.changeRowBounds(row, -highspy.kHighsInf, highspy.kHighsInf)

    def add_column(self, cost: float, rows: Longs, counts: Longs) -> None:
        """Add a column that counts so many times in these rows."""
        values = counts.astype(np.float64)
        self._highs.addCol(cost, 0.0, highspy.kHighsInf, rows.size, rows.astype(np.int32), values)

    def solve(self, check: Callable[[], None]) -> None:
        """Find the least cost; `check` is called now and then, and may raise."""
        self._check = check
        self._highs.run()
        if self._failure is not None:
            failure, self._failure = self._failure, None
            raise failure
        solution = self._highs.getSolution()
        self.shares = np.array(solution.col_value)
        self.duals = -np.array(solution.row_dual)
        self.objective = float(self._highs.getObjectiveValue())
