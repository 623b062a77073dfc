"""Pictures of solutions."""

from carp_spec import Instance, Solution
from carp_spec.execution.traces import Trace
from carproof.viewer.page import page
from carproof.viewer.stills import chart_still, map_still

TITLE = "carproof"


def view(
    instance: Instance, solution: Solution | None = None, *, title: str = TITLE, trace: Trace | None = None
) -> bytes:
    """One HTML file that shows a solution, or starts and goals alone; with a trace, also what has happened.

    Raises `Refusal` for malformed input, and for what is too large to show.
    """
    return page(instance, solution, title, trace)


def view_map(instance: Instance, solution: Solution | None = None, *, at: int = 0, title: str = TITLE) -> bytes:
    """An SVG file of the map at a tick, or without a solution of starts and goals. Raises as `view` does."""
    return map_still(instance, solution, at, title)


def view_chart(instance: Instance, solution: Solution, *, title: str = TITLE) -> bytes:
    """An SVG file of resources by time. Raises as `view` does."""
    return chart_still(instance, solution, title)
