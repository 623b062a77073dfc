"""Questions of the paper's size, and digests of the reference's answers; `make paper-sized` makes them again.

The reference takes from a second to minutes for an answer, so the gate compares the optimised planner with the
digests, in paper_sized.txt beside this file.
"""

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from time import process_time
from typing import Literal

import carp_optimized
import carp_reference
from carproof import Instance, Neighbourhood, Solution, write_solution
from carproof.generate import Fleet, Grid, grid_instance

DIGESTS = Path(__file__).with_suffix(".txt")
ROBOTS = 100
MAPS = (5, 10, 20)
FOUR = (Neighbourhood(m=4), Neighbourhood(m=4, baseline=False))
TEN = (Neighbourhood(m=10, sample=150, seed=7), Neighbourhood(m=10, sample=150, seed=7, baseline=False))
Plan = Callable[[Instance, Neighbourhood], Solution]
Add = Callable[[Instance, Solution, str, int, Neighbourhood], Solution]


@dataclass(frozen=True, slots=True)
class Question:
    """Plan all robots of an assignment on one of the paper's maps, or add the last one to plans of the others."""

    op: Literal["plan", "add"]
    map: int
    assignment: int
    options: Neighbourhood

    def __str__(self) -> str:
        """Print like `add, map 10, assignment 3, m 4, all orders, paper mode`."""
        orders = "all orders" if self.options.sample is None else f"{self.options.sample} orders"
        mode = "with baseline" if self.options.baseline else "paper mode"
        return f"{self.op}, map {self.map}, assignment {self.assignment}, m {self.options.m}, {orders}, {mode}"

    @property
    def instance(self) -> Instance:
        """The paper's 20 x 20 map, with robots of the assignment's seed."""
        return grid_instance(Grid(map=self.map), Fleet(ROBOTS, self.assignment))

    @property
    def before(self) -> Solution:
        """Plans of all robots but the last."""
        whole = self.instance
        others = Instance(whole.graph, whole.robots[:-1], whole.after_goal)
        return carp_optimized.plan(others, Neighbourhood(m=2))

    def answer(self, plan: Plan, add: Add) -> str:
        """The digest of what an engine answers."""
        whole = self.instance
        if self.op == "plan":
            solution = plan(whole, self.options)
        else:
            solution = add(whole, self.before, str(whole.robots[-1].id), 0, self.options)
        return sha256(write_solution(solution)).hexdigest()[:16]


def questions() -> Iterator[Question]:
    """All of them, the quick ones first."""
    for map in MAPS:
        for assignment in range(8):
            yield from (Question("add", map, assignment, options) for options in FOUR)
    for map in MAPS:
        yield from (Question("add", map, 0, options) for options in TEN)
    for map in MAPS:
        yield from (Question("plan", map, 0, options) for options in FOUR)


def read_digests() -> dict[str, str]:
    """The digest of the reference's answer to each question."""
    lines = DIGESTS.read_text(encoding="utf-8").splitlines()
    return {question: digest for digest, _, question in (line.partition("  ") for line in lines)}


def main() -> int:
    """Ask the reference, write its digests, and tell where the optimised planner differs."""
    count = different = 0
    DIGESTS.write_text("", encoding="utf-8")
    for question in questions():
        started = process_time()
        digest = question.answer(carp_reference.plan, carp_reference.add)
        seconds = process_time() - started
        same = digest == question.answer(carp_optimized.plan, carp_optimized.add)
        count += 1
        different += not same
        with DIGESTS.open("a", encoding="utf-8") as file:
            file.write(f"{digest}  {question}\n")
        print(f"{question}: {'the same' if same else 'A DIFFERENCE'} ({seconds:.1f} s)", flush=True)  # noqa: T201
    print(f"{count} questions, {different} differences")  # noqa: T201
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
