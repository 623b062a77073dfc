"""CaDiCaL and Glucose, through python-sat, under a deadline: some conflicts, then a look at the clock.

Glucose is faster where a formula grows and is asked again and again; CaDiCaL writes proofs. Glucose counts conflicts
only where it restarts, which may be ten seconds later, so in a long search it has a thread, and the clock is read
meanwhile.
"""

from collections.abc import Callable, Sequence
from queue import Empty, SimpleQueue
from threading import Thread

from carp_verify.optimum.clauses import Formula, Literal

CONFLICTS_BETWEEN_LOOKS = 300
PROPAGATIONS_OF_CONFLICT = 650
"""How many propagations take as long as a conflict: about the same on grids of 6 x 6, 8 x 8 and 20 x 20."""
CONFLICTS_BEFORE_THREAD = 2000
"""Short searches need no thread, which would take half as long again there."""
PATIENCE = 0.1
"""Seconds between two looks at the clock while Glucose works."""


class Solver:
    """A solver for a growing formula. Its answers do not depend on the clock.

    `look` is called every few conflicts and may end the search by raising `TimeOver`; so may `watch`, which is called
    as time goes by, and is `look` where it is not given.
    """

    def __init__(
        self,
        formula: Formula,
        look: Callable[[], None],
        with_proof: bool = False,
        glucose: bool = False,
        watch: Callable[[], None] | None = None,
    ) -> None:
        from pysat.solvers import Cadical195, Glucose4  # noqa: PLC0415 - slow to load

        self.formula = formula
        self.look = look
        self._solver = Glucose4() if glucose else Cadical195(with_proof=with_proof)
        self._sent = 0
        self._watch = watch or look
        self._may_need_thread = glucose
        self._has_thread = False
        self._asked: SimpleQueue[list[Literal] | None] = SimpleQueue()
        self._answers: SimpleQueue[bool | None] = SimpleQueue()

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
            answer = self._answer(list(assumptions))
            spent += CONFLICTS_BETWEEN_LOOKS
        return answer

    def _answer(self, assumptions: list[Literal]) -> bool | None:
        """The solver's answer to some conflicts more."""
        if not self._may_need_thread or self.conflicts < CONFLICTS_BEFORE_THREAD:
            return self._solved(assumptions)
        if not self._has_thread:
            self._has_thread = True
            Thread(target=self._work, daemon=True).start()
        self._asked.put(assumptions)
        while True:
            try:
                return self._answers.get(timeout=PATIENCE)
            except Empty:
                self._watch()

    def _solved(self, assumptions: list[Literal]) -> bool | None:
        # An interrupt waits for these conflicts: the solver's own handler would now and then swallow it.
        answer: bool | None = self._solver.solve_limited(assumptions=assumptions, expect_interrupt=True)
        return answer

    def _work(self) -> None:
        """Answer what is asked until nothing more is, and free the solver."""
        while (assumptions := self._asked.get()) is not None:
            self._answers.put(self._solved(assumptions))
        self._solver.delete()

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
        """Free the solver. One in a thread ends its work first, which nobody need wait for."""
        if self._has_thread:
            self._solver.interrupt()
            self._asked.put(None)
        else:
            self._solver.delete()
