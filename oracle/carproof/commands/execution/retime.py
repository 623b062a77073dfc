"""`carproof execution retime`: plans for the rest of the way, after delays."""

from carp_spec import Refusal, total_cost
from carp_spec.documents.solutions import read_trace, write_solution
from carproof.command_line.answer import Answer
from carproof.command_line.files import Output, naming, read_file, read_sound
from carproof.command_line.options import gives_plans, instance_argument, listed, solution_argument, trace_argument
from carproof.command_line.tables import counted, print_line
from carproof.engines import engine_named
from carproof.requests import document_of


@listed(
    "Make plans for the rest, in the same order, after delays.",
    "carproof execution retime town.json plans.json trace.json -o late.json",
    "carproof query town.json late.json r7 --now 13",
)
@instance_argument
@solution_argument
@trace_argument
@gives_plans
def command(*, instance: str, solution: str, trace: str, engine: str | None, output: Output) -> Answer:
    """Give the plans of SOLUTION new ticks: the visits of TRACE stay, the others follow in order as early as possible.

    The result is a solution under way. The trace tells where robots are at its tick T, so `add`, `assign`, `query` and
    `polish` go on with --now T+1: with --now T a robot could still leave at T, where the trace says that it has not.

    Exit codes: 0 there are new plans, 2 bad input, or no lawful plan has such a history.
    """
    problem, sound = read_sound(instance, solution)
    done = read_file(trace, read_trace)
    try:
        after = engine_named(engine).retime(problem, sound, done)
    except Refusal as refusal:
        too_large = document_of(refusal) if refusal.kind == "limit" else None
        with naming({"instance": instance, "solution": solution}.get(too_large or "", trace)):
            raise
    if output.write(write_solution(after)):
        arrivals = {plan.robot: plan.visits[-1].enter for plan in sound.plans}
        print_line(f"total cost {total_cost(problem, sound.plans)} before, {total_cost(problem, after.plans)} now")
        for plan in after.plans:
            ticks = plan.visits[-1].enter - arrivals[plan.robot]
            if ticks:
                print_line(
                    f"robot {plan.robot} arrives {counted(abs(ticks), 'tick')} {'later' if ticks > 0 else 'earlier'}"
                )
        print_line(f"add, assign, query and polish go on with --now {done.now + 1}: the trace tells of tick {done.now}")
    return Answer.YES
