"""`carproof check`: whether a solution, in carproof's format or another planner's, breaks a rule."""

import json
from dataclasses import asdict
from time import perf_counter

import click

from carp_spec import Instance, Solution, Verdict
from carp_spec.check import MOST_LISTED
from carp_spec.documents.decoding import write
from carp_spec.documents.solutions import solution_document
from carp_spec.documents.verdicts import write_verdict
from carp_verify.bound.rules import ContradictionError
from carp_verify.footprint.rules import Footprint
from carp_verify.kernel import KernelVerdict, ask, request
from carproof.api.judging import check
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, naming
from carproof.command_line.foreign import Problem, solution_files
from carproof.command_line.options import kernel_option, listed, output_options, read_by
from carproof.command_line.output import show_violations
from carproof.command_line.tables import counted, print_line, remark
from carproof.layouts.settings import footprint as footprint_of
from carproof.layouts.settings import step_of_cells
from carproof.progress import progress


@listed(
    "Check plans, and name the rules that they break.",
    "carproof check town.json plans.json",
    "carproof plan town.json --json | carproof check town.json -",
    "carproof check town.json plans.json --json > verdict.json",
    "carproof check town.json plans.json --require-all",
    "carproof check town.json result.txt --from lacam",
    "carproof check plant.json plans.json --footprint 900x600mm",
    "carproof check grid.json plans.json --footprint 450mm --cells 1m",
    "carproof check town.json plans.json --kernel",
    "carproof check town.json plans.json --z3",
    "carproof check --map town.map --scen town.scen --agents 40 result.txt",
)
@solution_files
@kernel_option
@click.option("--z3", is_flag=True, help="Let z3 confirm that plans keep capacities and avoid exchanges.")
@click.option(
    "--footprint",
    callback=read_by(footprint_of),
    help="The size of vehicles, 900x600mm or a radius like 450mm, to check that they keep apart.",
)
@click.option(
    "--cells",
    callback=read_by(step_of_cells),
    help="With --footprint: no resource is a lane, and a step of the positions is so long, like 1m.",
)
@click.option("--require-all", is_flag=True, help="Answer no also if a robot has no plan.")
@click.option("--all", "everything", is_flag=True, help="List every violation, however many there are.")
@output_options
def command(  # noqa: PLR0913 - an argument an option
    *,
    problem: Problem,
    kernel: bool,
    z3: bool,
    footprint: Footprint | None,
    cells: int | None,
    require_all: bool,
    everything: bool,
    output: Output,
) -> Answer:
    """Check the plans of SOLUTION against INSTANCE, or against a MovingAI map and scenario.

    Prints the first 100 violations of each rule with their reasons (--all: every one), and how often each rule
    is broken. Robots without a plan break no rule; they are counted, and with --require-all the answer is no.
    Either file may be - for standard input.

    SOLUTION is carproof's document or another planner's output (--from). Such output is read as classical multi-agent
    path finding: robots are present from tick 0, move or wait in each tick, and stay at their goals for ever; following
    is allowed, swapping is not. Durations and capacities are one unless INSTANCE has other values.

    With --kernel the proved kernel decides, and --json prints its verdict.

    With --z3 a solution that breaks no rule is looked at by other means: z3 shows for each resource and group that
    it is too full at no tick at all, and for each pair of them that no two robots exchange it. Where it cannot tell,
    the answer is undecided.

    With --footprint, vehicles of that size must keep apart: what they sweep is computed from positions in mm and from
    plans alone, in whole numbers, whatever the groups of INSTANCE. Resources are points and lanes or, with --cells,
    cells: a vehicle is in one from half way from the one before until half way to the one after.

    Exit codes: 0 no rule is broken, 1 a rule is broken (--require-all: or a robot has no plan), 2 bad input,
    3 undecided.
    """
    if footprint is not None and (kernel or z3):
        raise click.UsageError("--kernel and --z3 decide the law alone, which has no sizes; check --footprint apart.")
    if kernel and z3:
        raise click.UsageError("--kernel and --z3 both decide: give one of them.")
    instance, given, _ = problem.read(as_named=True)
    if z3:
        return certified(instance, given, output, require_all)
    most = None if everything else MOST_LISTED
    with naming(problem.name):
        verdict = check(instance, given, most, footprint, cells)
    decided = kernel_verdict(instance, given, verdict) if kernel else None
    document = write_verdict(verdict) if decided is None else write(decided)
    if output.write(document):
        show_violations(verdict.violations, most)
        is_incomplete = verdict.valid and verdict.unplanned and require_all
        result = "INCOMPLETE" if is_incomplete else "no rule is broken" if verdict.valid else "INVALID"
        print_line(f"{result}: total cost {verdict.cost}, unplanned robots {verdict.unplanned}")
        if decided is not None:
            print_line(f"decided by {decided.by}")
    return Answer.of(verdict.valid and not (require_all and verdict.unplanned))


def kernel_verdict(instance: Instance, solution: Solution, verdict: Verdict) -> KernelVerdict:
    """The verdict of the kernel; raises `ContradictionError` if that of `carp_spec` is another."""
    (answer,) = ask([request("check", instance, solution=solution_document(solution))])
    says = (answer.accepted, answer.cost, answer.unplanned)
    if says != ((True, verdict.cost, verdict.unplanned) if verdict.valid else (False, None, None)):
        raise ContradictionError(f"carp_spec and {answer.by} differ: {answer.message or says}")
    return answer


def certified(instance: Instance, solution: Solution, output: Output, require_all: bool) -> Answer:
    """Tell what z3 says of a solution that `check` accepts: too full at no tick at all, and no exchange."""
    from carp_verify.certificate import certify, visited  # noqa: PLC0415 - loads z3
    from carp_verify.lemmas.smt import Undecided  # noqa: PLC0415

    started = perf_counter()
    try:
        with progress("certifying", len(visited(instance, solution.plans))) as advance:
            found = certify(instance, solution, advance)
    except Undecided as undecided:
        remark(f"Undecided: {undecided}.")
        return Answer.UNDECIDED
    unplanned = len(instance.robots) - len(solution.plans)
    answer = Answer.of(found.accepted and not (require_all and unplanned))
    if not output.write(json.dumps({"accepted": found.accepted, **asdict(found)}).encode() + b"\n"):
        return answer
    for broken in (*found.violations, *found.breaches):
        print_line(str(broken))
    asked = f"{found.resources} resources and groups and {found.pairs} pairs of them"
    if found.accepted:
        outcome = f"certified: check finds no rule broken, and z3 no tick too full and no exchange in {asked}"
    elif found.violations:
        outcome = "REFUSED: check finds a rule broken, and z3 was not asked"
    else:
        outcome = f"REFUSED: z3 finds {counted(len(found.breaches), 'tick')} at which a rule is broken in {asked}"
    print_line(f"{outcome} in {perf_counter() - started:.1f} s")
    if found.accepted and answer is Answer.NO:
        print_line(f"INCOMPLETE: unplanned robots {unplanned}")
    return answer
