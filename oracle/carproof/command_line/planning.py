"""Planning while a terminal shows the progress."""

from typing import TYPE_CHECKING

from carp_spec import Instance, Planner, Solution
from carproof.engines import compile_what_is_kept, engine_named, fastest_with
from carproof.progress import progress

if TYPE_CHECKING:
    from carp_optimized.fleet import PlannedFleet


def plan_showing(
    label: str, engine: str | None, instance: Instance, planner: Planner
) -> tuple[Solution, "PlannedFleet | None"]:
    """Plans of all robots; if the optimised planner makes them, with its fleet, and a terminal shows its progress."""
    if (engine or fastest_with(planner)) == "reference":
        return engine_named("reference").plan(instance, planner), None
    compile_what_is_kept()
    from carp_optimized.planners import plan_with_fleet, steps  # noqa: PLC0415 - loaded when it is first used

    with progress(label, steps(instance, planner)) as advance:
        return plan_with_fleet(instance, planner, advance)
