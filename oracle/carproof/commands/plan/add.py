"""`carproof add`: add one robot to given plans, by the neighbourhood planner."""

from carp_spec import Neighbourhood
from carp_spec.documents.solutions import write_solution
from carp_spec.requests import require_new_robot
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output
from carproof.command_line.options import Asked, asks_for_a_robot, gives_plans, listed, neighbourhood_options
from carproof.command_line.output import show_addition
from carproof.engines import engine_named


@listed(
    "Add one robot to given plans.",
    """echo '{"format": "carproof-solution/1", "plans": [], "order": [],""",
    """  "unplanned": []}' > nobody.json""",
    "carproof add town.json nobody.json r1 -o plans.json",
    "carproof add town.json plans.json r2 --now 2 --m 5",
)
@asks_for_a_robot
@neighbourhood_options
@gives_plans
def command(*, asked: Asked, planner: Neighbourhood, engine: str | None, output: Output) -> Answer:
    """Add ROBOT, which INSTANCE has, to the plans of SOLUTION, by the neighbourhood planner.

    Robots near it may get new plans, but keep the visits that they have made by --now. A robot that SOLUTION does not
    name counts as unplanned.

    Exit codes: 0 the robot has a plan, 1 it has none and all plans stay as they were, 2 bad input.
    """
    problem, before, id = asked.read()
    require_new_robot(problem, before, id, "ROBOT")
    with asked.naming():
        after = engine_named(engine).add(problem, before, id, asked.now, planner)
    if output.write(write_solution(after)):
        show_addition(problem, before, after, id, asked.now)
    return Answer.of(id not in after.unplanned)
