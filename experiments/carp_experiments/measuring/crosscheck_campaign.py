"""A campaign of random small questions to both engines: the reference and the optimised planner must agree on all.

A case is a block of questions, so that a row stands for a second of work. `carproof dev crosscheck` asks the same kind
of questions up to the first difference, which it shrinks. This campaign can be stopped and continued, and runs on many
machines. With stops or groups, searches that count tick by tick are compared too.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import msgspec

import carp_optimized
from carp_experiments.report import ExperimentReport, Table
from carp_experiments.store import Row
from carp_reference.time_expanded import find_plan_by_ticks
from carp_spec import plan_cost, total_cost
from carproof.testing.random_instances import GROUPED, SMALL, WITH_STOPS, question

if TYPE_CHECKING:
    from carp_experiments.measuring.crosscheck import Difference

Kind: TypeAlias = Literal["stops", "groups"]
MIXES = {None: SMALL, "stops": WITH_STOPS, "groups": GROUPED}

BLOCK = 1000
FULL_QUESTIONS = 1_000_000
QUICK_QUESTIONS = 20_000
SHOWN = 3


@dataclass(frozen=True, slots=True)
class CrosscheckCase:
    """The questions of a seed numbered from `first` on."""

    first: int
    questions: int = BLOCK
    seed: int = 0
    kind: Kind | None = None

    @property
    def key(self) -> str:
        """Blocks in their order."""
        numbers = f"{self.first:09} to {self.first + self.questions - 1:09}"
        return f"seed {self.seed}{f' {self.kind}' if self.kind else ''} questions {numbers}"

    def run(self) -> Row:
        """The cost of all answers, the number of unplanned robots, and the questions on which the engines differ."""
        block = Block(self.questions)
        for number in range(self.first, self.first + self.questions):
            ask_both(block, self.seed, number, self.kind)
        return msgspec.to_builtins(block)  # type: ignore[no-any-return] # a struct becomes a dict


class Block(msgspec.Struct):
    """A row of the campaign."""

    questions: int
    cost: int = 0
    planned: int = 0
    unplanned: int = 0
    differences: list[dict[str, Any]] = msgspec.field(default_factory=list)


def ask_both(block: Block, seed: int, number: int, kind: Kind | None = None) -> None:
    """Ask both engines one question; an engine that fails by an exception differs too."""
    from carp_experiments.measuring.by_ticks import faults_by_ticks  # noqa: PLC0415
    from carp_experiments.measuring.crosscheck import ask  # noqa: PLC0415
    from carp_experiments.measuring.crosscheck_command import document  # noqa: PLC0415 - each worker loads it

    asked = question(seed, number, MIXES[kind])
    try:
        answers = ask(asked)
        faults = [*faults_by_ticks(answers.instance, answers.reference.plans)] if kind == "groups" else []
    except Exception as error:  # noqa: BLE001 - whatever it is, it is no answer
        block.differences.append({"number": number, "error": repr(error)})
        return
    block.cost += total_cost(answers.instance, answers.reference.plans)
    block.planned += len(answers.reference.plans)
    block.unplanned += len(answers.reference.unplanned)
    block.differences += [{"number": number, "by ticks": fault} for fault in faults]
    if answers.reference != answers.optimized:
        block.differences.append({"number": number, **document(answers)})
    elif kind == "stops":
        by_windows, by_ticks = arrivals(answers)
        if by_windows != by_ticks:
            block.differences.append({"number": number, "windows": by_windows, "ticks": by_ticks, **document(answers)})


def arrivals(answers: "Difference") -> tuple[int | None, int | None]:
    """When a robot arrives beside the others of the answer, as the query and a search tick by tick find it."""
    instance, solution = answers.instance, answers.reference
    robot = next(iter((*solution.unplanned, *solution.order)))
    others = [plan for plan in solution.plans if plan.robot != robot]
    found = carp_optimized.query(instance, others, robot), find_plan_by_ticks(instance, others, robot)
    by_windows, by_ticks = (None if plan is None else plan_cost(instance, plan) for plan in found)
    return by_windows, by_ticks


def crosscheck_cases(questions: int, seed: int, kind: Kind | None = None) -> tuple[CrosscheckCase, ...]:
    """The questions, in blocks."""
    firsts = range(0, questions, BLOCK)
    return tuple(CrosscheckCase(first, min(BLOCK, questions - first), seed, kind) for first in firsts)


def crosscheck_report(rows: Iterable[Row]) -> ExperimentReport:
    """The number of questions asked, and the differences."""
    blocks = [msgspec.convert(row, Block) for row in rows]
    differences = [each for block in blocks for each in block.differences]
    columns = ("questions", "robots planned", "robots unplanned", "total cost", "differences")
    sums = [sum(getattr(block, name) for block in blocks) for name in ("questions", "planned", "unplanned", "cost")]
    lines = tuple(f"A DIFFERENCE: {msgspec.json.encode(each).decode()}" for each in differences[:SHOWN])
    table = Table(
        "crosscheck", "Both engines, asked the same", columns, ((*map(str, sums), str(len(differences))),), columns
    )
    return ExperimentReport({"differences": differences}, (table,), lines, holds=not differences)
