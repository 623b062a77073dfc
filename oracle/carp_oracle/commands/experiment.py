"""`carproof experiment`: run an experiment of the paper, or go on with one."""

from pathlib import Path

import click

from carp_oracle.answer import Answer
from carp_oracle.files import print_document
from carp_oracle.options import examples
from carp_oracle.progress import progress
from carp_oracle.tables import print_line, print_table


@click.command(
    epilog=examples(
        "carproof experiment quality --quick",
        "carproof experiment quality --assignments 20 --map 20 --map 10",
        "carproof experiment quality --store full.sqlite --workers 2 --report report",
        "carproof experiment quality --backend dask --scheduler tcp://10.0.0.1:8786",
    )
)
@click.argument("name", type=click.Choice(["quality"]))
@click.option("--quick", is_flag=True, help="20 assignments in place of the paper's 500.")
@click.option("--assignments", type=click.IntRange(min=1), help="How many assignments, if neither 500 nor 20.")
@click.option("--map", "maps", type=click.IntRange(0, 20), multiple=True, help="Only this map; may be repeated.")
@click.option("--store", type=click.Path(path_type=Path, dir_okay=False), help="Keep the results in this file.")
@click.option("--report", type=click.Path(path_type=Path, file_okay=False), help="Write tables and figures there.")
@click.option("--workers", type=click.IntRange(min=1), default=1, help="Processes on this machine.")
@click.option("--backend", type=click.Choice(["loky", "dask"]), default="loky", help="Who computes.")
@click.option("--scheduler", metavar="ADDRESS", help="The address of the dask scheduler.")
@click.option("--json", "as_json", is_flag=True, help="Print one document on standard output, and nothing else.")
def command(  # noqa: PLR0913, PLR0917 - one argument an option
    name: str,
    quick: bool,
    assignments: int | None,
    maps: tuple[int, ...],
    store: Path | None,
    report: Path | None,
    workers: int,
    backend: str,
    scheduler: str | None,
    as_json: bool,
) -> Answer:
    """Run the experiment NAME, or go on with the one in the store.

    quality: experiment 1 of the paper: 100 robots on 21 maps, 500 assignments, every algorithm.

    A run that is stopped goes on where it was when it is called again with the same store. Whoever computes,
    the results are the same, and so is their digest.
    """
    import msgspec  # noqa: PLC0415 - loaded with the experiment

    from carp_experiments.campaign import Workers, run_campaign  # noqa: PLC0415
    from carp_experiments.quality import FULL_ASSIGNMENTS, QUICK_ASSIGNMENTS, quality_cases, summarise  # noqa: PLC0415
    from carp_experiments.quality_report import write_report  # noqa: PLC0415
    from carp_experiments.store import open_store  # noqa: PLC0415

    if backend == "dask" and scheduler is None:
        raise click.UsageError("The backend dask needs the address of its --scheduler.")
    size = assignments or (QUICK_ASSIGNMENTS if quick else FULL_ASSIGNMENTS)
    cases = quality_cases(size, maps) if maps else quality_cases(size)
    on_maps = f"maps {', '.join(map(str, maps))}" if maps else "all maps"
    with open_store(store, f"{name} of {size} assignments on {on_maps}") as results:
        with progress(name, len(cases)) as advance:
            run_campaign(cases, results, Workers(workers, "dask" if backend == "dask" else "loky", scheduler), advance)
        summaries = summarise(row for _, row in results.rows())
        digest = results.digest()
    if report is not None:
        write_report(report, summaries)
    if as_json:
        document = {"experiment": name, "cases": len(cases), "digest": digest, "summaries": summaries}
        print_document(msgspec.json.encode(document) + b"\n")
        return Answer.YES
    columns = ("map", "algorithm", "failures", "of", "mean total")
    rows = [
        (each.map, each.algorithm, each.failures, each.assignments, f"{each.total.estimate:.1f}" if each.total else "-")
        for each in summaries
    ]
    print_table(columns, rows, numbers=("map", "failures", "of", "mean total"))
    print_line(f"digest of {len(cases)} cases: {digest}")
    return Answer.YES
