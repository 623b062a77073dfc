"""A campaign of random small questions to both engines: the reference and the optimised planner must agree on all.

`carproof dev crosscheck` asks the same questions up to the first difference, which it makes smaller. This campaign can
be stopped and continued, and runs on many machines. With stops or groups, searches that count tick by tick are compared
too.
"""

from collections.abc import Mapping
from typing import Any

import msgspec

import carp_optimized
from carp_experiments.measuring.blocks import BlockCase, Questions
from carp_experiments.measuring.crosscheck import Answers, ask, case_of, document
from carp_reference.time_expanded import find_plan_by_ticks
from carp_spec import plan_cost, total_cost
from carproof.testing.random_instances import GROUPED, SMALL, WITH_STOPS, Mix, question

MIXES: Mapping[str | None, Mix] = {None: SMALL, "stops": WITH_STOPS, "groups": GROUPED}


class Block(msgspec.Struct):
    """A row: the cost of all answers, the number of robots without a plan, and the differences."""

    questions: int
    cost: int = 0
    planned: int = 0
    unplanned: int = 0
    differences: list[dict[str, Any]] = msgspec.field(default_factory=list)


def asked(case: BlockCase, kind: str | None = None) -> Block:
    """Ask both engines the questions of a block."""
    block = Block(case.count)
    for number in range(case.first, case.first + case.count):
        ask_both(block, case.seed, number, kind)
    return block


def ask_both(block: Block, seed: int, number: int, kind: str | None = None) -> None:
    """Ask both engines one question; an engine that fails by an exception differs too."""
    from carp_experiments.measuring.by_ticks import faults_by_ticks  # noqa: PLC0415 - loads the planners

    case = case_of(question(seed, number, MIXES[kind]))
    try:
        answers = ask(case)
        faults = [*faults_by_ticks(case.instance, answers.reference.plans)] if kind == "groups" else []
    except Exception as error:  # noqa: BLE001 - whatever it is, it is no answer
        block.differences.append({"number": number, "error": repr(error)})
        return
    block.cost += total_cost(case.instance, answers.reference.plans)
    block.planned += len(answers.reference.plans)
    block.unplanned += len(answers.reference.unplanned)
    block.differences += [{"number": number, "by ticks": fault} for fault in faults]
    if answers.reference != answers.optimized:
        block.differences.append({"number": number, **document(answers)})
    elif kind == "stops":
        by_windows, by_ticks = arrivals(answers)
        if by_windows != by_ticks:
            block.differences.append({"number": number, "windows": by_windows, "ticks": by_ticks, **document(answers)})


def arrivals(answers: Answers) -> tuple[int | None, int | None]:
    """When a robot arrives beside the others of the answer, as the query and a search tick by tick find it."""
    instance, solution = answers.case.instance, answers.reference
    robot = next(iter((*solution.unplanned, *solution.order)))
    others = [plan for plan in solution.plans if plan.robot != robot]
    found = carp_optimized.query(instance, others, robot), find_plan_by_ticks(instance, others, robot)
    by_windows, by_ticks = (None if plan is None else plan_cost(instance, plan) for plan in found)
    return by_windows, by_ticks


CROSSCHECK = Questions(
    "crosscheck",
    "Ask both engines the same random questions on small instances.",
    "questions",
    "Both engines, asked the same",
    asked,
    Block,
    {
        "questions": lambda block: block.questions,
        "robots planned": lambda block: block.planned,
        "robots unplanned": lambda block: block.unplanned,
        "total cost": lambda block: block.cost,
    },
    kinds={
        "stops": "Robots have stops; a search tick by tick is asked too.",
        "groups": "There are groups; searches tick by tick are asked too.",
    },
    of_kernel=False,
)
