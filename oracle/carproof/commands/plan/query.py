"""`carproof query`: plan one robot against the plans of the others."""

from pathlib import Path

import click

from carp_spec import plan_cost
from carp_spec.documents.decoding import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, OutputFile, write_whole
from carproof.command_line.options import Asked, asks_for_a_robot, gives_plans, listed
from carproof.command_line.tables import print_line, print_table
from carproof.engines import engine_named
from carproof.judging.unplanned import why_unplanned
from carproof.protocol.ops.planning import query_document


@listed(
    "Plan one robot beside given plans.",
    "carproof query town.json plans.json r7",
    "carproof query town.json plans.json r7 --now 12 --json",
    "carproof query town.json plans.json r7 --certificate r7.json",
)
@asks_for_a_robot
@click.option("--certificate", type=OutputFile(), help="Write a proof that no plan arrives earlier to this file.")
@gives_plans
def command(*, asked: Asked, certificate: Path | None, engine: str | None, output: Output) -> Answer:
    """Find the plan with which ROBOT arrives earliest beside the plans of SOLUTION.

    Those plans stay as they are. If SOLUTION has a plan of ROBOT, the robot has followed it until --now.
    The command verify checks the file of --certificate, which is also written if there is no plan.

    Exit codes: 0 a plan is found, 1 no plan exists, 2 bad input.
    """
    problem, committed, id = asked.read(for_query=True)
    now = asked.now
    others = [each for each in committed.plans if each.robot != id]
    followed = next((each for each in committed.plans if each.robot == id), None)
    with asked.naming():
        if certificate is None:
            plan = engine_named(engine).query(problem, committed.plans, id, now)
        else:
            certifier = engine_named(engine).certifier(problem)
            certifier.commit(others)
            plan, shown = certifier.certify(id, followed, now)
            write_whole(certificate, write(shown))
    is_told = output.write(write(query_document(plan)))
    if plan is None and is_told:
        print_line(f"no plan: {why_unplanned(problem, others, id, now, followed)}")
    elif plan is not None and is_told:
        rows = [
            (visit.resource, visit.enter, "for ever" if visit.leave is None else visit.leave) for visit in plan.visits
        ]
        print_table(["resource", "enter", "leave"], rows, numbers=["enter", "leave"])
        print_line(f"cost {plan_cost(problem, plan)}")
    return Answer.of(plan is not None)
