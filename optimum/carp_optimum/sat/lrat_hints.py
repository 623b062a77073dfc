"""Finds the hints that turn a solver's DRUP proof into LRAT. Not trusted: `carp_verify.optimum.refutation` checks it.

Each clause of the proof is derived by unit propagation, with two watched literals; its hints are the clauses that the
conflict rests on, in the order of propagation. A literal that holds without assumptions gets a clause of its own, so
that hints stay short. In the end only the steps are kept that the empty clause rests on.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence

from carp_verify.optimum.clauses import Clause, Literal
from carp_verify.optimum.refutation import Step

STEPS_BETWEEN_LOOKS = 100


class NoHintsError(ValueError):
    """A step of the proof does not follow by unit propagation."""


def refutation_with_hints(clauses: Sequence[Clause], proof: Iterable[str], look: Callable[[], None]) -> str:
    """The proof, lines of DRUP, as LRAT; `look` is called now and then, and may end the search by an exception.

    Raises `NoHintsError` where a step needs more than unit propagation, or the empty clause is not reached.
    """
    derivation = _Derivation(clauses)
    for number, line in enumerate(proof):
        if derivation.is_complete:
            break
        if number % STEPS_BETWEEN_LOOKS == 0:
            look()
        forgets = line.startswith("d")
        literals = dict.fromkeys(map(int, line.removeprefix("d").split()[:-1]))
        (derivation.forget if forgets else derivation.derive)(tuple(literals))
    if not derivation.is_complete:
        derivation.derive(())
    return "".join(f"{_line(step)}\n" for step in _needed(derivation.steps))


def _line(step: Step) -> str:
    return " ".join(map(str, (step.number, *(step.clause or ()), 0, *step.hints, 0)))


def _needed(steps: Sequence[Step]) -> list[Step]:
    """The steps that the last one rests on."""
    needed = {steps[-1].number}
    kept = []
    for step in reversed(steps):
        if step.number in needed:
            needed.update(step.hints)
            kept.append(step)
    return kept[::-1]


class _Derivation:
    """The clauses so far, what they imply without assumptions, and the steps that were needed for it.

    The first two literals of a clause are watched. A literal that holds has a reason: the number of the clause that
    implies it, or 0 where it is assumed. Without assumptions that clause has the literal alone.
    """

    def __init__(self, clauses: Sequence[Clause]) -> None:
        self.steps: list[Step] = []
        self.is_complete = False
        self._clauses: dict[int, list[Literal]] = {}
        self._numbers: dict[frozenset[Literal], list[int]] = defaultdict(list)
        self._watchers: dict[Literal, list[int]] = defaultdict(list)
        self._reason: dict[Literal, int] = {}
        self._trail: list[Literal] = []
        self._last = len(clauses)
        for number, clause in enumerate(clauses, start=1):
            self._learn(number, tuple(dict.fromkeys(clause)))

    def derive(self, clause: Clause) -> None:
        """Derive a clause by propagation, unless it holds anyway; raises `NoHintsError` if that fails."""
        if any(literal in self._reason for literal in clause):
            return
        mark = len(self._trail)
        for literal in clause:
            if -literal not in self._reason:
                self._assign(-literal, 0)
        conflict = self._propagate(mark)
        if conflict is None:
            raise NoHintsError(f"the clause {clause} does not follow by unit propagation")
        self._learn(self._step(clause, self._hints(clause, conflict, mark)), clause)

    def forget(self, clause: Clause) -> None:
        """Forget a clause; the literals that it implied without assumptions have clauses of their own."""
        numbers = self._numbers.get(frozenset(clause))
        if len(clause) > 1 and numbers:
            del self._clauses[numbers.pop()]

    def _step(self, clause: Clause, hints: Iterable[int]) -> int:
        self._last += 1
        self.steps.append(Step(0, self._last, clause, tuple(hints)))
        self.is_complete |= not clause
        return self._last

    def _learn(self, number: int, clause: Clause) -> None:
        """Watch a clause, and propagate what it implies without assumptions."""
        literals = sorted(clause, key=lambda literal: -literal in self._reason)
        self._clauses[number] = literals
        self._numbers[frozenset(clause)].append(number)
        for literal in literals[:2]:
            self._watchers[literal].append(number)
        if self.is_complete or any(literal in self._reason for literal in literals[:1]):
            return
        mark = len(self._trail)
        conflict: int | None = number
        if literals and -literals[0] not in self._reason:
            if any(-literal not in self._reason for literal in literals[1:2]):
                return
            self._assign(literals[0], number)
            conflict = self._propagate(mark)
        for literal in self._trail[mark:]:
            self._settle(literal)
        if conflict is not None:
            self._step((), self._unit_hints(conflict, 0))

    def _settle(self, literal: Literal) -> None:
        """Derive the clause of one literal, which holds without assumptions, unless there is such a clause."""
        number = self._reason[literal]
        if len(self._clauses[number]) > 1:
            settled = self._step((literal,), self._unit_hints(number, literal))
            self._clauses[settled] = [literal]
            self._reason[literal] = settled

    def _unit_hints(self, number: int, implied: Literal) -> list[int]:
        """The hints with which a clause implies a literal (0: none), all its other literals being known to be false."""
        return [*(self._reason[-each] for each in self._clauses[number] if each != implied), number]

    def _hints(self, clause: Clause, conflict: int, mark: int) -> list[int]:
        """The clauses that a conflict rests on, in the order of propagation; takes assumptions since the mark back.

        No hint repeats that a literal of the clause is false, which is assumed: other checkers refuse such hints.
        """
        false = dict.fromkeys(self._clauses[conflict])
        hints = [conflict]
        while len(self._trail) > mark:
            literal = self._trail.pop()
            number = self._reason.pop(literal)
            if number and -literal in false:
                hints.append(number)
                false.update(dict.fromkeys(each for each in self._clauses[number] if each != literal))
        units = [self._reason[-each] for each in false if -each in self._reason and each not in clause]
        return units + hints[::-1]

    def _assign(self, literal: Literal, reason: int) -> None:
        self._reason[literal] = reason
        self._trail.append(literal)

    def _propagate(self, position: int) -> int | None:
        """Propagate what holds from a place of the trail on; the number of a clause that is false, if there is one."""
        reason = self._reason
        while position < len(self._trail):
            false = -self._trail[position]
            position += 1
            watchers = self._watchers[false]
            kept = self._watchers[false] = []
            for place, number in enumerate(watchers):
                literals = self._clauses.get(number)
                if literals is None:
                    continue
                if literals[0] == false:
                    literals[:2] = literals[1::-1]
                if literals[0] not in reason:
                    other = next((k for k in range(2, len(literals)) if -literals[k] not in reason), None)
                    if other is not None:
                        literals[1], literals[other] = literals[other], literals[1]
                        self._watchers[literals[1]].append(number)
                        continue
                    if len(literals) == 1 or -literals[0] in reason:
                        kept += watchers[place:]
                        return number
                    self._assign(literals[0], number)
                kept.append(number)
        return None
