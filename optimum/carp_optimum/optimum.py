"""The least total cost of plans for all robots: a core-guided search, and beside it one for bounds and plans.

The core-guided search (`carp_optimum.sat.core_guided`) decides most instances. After many conflicts a second search,
for plans and for a lower bound (`carp_optimum.narrowing`), begins in the background (`carp_optimum.background`). For
a dense instance the first search instead takes half of the parts of a search by branching, and the other process the
other half.
"""

from collections.abc import Callable
from functools import partial
from time import monotonic_ns

from carp_optimum.background import BackgroundSearch
from carp_optimum.narrowing import half_narrowed, narrowed
from carp_optimum.sat.between import Between
from carp_optimum.sat.core_guided import CoreGuided, Optimum, core_guided
from carp_spec import Instance
from carp_spec.inputs.options import PROCESSES, SEARCH_SECONDS

WORK_OF_WAITING = 1_000_000
"""The work after which it is asked for what was found in the other half of a crowd, once this one has ended."""


def optimum(
    instance: Instance,
    limit: float = SEARCH_SECONDS,
    clock: Callable[[], int] = monotonic_ns,
    *,
    processes: int = PROCESSES,
) -> Optimum:
    """Search for the optimum for at most `limit` seconds. Raises `Refusal` if the formula outgrows the memory.

    A long search continues with prices, where the compiled search for them is at hand; with two `processes` that has
    one of its own.

    Before the limit, the result depends neither on the clock, which gives nanoseconds, nor on the processes: the same
    instance gives the same solution on one kind of processor.
    """
    return core_guided(instance, limit, clock, partial(_start_beside, own_process=processes > 1))


def _start_beside(search: CoreGuided, *, own_process: bool) -> None:
    """Start the search beside where the compiled search for prices is at hand; a crowd is searched by halves."""
    from carp_optimized.jit.compiling import is_cached  # noqa: PLC0415 - slow to load
    from carp_optimum.branching.bounds import bound_part  # noqa: PLC0415
    from carp_optimum.branching.branching import is_crowded  # noqa: PLC0415
    from carp_optimum.lagrangian.priced_paths import find_ways  # noqa: PLC0415

    if not (is_cached(find_ways) and is_cached(bound_part)):
        return
    if is_crowded(search.instance):
        _search_halves(search, own_process)
    if not search.is_met:
        search.work_before = search.solver.work
        search.beside = BackgroundSearch(partial(narrowed, search.instance), search.look, own_process=own_process)


def _search_halves(search: CoreGuided, own_process: bool) -> None:
    """Search one half of a crowd here and the other one beside, until bound and plans meet or both have ended."""
    instance = search.instance
    search.here = Between(instance)
    search.beside = BackgroundSearch(partial(half_narrowed, instance, half=1), search.look, own_process=own_process)
    work = 0
    for work, found in half_narrowed(instance, search.look, half=0):
        search.here = found
        search.take(search.beside.result(work))
        if search.is_met:
            break
    while not (search.is_met or search.beside.has_ended):
        work += WORK_OF_WAITING
        search.take(search.beside.result(work))
    search.beside.close()
    search.here = search.beside = None
