"""`carproof dev bench`: a query, a pass of CARP, a robot added, on the paper's maps and larger ones.

All times are processor times and medians over assignments, on a warm fleet that stays up: guides, arrays and machine
code exist. A pass is CARP over all robots, on an empty fleet and in the same run, so the ratios hold on any machine.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from carp_spec.documents.decoding import write
from carproof.command_line.answer import Answer
from carproof.command_line.files import print_document
from carproof.command_line.options import json_option, listed
from carproof.command_line.tables import print_table
from carproof.progress import progress

if TYPE_CHECKING:
    from carp_experiments.measuring.bench_times import Added, OnGrid, OnMap

MAPS = (10, 20)
GROWTH = (20, 40, 80, 160)


@listed(
    "Measure queries, passes of CARP and additions.",
    "carproof dev bench",
    "carproof dev bench --assignments 5 --json > bench.json",
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
    from carp_experiments.measuring.bench_times import PARTS, ROBOTS, on_grid, on_map, weight  # noqa: PLC0415 - slow

    sides = GROWTH if growth else ()
    steps = len(MAPS) * assignments + PARTS * sum(map(weight, sides))
    with progress("measuring", steps) as advance:
        maps = [on_map(number, assignments, advance) for number in MAPS]
        grids = [on_grid(side, advance) for side in sides]
    if as_json:
        full = maps[-1]
        found = {
            "query_us": full.query_us,
            "pass_us": full.pass_us,
            "ratios": {each.neighbourhood: each.ratio for each in full.added if each.k == ROBOTS},
            "maps": maps,
            "growth": grids,
        }
        print_document(write(found))
    else:
        show(maps, grids)
    return Answer.YES


def show(maps: Sequence["OnMap"], grids: Sequence["OnGrid"]) -> None:
    """Print tables."""
    columns = ["map", "query", "pass"]
    times = [(each.map, f"{each.query_us:.1f} us", f"{each.pass_us:.0f} us") for each in maps]
    print_table(columns, times, numbers=columns)
    columns = ["map", "robot", "M", "add us", "ratio", "asked", *maps[0].added[0].avoided]
    added = [_cells(each.map, one) for each in maps for one in each.added]
    click.echo()
    print_table(columns, added, numbers=columns)
    if grids:
        columns = ["grid", "robots", "query", "pass", "add", "asked"]
        growth = [
            (f"{each.side}^2", each.robots, f"{each.query_us:.1f} us", _ms(each.pass_us), _ms(each.add_us), each.asked)
            for each in grids
        ]
        click.echo()
        print_table(columns, growth, numbers=columns)


def _cells(map: int, one: "Added") -> tuple[object, ...]:
    avoided = [f"{count:.0f}" for count in one.avoided.values()]
    return (map, one.k, one.neighbourhood, f"{one.add_us:.0f}", f"{one.ratio:.2f}", f"{one.asked:.0f}", *avoided)


def _ms(time_us: float) -> str:
    return f"{time_us / 1000:.2f} ms"
