"""`carproof dev bench`: the speed of the optimised planner."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import click

from carp_experiments.measuring.bench import GROWTH, PARTS, Added, OnGrid, OnMap, on_grid, on_map, weight
from carp_spec.documents.decoding import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document
from carproof.command_line.options import examples, json_option
from carproof.command_line.tables import print_table
from carproof.progress import progress

MAPS = (10, 20)


@click.command(
    short_help="Measure queries, passes of CARP and additions.",
    epilog=examples("carproof dev bench", "carproof dev bench --assignments 5 --json > bench.json"),
)
@click.option("--assignments", type=click.IntRange(min=1), default=20, help="The number of random assignments per map.")
@click.option("--growth/--no-growth", default=True, help="Measure larger and larger grids too.")
@json_option
def command(assignments: int, growth: bool, as_json: bool) -> Answer:
    """Measure one query, one pass of CARP and the adding of a robot.

    It uses the paper's maps 10 and 20 with 100 robots and, with --growth, full grids of 20 x 20 to 160 x 160 with a
    robot to every four nodes. Times are processor times, warm, and medians; on the grids the time of one query is a
    mean. Ratios are to a pass of CARP over all robots in the same run. The last columns count the queries asked, and
    those that each kind of reuse avoided: kept plans of robots before the one taken out; queries that cannot have
    changed; orders that begin alike; answers shared between orders; orders that cannot be better. If orders are drawn,
    only those drawn count.

    Exit codes: 0 done, 2 bad usage.
    """
    sides = GROWTH if growth else ()
    steps = len(MAPS) * assignments + PARTS * sum(map(weight, sides))
    with progress("measuring", steps) as advance:
        maps = [on_map(number, assignments, advance) for number in MAPS]
        grids = [on_grid(side, advance) for side in sides]
    if as_json:
        print_document(write(document(maps, grids)))
    else:
        show(maps, grids)
    return Answer.YES


def document(maps: Sequence[OnMap], grids: Sequence[OnGrid]) -> dict[str, Any]:
    """All figures; those of the full map come first."""
    full = maps[-1]
    last = max(each.k for each in full.added)
    return {
        "query_us": full.query_us,
        "pass_us": full.pass_us,
        "ratios": {each.neighbourhood: each.ratio for each in full.added if each.k == last},
        "maps": [asdict(each) for each in maps],
        "growth": [asdict(each) for each in grids],
    }


def show(maps: Sequence[OnMap], grids: Sequence[OnGrid]) -> None:
    """Print tables."""
    figures = ["query", "pass"]
    rows = [(each.map, f"{each.query_us:.1f} us", f"{each.pass_us:.0f} us") for each in maps]
    print_table(["map", *figures], rows, numbers=["map", *figures])
    kinds = list(maps[0].added[0].avoided)
    columns = ["map", "robot", "M", "add us", "ratio", "asked", *kinds]
    added = [row_of(each.map, one) for each in maps for one in each.added]
    click.echo()
    print_table(columns, added, numbers=columns)
    if grids:
        click.echo()
        columns = ["grid", "robots", "query", "pass", "add", "asked"]
        rows_of_grids = [
            (
                f"{each.side}^2",
                each.robots,
                f"{each.query_us:.1f} us",
                milliseconds(each.pass_us),
                milliseconds(each.add_us),
                each.asked,
            )
            for each in grids
        ]
        print_table(columns, rows_of_grids, numbers=columns)


def milliseconds(time_us: float) -> str:
    """A time for people."""
    return f"{time_us / 1000:.2f} ms"


def row_of(map: int, one: Added) -> tuple[object, ...]:
    """A row of the table of robots added."""
    avoided = [f"{count:.0f}" for count in one.avoided.values()]
    return (map, one.k, one.neighbourhood, f"{one.add_us:.0f}", f"{one.ratio:.2f}", f"{one.asked:.0f}", *avoided)
