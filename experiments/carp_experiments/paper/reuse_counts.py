"""The queries that the neighbourhood planner asks and avoids, by reason, beside the paper's 67, 54 and 45 per cent."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import factorial

import msgspec

from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_experiments.report import ExperimentReport, Table
from carp_experiments.statistics import Interval, mean_interval
from carp_experiments.store import Row
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_optimized.neighbourhood.reuse import Reuse
from carp_optimized.orderings import carp
from carp_spec import Neighbourhood

NOTHING = Reuse(kept=False, unchanged=False, prefixes=False, shared=False, bounds=False)
SETTINGS: Mapping[str, Reuse] = {
    "nothing": NOTHING,
    "kept": Reuse(kept=True, unchanged=False, prefixes=False, shared=False, bounds=False),
    "prefixes": Reuse(kept=False, unchanged=False, prefixes=True, shared=False, bounds=False),
    "the paper's": Reuse(kept=True, unchanged=False, prefixes=True, shared=False, bounds=False),
    "all": Reuse(),
}
SIZES = (3, 4, 5, 6)
SAMPLED = 10
PAPERS_SHARES = {4: 67, 5: 54, 6: 45}


def reuse_row(case: MapCase) -> Row:
    """Queries of adding the last robot to the others, which CARP has planned.

    The queries asked, by size of the neighbourhood and kinds of reuse, and those that each kind avoids.
    """
    asked: dict[str, dict[str, int]] = {}
    avoided: dict[str, dict[str, int]] = {}
    for setting, reuse in SETTINGS.items():
        fleet = PlannedFleet(instance_of(case))
        fleet.reuse = reuse
        asked[setting] = {}
        for m in (*SIZES, SAMPLED):
            carp(fleet, range(case.robots - 1))
            before = fleet.queries
            sample = 150 if m == SAMPLED else None
            add(fleet, case.robots - 1, 0, Neighbourhood(m, sample, case.assignment, baseline=False))
            after = fleet.queries
            asked[setting][str(m)] = after.asked - before.asked
            if setting == "all":
                avoided[str(m)] = {kind: getattr(after, kind) - getattr(before, kind) for kind in after.avoided}
    return {"asked": asked, "avoided": avoided}


@dataclass(frozen=True, slots=True)
class ReuseOf:
    """The queries of one size of neighbourhood, means over the cases.

    `asked` are the queries by kinds of reuse, and `avoided` those that each kind avoids if all are on. `last` is the
    share in per cent of the last round's queries for orders that is left if orders share their beginnings (the paper's
    second reduction). `replanned` is the share for the robots outside that is left if those before the one taken out
    keep their plans (the first reduction). With both reductions, `orders` queries are asked for orders and `outside`
    for robots outside.
    """

    m: int
    asked: dict[str, Interval]
    avoided: dict[str, Interval]
    last: Interval | None
    replanned: Interval
    orders: Interval
    outside: Interval


class ReuseRow(msgspec.Struct, frozen=True):
    """A stored row of the experiment."""

    asked: dict[str, dict[int, int]]
    avoided: dict[int, dict[str, int]]


def reuse_report(rows: Iterable[Row], robots: int) -> ExperimentReport:
    """One table of queries asked, one of those avoided."""
    measured = [msgspec.convert(row, ReuseRow, strict=False) for row in rows]
    summary = tuple(reuse_of(m, measured, robots) for m in (*SIZES[1:], SAMPLED))
    asked_columns = (
        "algorithm",
        *(f"reuse: {name}" for name in SETTINGS),
        "orders, left",
        "the paper",
        "outside, left",
    )
    asked_rows = []
    avoided_rows = []
    for each in summary:
        paper = f"{PAPERS_SHARES[each.m]} %" if each.m in PAPERS_SHARES else "-"
        cells = (f"{each.asked[name].estimate:.0f}" for name in SETTINGS)
        asked_rows.append((f"Proposed_{each.m}", *cells, percent(each.last), paper, percent(each.replanned)))
        counts = {kind: f"{count.estimate:.0f}" for kind, count in each.avoided.items()}
        avoided_rows.append((f"Proposed_{each.m}", *counts.values()))
    avoided_columns = ("algorithm", *summary[0].avoided)
    tables = (
        Table("reuse-asked", "Queries asked to add a robot", asked_columns, tuple(asked_rows), asked_columns[1:]),
        Table(
            "reuse-avoided",
            "Queries avoided by each kind of reuse, where all are on",
            avoided_columns,
            tuple(avoided_rows),
            avoided_columns[1:],
        ),
    )
    return ExperimentReport(summary, tables)


def reuse_of(m: int, rows: Sequence[ReuseRow], robots: int) -> ReuseOf:
    """The means for one size of neighbourhood."""
    asked = {name: mean_interval([row.asked[name][m] for row in rows]) for name in SETTINGS}
    avoided: dict[str, list[int]] = defaultdict(list)
    for row in rows:
        for kind, count in row.avoided[m].items():
            avoided[kind].append(count)
    last = mean_interval([last_round(row, m) for row in rows]) if m in PAPERS_SHARES else None
    everybody = sum(robots - 1 - turn for turn in range(1, m))  # queries for the robots outside, in all rounds
    left = [everybody - (row.asked["nothing"][m] - row.asked["kept"][m]) for row in rows]  # where some keep their plans
    return ReuseOf(
        m,
        asked,
        {kind: mean_interval(counts) for kind, counts in avoided.items()},
        last,
        replanned=mean_interval([100 * count / everybody for count in left]),
        orders=mean_interval([row.asked["the paper's"][m] - count for row, count in zip(rows, left, strict=True)]),
        outside=mean_interval(left),
    )


def last_round(row: ReuseRow, m: int) -> float:
    """The share of the last round's m times m! queries that is left, in per cent.

    The rounds before are those of a neighbourhood smaller by one, and what is asked of the robots outside is the same.
    """
    avoided = (row.asked["nothing"][m] - row.asked["prefixes"][m]) - (
        row.asked["nothing"][m - 1] - row.asked["prefixes"][m - 1]
    )
    return 100 * (1 - avoided / (m * factorial(m)))


def percent(share: Interval | None) -> str:
    """A share in per cent with its interval."""
    return "-" if share is None else f"{share:.1f} %"
