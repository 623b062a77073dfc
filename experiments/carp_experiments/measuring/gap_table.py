"""The tables of certified gaps in docs/results/gaps.md and bounds.md; `make gap-figures` makes them again.

A gap is that of the best plans found above the bound found, both on the paper's maps. Where the optimum is found too,
it splits the gap: the plans' part is above the optimum, and the bound's part below it. Plans and bound have the same
seconds of processor time each, so other work on the machine takes nothing from them.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from time import process_time, process_time_ns

from carp_experiments.statistics import mean_interval
from carp_optimized import plan
from carp_optimized.improve.annealing import anneal
from carp_optimum.bound import lower_bound
from carp_optimum.optimum import optimum
from carp_spec import Instance, total_cost
from carp_verify.bound.rules import require_kept
from carp_verify.bound.verify import verify_bound
from carproof.generate import Fleet, Grid, grid_instance
from carproof.markdown import markdown_table, write_section
from carproof.progress import progress

GAP_COLUMNS = ("map", "seeds", "plans of all", "bound", "gap", "worst gap")
SPLIT_COLUMNS = ("map", "robots", "optimum found", "plans above it", "bound below it", "proved")


@dataclass(frozen=True, slots=True)
class Task:
    """Assignments of a map: seconds for the plans and for the bound each, and for the optimum if that is wanted."""

    map: int
    robots: int
    seeds: int
    seconds: float
    limit: float = 0

    def instance(self, seed: int) -> Instance:
        """The assignment of a seed, from 1."""
        return grid_instance(Grid(map=self.map), Fleet(robots=self.robots, seed=seed))


@dataclass(frozen=True, slots=True)
class Found:
    """Totals; `plans` is `None` where robots are left out, `optimum` where it is not found."""

    shortest: int
    bound: int
    plans: int | None
    optimum: int | None


GAPS = tuple(Task(map, 100, 20, 60) for map in (20, 15, 10, 5, 0))
SPLITS = tuple(Task(map, robots, 10, 10, limit=30) for map, robots in ((20, 100), (15, 80), (10, 50), (5, 30), (0, 15)))


def measure(task: Task, seed: int, advance: Callable[[], None] = lambda: None) -> Found:
    """Plan and bound one assignment; the bound is verified."""
    instance = task.instance(seed)
    better = anneal(instance, plan(instance), task.seconds, seed=seed, clock=process_time)
    certificate = lower_bound(instance, seconds=task.seconds, clock=process_time_ns)
    bound = verify_bound(instance, certificate)
    total = None if better.unplanned else total_cost(instance, better.plans)
    require_kept(bound, total or bound)
    best = optimum(instance, task.limit) if task.limit else None
    least = best.cost if best is not None and best.decided else None
    advance()
    return Found(lower_bound(instance, steps=0).bound, bound, total, least)


def per_cent(more: int, less: int) -> float:
    """How much more one total is than the other."""
    return 100 * (more - less) / less


def gap_row(task: Task, found: Sequence[Found]) -> Sequence[str]:
    """A row of the gaps."""
    gaps = [per_cent(each.plans, each.bound) for each in found if each.plans is not None]
    raised = [per_cent(each.bound, each.shortest) for each in found]
    shown = (f"{mean_interval(gaps):.2f}", f"{max(gaps):.2f}") if gaps else ("-", "-")
    return (str(task.map), str(len(found)), f"{len(gaps)}/{len(found)}", f"{mean_interval(raised):.2f}", *shown)


def split_row(task: Task, found: Sequence[Found]) -> Sequence[str]:
    """A row of the gaps' parts, over the assignments whose optimum is found."""
    known = [(each.plans or each.optimum, each.optimum, each.bound) for each in found if each.optimum is not None]
    above = [per_cent(plans, least) for plans, least, _ in known]
    below = [per_cent(least, bound) for _, least, bound in known]
    proved = sum(least == bound for _, least, bound in known)
    shown = (f"{mean_interval(above):.2f}", f"{mean_interval(below):.2f}", str(proved)) if known else ("-", "-", "-")
    return (str(task.map), str(task.robots), f"{len(known)}/{len(found)}", *shown)


def gap_tables(gaps: Sequence[Task], splits: Sequence[Task]) -> tuple[str, str]:
    """Measure all, and lay the gaps and their parts out in Markdown."""
    with progress("measuring gaps", sum(task.seeds for task in chain(gaps, splits))) as advance:

        def rows(tasks: Sequence[Task], row: Callable[[Task, Sequence[Found]], Sequence[str]]) -> list[Sequence[str]]:
            return [row(task, [measure(task, seed, advance) for seed in range(1, task.seeds + 1)]) for task in tasks]

        of_gaps = markdown_table(GAP_COLUMNS, rows(gaps, gap_row), numbers=GAP_COLUMNS)
        return of_gaps, markdown_table(SPLIT_COLUMNS, rows(splits, split_row), numbers=SPLIT_COLUMNS)


def quick(task: Task) -> Task:
    """The task on one assignment, with few seconds."""
    return replace(task, seeds=1, seconds=2, limit=min(task.limit, 2))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="print the tables of one assignment and few seconds")
    parser.add_argument("--seeds", type=int, help="measure at most this many assignments a map")
    chosen = parser.parse_args()
    if chosen.quick:
        sys.stdout.write("\n".join(gap_tables([*map(quick, GAPS)], [*map(quick, SPLITS)])))
    else:
        results = Path(__file__).parents[3] / "docs" / "results"
        most = chosen.seeds or sys.maxsize
        fewer = ([replace(task, seeds=min(task.seeds, most)) for task in tasks] for tasks in (GAPS, SPLITS))
        tables = gap_tables(*fewer)
        for page, name, table in zip(("gaps", "bounds"), ("gap table", "split table"), tables, strict=True):
            write_section(results / f"{page}.md", name, table)
