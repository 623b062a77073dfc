"""`carproof conform`: whether a planner conforms to the specification."""

import os
import shlex
import shutil
from collections.abc import Sequence
from pathlib import Path
from secrets import randbits
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from carp_spec.inputs.options import require_limits
from carp_verify.kernel import version
from carproof.command_line.answer import Answer
from carproof.command_line.files import OutputFile, print_document, write_whole
from carproof.command_line.options import examples, json_option, kernel_option
from carproof.command_line.tables import counted, print_line, print_table, printable, remark
from carproof.conform.cases import ASKED_OPS
from carproof.conform.judging.claims import FEATURES, Claims
from carproof.conform.levels import (
    CLASSICAL_LEVELS,
    EXAMPLES,
    EXECUTOR_LEVELS,
    LARGE_SECONDS,
    LEVELS,
    WHOLE_LEVELS,
    Level,
)
from carproof.conform.programs.child import Limits
from carproof.conform.programs.one_shot import INSTANCE, MAP, SCEN, OneShot, names
from carproof.conform.programs.program import Program
from carproof.engines import warm
from carproof.formats import ADAPTERS
from carproof.progress import progress
from carproof.protocol.ops.published import op_list

if TYPE_CHECKING:
    from carproof.conform.reporting.saved import Saved
    from carproof.conform.reporting.saving import Origin
    from carproof.conform.run import Report

_SEED_BITS = 32
_OUTPUTS = ("seed", "junit", "html", "as_json")
"""Options that a command line that asks again leaves out, or has anyway."""
_LEVELS = "\n".join(
    ["\b", "Levels, each with all before it:", *(f"  {level.label:20}{level.statement}" for level in Level), "", ""]
)


@click.command(
    short_help="Ask a program questions, and judge its answers.",
    epilog=_LEVELS
    + op_list(ASKED_OPS)
    + examples(
        "carproof conform -- carproof serve",
        "carproof conform --level complete-in-context --examples 2000 -- ./planner",
        "carproof conform --one-shot -- ./planner {instance} {solution}",
        "carproof conform --solvable --without releases -- ./planner",
        "carproof conform --one-shot -- ./planner {map} {scen} {agents} {solution}",
        "carproof conform --level context-optimal --kernel -- ./planner",
        "carproof conform --executor -- carproof serve",
        "carproof conform --junit conform.xml --html conform.html -- ./planner",
    ),
)
@click.argument("program", nargs=-1, required=True, metavar="-- PROGRAM ...")
@click.option("--level", type=click.Choice(list(LEVELS)), default=Level.SOUND.label, help="The level to judge by.")
@click.option("--examples", "number", type=click.IntRange(0), default=EXAMPLES, help="The number of random cases.")
@click.option(
    "--seed",
    type=click.IntRange(0, 2**64 - 1),
    default=lambda: randbits(_SEED_BITS),
    show_default="a new one",
    help="The seed of the random cases.",
)
@click.option(
    "--timeout",
    type=click.FloatRange(0, 86_400, min_open=True),
    default=5.0,
    help="Seconds for an answer; 5 times that at a start.",
)
@click.option(
    "--large",
    type=click.FloatRange(0),
    default=LARGE_SECONDS,
    help="Seconds for large cases, of 10 to 1000 robots; 0: none are asked.",
)
@click.option("--shrinking", type=click.FloatRange(0), default=15.0, help="Seconds for shrinking a failure.")
@click.option("--memory", type=click.IntRange(0), default=4096, help="MiB of address space for PROGRAM; 0: any.")
@click.option("--solvable", is_flag=True, help="Ask only for robots that can have plans, together.")
@click.option(
    "--without",
    type=click.Choice([*FEATURES]),
    multiple=True,
    metavar="FEATURE",
    help=f"Ask nothing that has it; may be repeated. One of {', '.join(FEATURES)}.",
)
@click.option("--groups", is_flag=True, help="Ask for instances with groups too, which PROGRAM claims to plan.")
@click.option("--stops", is_flag=True, help="Ask for robots with stops and service too, which PROGRAM claims to plan.")
@click.option("--one-shot", is_flag=True, help="PROGRAM plans one {instance}, or {map} and {scen}.")
@click.option("--executor", is_flag=True, help="PROGRAM executes plans, by the op drive.")
@click.option(
    "--from",
    "format",
    type=click.Choice([*ADAPTERS]),
    metavar="FORMAT",
    help=f"The format of its answer: {', '.join(ADAPTERS)}.  [default: found out]",
)
@kernel_option
@click.option(
    "--save",
    type=click.Path(path_type=Path, file_okay=False),
    default="conform-failure",
    help="A folder in which each program has a folder.",
)
@click.option("--junit", type=OutputFile(), help="Write the results to this file, as XML for continuous integration.")
@click.option("--html", type=OutputFile(), help="Write a report to this file, with each failure in the viewer.")
@json_option
def command(  # noqa: PLR0913 - one parameter for each argument and option
    *,
    program: tuple[str, ...],
    level: str,
    number: int,
    seed: int,
    timeout: float,
    large: float,
    shrinking: float,
    memory: int,
    solvable: bool,
    without: tuple[str, ...],
    groups: bool,
    stops: bool,
    one_shot: bool,
    executor: bool,
    format: str | None,
    kernel: bool,
    save: Path,
    junit: Path | None,
    html: Path | None,
    as_json: bool,
) -> Answer:
    """Ask PROGRAM questions, and judge its answers.

    PROGRAM stays up and answers requests, one a line, as carproof serve does: start, stop, and any of the ops below. It
    is not asked ops that it does not offer. A failing case is shrunk and written to its folder in that of --save: the
    request, the documents, a test vector and pictures. The next run asks these cases first.

    For the seconds of --large it is asked about 10 to 1,000 robots, large maps and large numbers. The last line says
    how large the cases were that it rightly answered; nothing is claimed beyond.

    It must answer all smoke cases, and 90 in 100 random cases of each op that it offers. A skipped case or an undecided
    optimum is not an answer. It may give up at most half of the random cases of an op that have an answer. carproof
    rules program/answers and program/tries have the details. Random cases are new each time, so that they cannot be
    known in advance; the verdict names the seed that repeats them.

    With --groups, PROGRAM is asked for instances with groups too, at every level; with --stops, for robots with several
    stops and with service.

    A planner that does not claim all of this is asked less: --without capacities --without directed, or --solvable. The
    verdict lists the parts that were left out.

    With --one-shot it is started for each instance, and plans the file {instance}. It writes the file {solution}, if
    its arguments name that, or else to its standard output. If the arguments name {map} and {scen}, these are MovingAI
    files with {agents} agents, and the output may be in any format that carproof check reads. Then only classical grids
    are asked, and the levels are sound, complete and optimal.

    With --executor it executes plans whose robots are late: at each tick it names the robots that enter their next
    visit. At the level sound robots must not collide, and all must arrive; at exact they keep the planned order too.

    With --kernel the proved kernel decides whether plans break a rule, and whether each arrives as early as possible,
    at the levels sound, complete-in-context and context-optimal. carp_spec decides the rest: histories of robots under
    way.

    Exit codes: 0 it conforms, 1 it does not, 2 bad usage, 3 undecided: no random case decided it. If interrupted, the
    command prints its findings so far.
    """
    from carproof.conform.reporting.documents import junit_document, report_document  # noqa: PLC0415 - it draws
    from carproof.conform.reporting.saved import own_folder, read_saved  # noqa: PLC0415
    from carproof.conform.run import Options, conform  # noqa: PLC0415

    require_limits(timeout=timeout, large=large, shrinking=shrinking)
    if format is not None and not one_shot:
        raise click.UsageError("--from concerns the files that programs write with --one-shot.")
    if executor and (one_shot or kernel):
        raise click.UsageError("--executor can be combined with neither --one-shot nor --kernel.")
    if shutil.which(program[0]) is None:
        raise click.UsageError(f"{program[0]}: there is no such program, or it may not be run.")
    limits = Limits(timeout, memory)
    subject = _one_shot(program, limits, format) if one_shot else Program(program, limits, seed)
    classical = isinstance(subject, OneShot) and subject.is_classical
    _require_level(LEVELS[level], one_shot, classical, executor, kernel)
    if (groups or stops) and classical:
        raise click.UsageError("--groups and --stops concern instances of carproof, and the program plans maps.")
    options = Options(
        LEVELS[level],
        number,
        seed,
        timeout,
        shrinking,
        whole=one_shot,
        classical=classical,
        claims=Claims(frozenset(without), solvable, groups, stops),
        kernel=version() if kernel else None,
        executor=executor,
        large=large,
    )
    warm()
    origin = _origin(program, level, one_shot, executor, seed)
    scripts = (word for word in program[1:] if os.path.isfile(word))  # noqa: PTH113 - a long text is none
    folder = own_folder(save, Path(next(scripts, program[0])).name, origin.judged)
    before = read_saved(folder, one_shot)
    if before.stale is not None:
        remark(printable(before.stale))
    with progress("asking", number) as advance:
        report = conform(subject, options, advance, before.cases)
    saved = _saved(report, folder, origin, before)
    if junit is not None:
        write_whole(junit, junit_document(report, saved))
    if html is not None:
        from carproof.conform.reporting.html_report import html_document  # noqa: PLC0415 - it draws

        write_whole(html, html_document(report, saved, origin))
    if as_json:
        print_document(report_document(report, saved))
    else:
        _show(report, saved)
    return Answer.UNDECIDED if report.conforms is None else Answer.of(report.conforms)


def _require_level(level: Level, one_shot: bool, classical: bool, executor: bool, kernel: bool) -> None:
    judged, what = tuple(Level), "a program"
    if classical:
        judged, what = CLASSICAL_LEVELS, "a planner for MovingAI files"
    elif one_shot:
        judged, what = WHOLE_LEVELS, "a planner for whole instances"
    elif executor:
        judged, what = tuple(EXECUTOR_LEVELS), "an executor"
    if level not in judged:
        raise click.UsageError(f"Of {what} --level must be one of {', '.join(each.label for each in judged)}.")
    if kernel and level > Level.CONTEXT_OPTIMAL:
        raise click.UsageError(f"With --kernel --level must be at most {Level.CONTEXT_OPTIMAL.label}.")


def _one_shot(program: tuple[str, ...], limits: Limits, format: str | None) -> OneShot:
    from tempfile import gettempdir  # noqa: PLC0415 - loaded only where used

    try:
        gettempdir()
    except FileNotFoundError as error:
        message = "With --one-shot a folder is needed for the files that the program reads: TMPDIR can name one."
        raise click.UsageError(message) from error
    has_map, has_scen = names(program, MAP), names(program, SCEN)
    if has_map != has_scen or not (has_map or names(program, INSTANCE)):
        message = f"With --one-shot the program's arguments must hold {INSTANCE}, or {MAP} and {SCEN}."
        raise click.UsageError(message)
    return OneShot(program, limits, format)


def _saved(report: "Report", folder: Path, origin: "Origin", before: "Saved") -> list[Path]:
    """Save the failures, and return their folders; where they cannot be written, say so and go on to the verdict."""
    from carproof.conform.reporting.saved import save_all  # noqa: PLC0415 - what draws pictures is loaded when it is needed

    if report.interrupted and not report.failures:
        return []
    try:
        return save_all(report.failures, folder, origin, before.not_asked(report.outcomes))
    except click.ClickException as error:
        remark(f"Nothing is saved: {printable(error.message)}")
        return []


def _origin(program: Sequence[str], level: str, one_shot: bool, executor: bool, seed: int) -> "Origin":
    """Who is judged, and the command lines that ask again; no single line asks an executor one case."""
    from carproof.conform.reporting.saving import Origin  # noqa: PLC0415 - what draws pictures is loaded when it is needed

    context = click.get_current_context()
    words = ["--seed", str(seed)]
    for option in context.command.params:
        is_given = context.get_parameter_source(option.name or "") == ParameterSource.COMMANDLINE
        if is_given and isinstance(option, click.Option) and option.name not in _OUTPUTS:
            value = context.params[option.name or ""]
            values = value if option.multiple else [value]
            words += [option.opts[0]] if option.is_flag else [w for each in values for w in (option.opts[0], str(each))]
    way = ["--one-shot"] if one_shot else ["--executor"] if executor else []
    judged = shlex.join(["--level", level, *way, "--", *program])
    starts = """(echo '{"id":0,"op":"start","version":1}'; cat '{request}') | """
    one = "" if executor else shlex.join(program) if one_shot else f"{starts}{shlex.join(program)}"
    return Origin(f"carproof conform {judged}", shlex.join(["carproof", "conform", *words, "--", *program]), one)


def _show(report: "Report", saved: Sequence[Path]) -> None:
    from carproof.conform.reporting.documents import RESULTS, counts  # noqa: PLC0415
    from carproof.conform.reporting.wording import details, verdict  # noqa: PLC0415

    rows = [(stage, *(count[name] for name in RESULTS)) for stage, count in counts(report).items()]
    print_table(["cases", *RESULTS], rows, numbers=RESULTS)
    click.echo()
    for fault in report.faults:
        print_line(f"{fault.category}: {fault.message} [{fault.rule}]")
    for outcome in report.failures:
        finding, instance = outcome.fault, outcome.case.instance
        size = f"{counted(len(instance.robots), 'robot')}, {counted(len(instance.graph.resources), 'resource')}"
        print_line(f"{finding.category} ({outcome.case.name}; {size}): {finding.message} [{finding.rule}]")
    for shortfall in report.shortfalls:
        print_line(f"too few answers: {shortfall}")
    stderr = next((finding.stderr for finding in report.findings if finding.stderr), "")
    if stderr:
        click.echo("the end of the program's standard error:")
        for line in stderr.splitlines()[-10:]:
            print_line(f"  {line}")
    if saved:
        others = f", with {len(saved) - 1} more in it" if saved[1:] else ""
        print_line(f"the smallest failing case is in {saved[0]}{others}")
    for line in (*details(report), *verdict(report)):
        print_line(line)
