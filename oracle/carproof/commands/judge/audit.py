"""`carproof audit`: whether each plan of a solution is optimal beside those before it."""

from time import perf_counter

import click

from carp_spec.documents.decoding import write
from carp_spec.requests import sound_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import naming, print_document
from carproof.command_line.foreign import Problem, solution_files
from carproof.command_line.options import engine_option, json_option, kernel_option, listed
from carproof.command_line.output import shown_plan
from carproof.command_line.tables import print_line, print_table
from carproof.command_line.time_left import time_left
from carproof.engines import engine_named
from carproof.judging.audit import ask_kernel, audit_in_order, audit_in_some_order
from carproof.judging.documents import arrival_of, audit_document
from carproof.progress import progress
from carproof.requests import deadline

COLUMNS = ("robots", "certified", "late", "undecided", "unplanned", "decided by", "time")
OWN_FORMAT = "carproof"


@listed(
    "Check that no robot can arrive earlier.",
    "carproof audit town.json plans.json",
    "carproof audit town.json plans.json --kernel",
    "carproof audit town.json plans.json --seconds 10",
    "carproof audit --map town.map --scen town.scen --agents 40 result.txt",
)
@solution_files
@click.option("--find-order", is_flag=True, help="Look for an order in which no plan is late, whatever SOLUTION says.")
@click.option("--seconds", type=float, help="The time of the whole command, without the kernel's.")
@kernel_option
@engine_option
@json_option
@click.pass_context
def command(  # noqa: PLR0913 - one parameter for each argument and option
    context: click.Context,
    *,
    problem: Problem,
    find_order: bool,
    seconds: float | None,
    kernel: bool,
    engine: str | None,
    as_json: bool,
) -> Answer:
    """Certify for each plan of SOLUTION that its robot cannot arrive earlier beside the plans before it.

    Any planner may have made the plans; they must break no rule. They are judged in the planning order of SOLUTION, all
    at tick 0: no robot is under way. Other planners' formats have no such order. For them, and with --find-order, the
    audit searches for an order in which no plan is late; if none exists, it lists the plans that are late in every
    order.

    An audit does not judge ties, whether another order would be better, or whether robots without a plan could have
    one.

    With --seconds, plans that the audit has no time to look at are undecided.

    Exit codes: 0 each plan is certified, 1 a plan is late, 2 bad input, 3 no plan is late, and some are undecided.
    """
    until = deadline(time_left(context, seconds))
    instance, given, format = problem.read()
    with naming(problem.solution or ""):
        sound = sound_solution(instance, given)
    look = audit_in_some_order if find_order or format != OWN_FORMAT else audit_in_order
    certifying = engine_named(engine or "optimized")  # compiled before the clock starts
    started = perf_counter()
    with problem.naming(), progress("auditing", len(sound.plans)) as advance:
        audit = look(instance, sound, certifying, advance, lambda: perf_counter() < until)
    if kernel:
        ask_kernel(instance, audit)
    if as_json:
        print_document(write(audit_document(audit, sound)))
    else:
        time = f"{perf_counter() - started:.2f} s"
        counted = (instance.robots, audit.certified, audit.late, audit.undecided, sound.unplanned)
        print_table(COLUMNS, [[*(len(each) for each in counted), audit.by, time]], numbers=COLUMNS[:5])
        for late in audit.late:
            earlier = f"{arrival_of(late.earlier)}: {shown_plan(late.earlier)}"
            print_line(f"robot {late.plan.robot} arrives at {arrival_of(late.plan)}, and can at {earlier}")
        if look is audit_in_some_order and audit.late:
            print_line("in no order are all plans optimal: these are late beside the plans that are certified")
    return Answer.UNDECIDED if audit.undecided and not audit.late else Answer.of(audit.holds)
