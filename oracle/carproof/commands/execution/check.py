"""`carproof execution check`: whether what has happened follows a solution."""

from carp_spec.documents.solutions import read_trace
from carp_spec.documents.verdicts import write_verdict
from carproof.api.judging import check_trace
from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document, read_file, read_sound
from carproof.command_line.options import instance_argument, json_option, listed, solution_argument, trace_argument
from carproof.command_line.tables import print_line


@listed("Check what robots have done against their plans.", "carproof execution check town.json plans.json trace.json")
@instance_argument
@solution_argument
@trace_argument
@json_option
def command(*, instance: str, solution: str, trace: str, as_json: bool) -> Answer:
    """Check that TRACE, what has happened so far, follows SOLUTION: paths, durations, and the planned order.

    Robots may be late: the trace need not have the ticks of the plans. SOLUTION must break no rule.

    Exit codes: 0 no rule is broken, 1 a rule is broken, 2 bad input.
    """
    problem, sound = read_sound(instance, solution)
    done = read_file(trace, read_trace)
    verdict = check_trace(problem, sound, done)
    if as_json:
        print_document(write_verdict(verdict))
        return Answer.of(verdict.valid)
    for violation in verdict.violations:
        print_line(str(violation))
    if verdict.valid:
        lengths = {plan.robot: len(plan.visits) for plan in sound.plans}
        arrived = sum(len(plan.visits) == lengths[plan.robot] for plan in done.plans)
        print_line(f"no rule is broken: by tick {done.now}, {arrived} of {len(lengths)} robots are at their goals")
    else:
        print_line("INVALID: the trace does not follow the plans")
    return Answer.of(verdict.valid)
