"""`carproof experiment`: run an experiment of the paper, or continue one."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any

import click
import msgspec

from carp_experiments.campaign import Backend, Case, Workers, run_campaign
from carp_experiments.experiments import EXPERIMENTS, Experiment, Profile
from carp_experiments.measuring.benchmark import benchmark_cases, benchmark_report
from carp_experiments.measuring.blocks import Questions
from carp_experiments.measuring.crosscheck_campaign import CROSSCHECK
from carp_experiments.measuring.kernel_texts import TEXTS
from carp_experiments.measuring.kernel_verdicts import VERDICTS
from carp_experiments.paper.map_cases import SORTING, WAREHOUSE
from carp_experiments.report import ExperimentReport, write_report
from carp_experiments.store import Row, open_store, stored_rows
from carp_verify.kernel import program
from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document
from carproof.command_line.options import examples
from carproof.command_line.tables import print_line, print_table
from carproof.extras import require
from carproof.progress import progress

FOLDER = click.Path(path_type=Path, file_okay=False, exists=True)
TABLE = click.Path(path_type=Path, dir_okay=False, exists=True)
AT_LEAST_1 = click.IntRange(min=1)
PROGRAM = click.Path(dir_okay=False, exists=True, resolve_path=True)
RECOMPUTED = ("gap", "related", "quality", "time", "polish", "reuse", "neighbours", "nearest")


@click.group(
    epilog=examples(
        "carproof experiment quality --quick",
        "carproof experiment quality --assignments 20 --map 20 --map 10",
        "carproof experiment quality --store full.sqlite --workers 2",
        "carproof experiment quality --store full.sqlite --report report",
        "carproof experiment crosscheck --questions 50000 --seed 7",
        "carproof experiment kernel --verdicts 100000",
        "carproof experiment texts --store texts.sqlite",
        "carproof experiment benchmark --maps maps --bounds bounds.csv",
        "carproof experiment recomputed quality full.sqlite",
        "carproof experiment report -o report",
    )
)
def command() -> None:
    """Run an experiment, or continue the one in a store.

    Results are written to the store as they come. A run that was stopped or killed continues when it is called again
    with the same store, and a larger run reuses the results of a smaller one. The results and their digest do not
    depend on the workers.
    """


@dataclass(frozen=True, slots=True)
class Campaign:
    """What a command runs: of which identity its store is, the command line, and the size in words."""

    name: str
    identity: str
    line: str
    size: str
    cases: Sequence[Case]
    report: Callable[[Iterable[Row]], ExperimentReport]


def runs(campaign_of: Callable[..., Campaign]) -> Callable[..., Answer]:
    """Run the campaign that the function makes of its options; beside them are those that all experiments have."""

    @click.option("--store", type=click.Path(path_type=Path, dir_okay=False), help="Keep the results in this file.")
    @click.option("--report", type=click.Path(path_type=Path, file_okay=False), help="Write tables, figures there.")
    @click.option("--note", default="", help="With --report: on what the run was made, in a sentence.")
    @click.option("--workers", type=AT_LEAST_1, default=1, help="Processes on this machine.")
    @click.option("--backend", type=click.Choice(["loky", "dask"]), default="loky", help="Who computes.")
    @click.option("--scheduler", metavar="ADDRESS", help="The address of the dask scheduler.")
    @click.option("--json", "as_json", is_flag=True, help="Print one document on standard output, nothing else.")
    @wraps(campaign_of)
    def run(  # noqa: PLR0913 - one parameter for each option
        *,
        store: Path | None,
        report: Path | None,
        note: str,
        workers: int,
        backend: Backend,
        scheduler: str | None,
        as_json: bool,
        **own: Any,  # noqa: ANN401 - click's
    ) -> Answer:
        return go(campaign_of(**own), store, report, note, Workers(workers, backend, scheduler), as_json)

    return run


def command_of(experiment: Experiment) -> click.Command:
    """The command of an experiment over maps and assignments."""

    @click.command(
        experiment.name,
        help=f"{experiment.sentence}\n\nIn full: {experiment.full}. Quick: {experiment.quick}.",
        epilog=examples(
            f"carproof experiment {experiment.name} --quick",
            f"carproof experiment {experiment.name} --store {experiment.name}.sqlite",
        ),
        short_help=experiment.sentence,
    )
    @click.option("--quick", is_flag=True, help="The quick size.")
    @click.option("--assignments", type=AT_LEAST_1, help="How many assignments.")
    @click.option("--robots", type=AT_LEAST_1, help="How many robots.")
    @click.option(
        "--map",
        "maps",
        type=click.IntRange(0, SORTING),
        multiple=True,
        help=f"Only this map ({WAREHOUSE}: a warehouse, {SORTING}: a sorting centre); may be repeated.",
    )
    @runs
    def run(quick: bool, assignments: int | None, robots: int | None, maps: tuple[int, ...]) -> Campaign:
        base = experiment.quick if quick else experiment.full
        chosen = tuple(sorted(set(maps))) or base.maps
        profile = Profile(assignments or base.assignments, robots or base.robots, chosen)
        experiment.refuse(profile)
        return Campaign(
            experiment.name,
            f"{experiment.name} of {profile.robots} robots",
            f"carproof experiment {experiment.name} {profile.options}",
            str(profile),
            experiment.cases(profile),
            lambda rows: experiment.report(rows, profile.robots),
        )

    return run


def command_of_questions(questions: Questions) -> click.Command:
    """The command of random questions, with an option for each kind of them."""
    name, what, codes = questions.name, questions.what, "Exit codes: 0 no difference, 1 a difference, 2 bad usage"

    @click.command(name, help=f"{questions.about}\n\n{codes}{', or no kernel' if questions.of_kernel else ''}.")
    @click.option("--quick", is_flag=True, help=f"{questions.quick} {what}.")
    @click.option(f"--{what}", "number", type=AT_LEAST_1, default=questions.full, help=f"The number of random {what}.")
    @click.option("--seed", type=click.IntRange(0, 2**64 - 1), default=0, help=f"The seed of the {what}.")
    @runs
    def run(quick: bool, number: int, seed: int, kind: str | None = None) -> Campaign:
        if questions.of_kernel:
            program()  # before the store is there
        size = questions.quick if quick else number
        line = f"carproof experiment {name} --{what} {size} --seed {seed}{f' --{kind}' if kind else ''}"
        return Campaign(name, name, line, f"{size} {what}", questions.cases(size, seed, kind), questions.report)

    run.params[3:3] = [
        click.Option([f"--{kind}", "kind"], flag_value=kind, help=about) for kind, about in questions.kinds.items()
    ]
    return run


for asked in (CROSSCHECK, VERDICTS, TEXTS):
    command.add_command(command_of_questions(asked))


@command.command("benchmark")
@click.option("--maps", type=FOLDER, required=True, help="The folder with the files of MovingAI, at any depth.")
@click.option("--bounds", type=TABLE, required=True, help="The table: map,scen,agents,lower,upper.")
@click.option("--seconds", type=AT_LEAST_1, multiple=True, default=(10,), show_default=True, help="May be repeated.")
@click.option("--bound-seconds", type=click.IntRange(min=0), default=0, show_default=True, help="For a bound; 0: none.")
@click.option("--lacam3", type=PROGRAM, help="The program of LaCAM3, to be compared with.")
@click.option("--lns2", type=PROGRAM, help="The program of MAPF-LNS2, to be compared with.")
@click.option("--plans", type=click.Path(path_type=Path, file_okay=False), help="Write plans and certificates there.")
@runs
def benchmark(  # noqa: PLR0913, PLR0917 - one parameter for each option
    maps: Path,
    bounds: Path,
    seconds: tuple[int, ...],
    bound_seconds: int,
    lacam3: str | None,
    lns2: str | None,
    plans: Path | None,
) -> Campaign:
    """Plan cases of the MovingAI benchmark, beside the figures of its tracker and other planners.

    Robots park. --seconds are of processor time; all plans are judged, and bounds verified.

    Exit codes: 0 done, 1 a total below a verified bound, 2 bad input.
    """
    others = {name: program for name, program in {"LaCAM3": lacam3, "LNS2": lns2}.items() if program is not None}
    cases = benchmark_cases(bounds, maps, seconds, bound_seconds, others, plans)
    beside = f", beside {' and '.join(others)}" if others else ""
    identity = f"benchmark of {', '.join(map(str, seconds))} s, bounds {bound_seconds} s{beside}"
    line = f"carproof experiment benchmark {' '.join(f'--seconds {each}' for each in seconds)}"
    return Campaign("benchmark", identity, line, f"{len(cases)} cases", cases, benchmark_report)


@command.command("recomputed")
@click.argument("experiment", metavar="EXPERIMENT", type=click.Choice(RECOMPUTED))
@click.argument("stored", metavar="STORED", type=TABLE)
@click.option("--cases", "count", type=AT_LEAST_1, default=50, show_default=True, help="How many cases.")
@click.option("--seed", type=click.IntRange(0, 2**64 - 1), default=0, show_default=True, help="The seed of the draw.")
@click.option("--robots", type=AT_LEAST_1, help="How many robots the stored run has, if not in full size.")
@runs
def recomputed(experiment: str, stored: Path, count: int, seed: int, robots: int | None) -> Campaign:
    """Compute random cases of a stored run again with the reference planner.

    STORED is the store of a run of EXPERIMENT. Its bounds, optima, times and polishes are left out, and of the slow
    algorithms of 100 robots few cases are drawn, or none.

    Exit codes: 0 all equal, 1 a case is not, 2 bad usage.
    """
    from carp_experiments.recomputed import again_report, cases_again  # noqa: PLC0415 - loads compiled code

    size = robots or next(each.full.robots for each in EXPERIMENTS if each.name == experiment)
    cases = cases_again(experiment, stored_rows(stored, f"{experiment} of {size} robots"), size, count, seed)
    identity = f"{experiment} recomputed with seed {seed}"
    line = f"carproof experiment recomputed {experiment} {stored.name} --cases {count} --seed {seed}"
    return Campaign("recomputed", identity, line, f"{count} cases of {experiment}", cases, again_report)


@command.command("report")
@click.option(
    "--results",
    "stored",
    type=FOLDER,
    help="The folder that --report has written; by default the results of this copy of carproof.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("report"),
    show_default=True,
    help="The folder of the report.",
)
def report(stored: Path | None, output: Path) -> Answer:
    """Write one report on all runs of a folder, as HTML and as PDF, and beside it each figure as a PDF of its own."""
    require("matplotlib", "markdown", "fpdf")
    from carp_experiments.page import RESULTS  # noqa: PLC0415 - loads the experiments
    from carp_experiments.printed import write_figures, write_printed  # noqa: PLC0415

    for path in (*write_printed(output, stored or RESULTS), *write_figures(output, stored or RESULTS)):
        print_line(f"wrote {path}")
    return Answer.of(True)


def go(
    campaign: Campaign, store: Path | None, report: Path | None, note: str, workers: Workers, as_json: bool
) -> Answer:
    """Run the cases that the store does not have, and report on all cases."""
    is_dask = workers.backend == "dask"
    require("joblib", *(["matplotlib"] if report is not None else []), *(["distributed"] if is_dask else []))
    if is_dask and workers.scheduler is None:
        raise click.UsageError("The backend dask needs the address of its --scheduler.")
    keys = [case.key for case in campaign.cases]
    with open_store(store, campaign.identity) as results:
        with progress(campaign.name, len(keys)) as advance:
            run_campaign(campaign.cases, results, workers, advance)
        reported = campaign.report(row for _, row in results.rows(keys))
        facts = {
            "command": campaign.line,
            "size": campaign.size,
            "cases": len(keys),
            "digest": results.digest(keys),
            "processor_seconds": round(results.seconds(keys)),
            "note": note,
        }
    if report is not None:
        from carp_experiments.redrawing import draw_figures  # noqa: PLC0415 - loads compiled code

        write_report(report, campaign.name, reported, facts)
        draw_figures(report, report, names=[campaign.name])
    if as_json:
        print_document(msgspec.json.encode({"experiment": campaign.name, **facts, "summary": reported.summary}) + b"\n")
        return Answer.of(reported.holds)
    for table in reported.tables:
        print_line(f"{table.title}:")
        print_table(table.columns, table.rows, numbers=table.numbers)
        print_line("")
    for line in reported.lines:
        print_line(line)
    print_line(f"{campaign.size}: digest of {len(keys)} cases {facts['digest']}")
    return Answer.of(reported.holds)


for each in EXPERIMENTS:
    command.add_command(command_of(each))
