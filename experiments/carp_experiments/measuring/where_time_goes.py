"""Where the time goes, for 100, 1,000 and 10,000 robots that park on full grids: a row each for what a person does.

`make profile-figures` puts the table into docs/results/profile.md: processor seconds, and for `plan_within` the shares
of its phases. Its time is processor time too, so that a busy machine changes little.
"""

from collections.abc import Callable
from cProfile import Profile
from os import times
from pathlib import Path
from pstats import Stats
from resource import RUSAGE_SELF, getrusage
from time import process_time
from typing import TypeVar

import carproof
from carproof.generate import Fleet, Grid, grid_instance
from carproof.markdown import markdown_table, write_section

Result = TypeVar("Result")

SIDES = {100: 20, 1000: 64, 10_000: 200}
"""Of the grids, by the number of robots."""
SECONDS = 10
PHASES = {
    "distances": "_with_distances",
    "LaCAM": "_searched",
    "guides": "guides_of",
    "prioritized planning": "planned_in_order",
    "rounds": "improved",
    "check": "require_lawful",
    "plans as a solution": "solution_along",
}
"""The functions of `plan_within` whose shares are shown."""


def instance_of(robots: int) -> carproof.Instance:
    """Robots that park, on a full grid."""
    side = SIDES[robots]
    return grid_instance(Grid(side, side), Fleet(robots, seed=0, after_goal="park"))


def rows_of(robots: int) -> dict[str, str]:
    """What each action takes, in processor seconds, the shares of `plan_within`, and the memory of the process."""
    rows: dict[str, str] = {}

    def timed(name: str, action: Callable[[], Result]) -> Result:
        started = sum(times()[:2])
        result = action()
        rows[name] = f"{sum(times()[:2]) - started:.2f}"
        return result

    made = instance_of(robots)
    data = timed("write the instance", lambda: carproof.write_instance(made))
    instance = timed("read the instance", lambda: carproof.read_instance(data))
    timed("a pass of CARP", lambda: carproof.plan(instance, carproof.Carp(), repair=False))
    profile = Profile(builtins=False)
    found = profile.runcall(carproof.plan_within, instance, seconds=SECONDS, clock=process_time)
    rows |= {f"plan: {name}": share for name, share in shares_of(profile).items()}
    text = timed("write the plans", lambda: carproof.write_solution(found))
    plans = timed("read the plans", lambda: carproof.read_solution(text))
    timed("check", lambda: carproof.check(instance, plans))
    timed("view", lambda: carproof.view(instance, plans))
    rows["visits"] = f"{sum(len(plan.visits) for plan in plans.plans):,}"
    rows["most memory so far, MiB"] = f"{getrusage(RUSAGE_SELF).ru_maxrss >> 10:,}"
    return rows


def shares_of(profile: Profile) -> dict[str, str]:
    """The share of each phase in the time that was profiled."""
    stats = Stats(profile)
    spent = dict.fromkeys(PHASES.values(), 0.0)
    for (_, _, name), (_, _, _, cumulative, _) in stats.stats.items():  # type: ignore[attr-defined]
        if name in spent:
            spent[name] += cumulative
    whole = stats.total_tt  # type: ignore[attr-defined]
    return {phase: f"{100 * spent[name] / whole:.0f} %" for phase, name in PHASES.items()}


def profile_table() -> str:
    """The table, a column for each number of robots."""
    carproof.plan(instance_of(100))  # so that nothing is compiled in what is timed
    carproof.plan_within(instance_of(100), seconds=1)
    columns = {robots: rows_of(robots) for robots in SIDES}
    heads = ["", *(f"{robots:,} on {side} x {side}" for robots, side in SIDES.items())]
    return markdown_table(
        heads, [[name, *(columns[robots][name] for robots in SIDES)] for name in columns[100]], heads[1:]
    )


if __name__ == "__main__":
    page = Path(__file__).parents[3] / "docs" / "results" / "profile.md"
    write_section(page, "profile table", profile_table())
