"""Clauses and the numbers written in them: literals as DIMACS has them, and sums of unary numbers.

A unary number is a list of literals, and the k-th (from 1) means that the number is at least k.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

from carp_verify.optimum.rules import LARGEST_FORMULA, refuse_size

Literal: TypeAlias = int
Clause: TypeAlias = tuple[Literal, ...]
Unary: TypeAlias = Sequence[Literal]


class Formula:
    """Clauses over the variables 1 .. `variables`, in the order in which they were added; at most `most` of them."""

    __slots__ = ("clauses", "most", "variables")

    def __init__(self, most: int = LARGEST_FORMULA) -> None:
        self.most = most
        self.variables = 0
        self.clauses: list[Clause] = []

    def variable(self) -> Literal:
        """A new variable."""
        self.variables += 1
        return self.variables

    def add(self, *literals: Literal) -> None:
        """Demand that one of the literals holds; raises `Refusal` if the formula gets too large."""
        self.clauses.append(literals)
        if len(self.clauses) > self.most:
            self.require(len(self.clauses))

    def require(self, size: int) -> None:
        """Raise `Refusal` if this many clauses are too many."""
        refuse_size("the clauses of the formula", size, self.most)

    def at_least(self, addends: Sequence[Unary], most: int) -> Unary:
        """A unary number of up to `most` that is at least the sum of the addends, or at least `most`.

        The addends are summed in pairs, neighbours first, so addends that belong together should be neighbours.
        """
        numbers = [addend[:most] for addend in addends if addend]
        while len(numbers) > 1:
            halves = zip(numbers[::2], numbers[1::2], strict=False)
            odd = numbers[-1:] if len(numbers) % 2 else []
            numbers = [self._sum(left, right, most) for left, right in halves] + odd
        return numbers[0] if numbers else ()

    def _sum(self, left: Unary, right: Unary, most: int) -> Unary:
        self.require(len(self.clauses) + len(left) * len(right))
        total = [self.variable() for _ in range(min(len(left) + len(right), most))]
        for smaller, larger in pairwise(total):
            self.add(-larger, smaller)
        for i in range(len(left) + 1):
            for j in range(len(right) + 1):
                if i + j > 0:
                    premises = [-left[i - 1]] * (i > 0) + [-right[j - 1]] * (j > 0)
                    self.add(*premises, total[min(i + j, most) - 1])
        return total

    def at_most(self, literals: Sequence[Literal], most: int) -> None:
        """Demand that no more than `most` of the literals hold: by pairs, or by a sum."""
        if most == 1:
            for position, literal in enumerate(literals):
                for other in literals[:position]:
                    self.add(-other, -literal)
        elif len(literals) > most:
            self.add(-self.at_least([[literal] for literal in literals], most + 1)[most])


def dimacs(formula: Formula) -> str:
    """The formula as a DIMACS file."""
    lines = [f"p cnf {formula.variables} {len(formula.clauses)}"]
    lines += [" ".join(map(str, (*clause, 0))) for clause in formula.clauses]
    return "\n".join(lines) + "\n"
