"""The output of commands: documents for programs, tables for people."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from carp_spec import Instance, Plan, RobotId, Solution, Violation, total_cost
from carp_spec.check import MOST_LISTED
from carp_spec.documents.instances import write_instance
from carp_spec.rule import interval
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output
from carproof.command_line.tables import print_line, print_table, say
from carproof.engines import have_plans_beside, sum_of_shortest_paths
from carproof.judging.unplanned import why_unplanned

if TYPE_CHECKING:
    from carp_optimized.fleet import PlannedFleet
    from carp_optimized.improve.planning import Found

COLUMNS = ("planner", "robots", "unplanned", "total cost", "shortest paths", "ratio", "time")
NOT_FOUND = "the planner found no plan for it, though there is one beside the plans of the others"


def show_instance(instance: Instance, output: Output) -> Answer:
    """Write an instance to the file, or print its document; tell people what was written."""
    if replace(output, as_json=output.as_json or output.file is None).write(write_instance(instance)):
        columns = ["written", "resources", "edges", "robots", "after goal"]
        row = [output.file, len(instance.graph.resources), len(instance.graph.edges), len(instance.robots)]
        print_table(columns, [[*row, instance.after_goal]], numbers=columns[1:4])
    return Answer.YES


def show_solution(
    instance: Instance, solution: Solution, planner: str, seconds: float, fleet: "PlannedFleet | None"
) -> None:
    """Print a table of the result, and the reasons why robots are unplanned; a fleet holds the plans."""
    shortest = sum_of_shortest_paths(instance, (plan.robot for plan in solution.plans), fleet)
    _show_row(instance, solution, planner, shortest, seconds)
    show_unplanned(instance, solution, solution.unplanned, fleet=fleet)


def show_found(instance: Instance, found: "Found", planner: str, seconds: float) -> None:
    """Print what was found within a time."""
    _show_row(instance, found.solution, planner, found.shortest, seconds)
    show_not_found(found.solution.unplanned)


def show_not_found(unplanned: Sequence[RobotId]) -> None:
    """Print the robots that a search within a time or a number of rounds leaves out; nobody asks why."""
    for robot in unplanned[:MOST_LISTED]:
        print_line(f"unplanned: robot {robot}: no plan was found for it")
    if len(unplanned) > MOST_LISTED:
        print_line(f"unplanned: and {len(unplanned) - MOST_LISTED} more")


def _show_row(instance: Instance, solution: Solution, planner: str, shortest: int | None, seconds: float) -> None:
    total = total_cost(instance, solution.plans)
    ratio = f"{total / shortest:.4f}" if shortest else "-"
    row = [planner, len(instance.robots), len(solution.unplanned), total, "-" if shortest is None else shortest, ratio]
    print_table(COLUMNS, [[*row, f"{seconds:.2f} s"]], numbers=COLUMNS[1:])


def show_unplanned(
    instance: Instance,
    solution: Solution,
    robots: Sequence[RobotId],
    now: int = 0,
    fleet: "PlannedFleet | None" = None,
) -> None:
    """Print the reasons why robots have no plan, one a line; a fleet, if one is given, holds the plans."""
    if not robots:
        return
    plannable = have_plans_beside(instance, solution.plans, robots, now, fleet)
    for robot, is_plannable in zip(robots, plannable, strict=True):
        reason = NOT_FOUND if is_plannable else why_unplanned(instance, solution.plans, robot, now)
        print_line(f"unplanned: robot {robot}: {reason}")


def show_addition(instance: Instance, before: Solution, after: Solution, robot: RobotId, now: int) -> None:
    """Print the result for a robot that was to be added, and for the others."""
    plans = {plan.robot: plan for plan in after.plans}
    if robot not in plans:
        show_unplanned(instance, after, [robot], now)
        return
    changed = [str(plan.robot) for plan in before.plans if plan.robot != robot and plans[plan.robot] != plan]
    print_line(f"robot {robot} arrives at tick {plans[robot].visits[-1].enter}")
    print_line(f"plans of other robots that changed: {', '.join(changed) or 'none'}")
    print_line(f"total cost {total_cost(instance, before.plans)} before, {total_cost(instance, after.plans)} now")


def show_violations(violations: Sequence[Violation], most: int | None) -> None:
    """Print the violations one a line, then how many there are of each rule; `most` of a rule may stand for more."""
    for violation in violations:
        print_line(str(violation))
    count = Counter(violation.rule for violation in violations)
    if count:
        rows = [(rule, f"{number} or more" if number == most else number) for rule, number in count.items()]
        say()
        print_table(["rule", "violations"], rows, numbers=["violations"])
        say()


def shown_plan(plan: Plan) -> str:
    """A plan in one line."""
    return " ".join(f"{visit.resource}{interval(visit.enter, visit.leave)}" for visit in plan.visits)
