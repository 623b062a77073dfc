"""Optima, bounds and gaps, with the time that commands and ops give them; they need the extra `prove`.

Their time begins when the planner is compiled, which happens once.
"""

from collections.abc import Sequence
from pathlib import Path

from carp_optimum.gap import PLANNERS, Gap, gap
from carp_optimum.optimum import optimum as found
from carp_optimum.sat.core_guided import Optimum
from carp_spec import Instance, Planner, Refusal
from carp_spec.documents.bounds import BoundDocument
from carp_spec.inputs.options import MOST_PROCESSES, PROCESSES, SEARCH_SECONDS
from carp_spec.rule import is_between
from carp_spec.shapes import require_each
from carproof.engines import warm


def optimum(instance: Instance, limit: float = SEARCH_SECONDS, *, processes: int = PROCESSES) -> Optimum:
    """Search for the least total cost for at most `limit` seconds.

    The answer rests on the solver; `write_proof` writes a proof of it. Two `processes` are faster on two cores, and the
    answer is the same. Raises `Refusal` for a wrong limit, and if the formula outgrows the memory.
    """
    if not is_between(processes, 1, MOST_PROCESSES):
        message = f"it must be a whole number between 1 and {MOST_PROCESSES}, not {processes!r}"
        raise Refusal("option", "$.processes", "request/limit", message)
    warm()
    return found(instance, limit, processes=processes)


def bound(instance: Instance, seconds: float | None = None, steps: int | None = None) -> BoundDocument:
    """Search for a lower bound on the total cost, with a certificate that `verify_bound` checks.

    The search takes so many seconds or steps, whichever are over first, and 10 seconds if neither is given. With steps
    alone, the same instance gives the same certificate on one kind of processor. Raises `Refusal` for wrong limits and
    numbers that are too large.
    """
    from carp_optimum.bound import lower_bound  # noqa: PLC0415 - slow to load

    warm()
    return lower_bound(instance, seconds, steps)


def optimality_gap(instance: Instance, planners: Sequence[Planner] = PLANNERS, limit: float = SEARCH_SECONDS) -> Gap:
    """Plan with every planner, and search for the optimum and the best order, each for at most `limit` seconds.

    Raises `Refusal` as `plan` and `optimum` do.
    """
    require_each(planners, Planner, "$.planners")
    warm()
    return gap(instance, planners, limit)


def write_proof(instance: Instance, best: Optimum, directory: Path | str, limit: float = SEARCH_SECONDS) -> None:
    """Write a proof directory of an answer of `optimum`, which `verify_proof` checks.

    Raises `TimeOver` if that takes more than `limit` seconds, and `Refusal` if the search gave no answer.
    """
    from carp_optimum.sat import proving  # noqa: PLC0415 - only for those who ask for a proof

    proving.write_proof(instance, best, directory, limit)
