"""CaDiCaL and Glucose, through python-sat, under a deadline: some conflicts, then a look at the clock.

Glucose is faster where a formula grows and is asked again and again; CaDiCaL writes proofs.
"""

from collections.abc import Callable, Sequence
from itertools import count
from time import monotonic_ns

from carp_verify.optimum.clauses import Formula, Literal

NANOSECONDS = 1_000_000_000
LONGEST = 10**9  # more seconds than anybody waits
CONFLICTS_BETWEEN_LOOKS = 300
PROPAGATIONS_OF_CONFLICT = 650
"""How many propagations take as long as a conflict: about the same on grids of 6 x 6, 8 x 8 and 20 x 20."""


class TimeOver(Exception):  # noqa: N818 - no error: the limit that the user gave
    """The deadline has passed."""


class Deadline:
    """A moment some seconds from now."""

    __slots__ = ("_clock", "_end", "_start")

    def __init__(self, seconds: float, clock: Callable[[], int] = monotonic_ns) -> None:
        """Begin now; `clock` gives nanoseconds."""
        self._clock = clock
        self._start = clock()
        self._end = self._start + int(min(seconds, LONGEST) * NANOSECONDS)

    def check(self, ahead: int = 0) -> None:
        """Raise `TimeOver` if it has passed, or will have in that many nanoseconds."""
        if self._clock() + ahead >= self._end:
            raise TimeOver

    def is_past(self, of: int) -> bool:
        """Whether one of a number of equal parts of the time until it has gone by."""
        return (self._clock() - self._start) * of >= self._end - self._start

    def part(self, of: int) -> "Deadline":
        """A deadline after one of a number of equal parts of the same time, from now."""
        return Deadline((self._end - self._start) / NANOSECONDS / of, self._clock)


LOOKS = 400
"""The seconds after which a search is given up that goes by `clock_of`."""


def clock_of(check: Callable[[], None]) -> Callable[[], int]:
    """A clock that goes a second with each look at it, so the same on every machine; `check` is called at each."""
    looks = count()

    def clock() -> int:
        check()
        return next(looks) * NANOSECONDS

    return clock


class Solver:
    """A solver for a growing formula. Its answers do not depend on the clock.

    `look` is called every few conflicts and may end the search by raising `TimeOver`.
    """

    def __init__(
        self, formula: Formula, look: Callable[[], None], with_proof: bool = False, glucose: bool = False
    ) -> None:
        from pysat.solvers import Cadical195, Glucose4  # noqa: PLC0415 - slow to load

        self.formula = formula
        self.look = look
        self._solver = Glucose4() if glucose else Cadical195(with_proof=with_proof)
        self._sent = 0

    def satisfiable(self, assumptions: Sequence[Literal], conflicts: int | None = None) -> bool | None:
        """Whether the formula has a model in which the assumptions hold; `None` if these conflicts do not decide."""
        for clause in self.formula.clauses[self._sent :]:
            self._solver.add_clause(list(clause))
        self._sent = len(self.formula.clauses)
        answer = None
        spent = 0
        while answer is None and (conflicts is None or spent < conflicts):
            self.look()
            self._solver.conf_budget(CONFLICTS_BETWEEN_LOOKS)
            # An interrupt waits for these conflicts: the solver's own handler would now and then swallow it.
            answer = self._solver.solve_limited(assumptions=list(assumptions), expect_interrupt=True)
            spent += CONFLICTS_BETWEEN_LOOKS
        return answer

    @property
    def conflicts(self) -> int:
        """The conflicts of all searches so far."""
        return int(self._solver.accum_stats()["conflicts"])

    @property
    def work(self) -> int:
        """The work of all searches so far, in propagations: a measure that is the same on every machine."""
        statistics = self._solver.accum_stats()
        return int(statistics["propagations"] + PROPAGATIONS_OF_CONFLICT * statistics["conflicts"])

    def model(self) -> list[bool]:
        """The truth of each variable, from index 1, in the model found last."""
        model = [False, *map((0).__lt__, self._solver.get_model() or [])]
        return model + [False] * (self.formula.variables + 1 - len(model))

    def core(self) -> list[Literal]:
        """Assumptions found last that cannot hold together; none at all if the formula has no model."""
        return list(self._solver.get_core() or [])

    def proof(self) -> list[str]:
        """The lines of a DRUP proof that the formula has no model, of a solver made to keep one."""
        return list(self._solver.get_proof() or [])

    def close(self) -> None:
        """Free the solver."""
        self._solver.delete()
