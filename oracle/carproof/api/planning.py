"""Plans of all robots by any planner, and plans of one robot with their certificates."""

from collections.abc import Callable, Sequence
from time import perf_counter

from carp_spec import Instance, Plan, Planner, RobotId, Solution
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.planners import BY_DEFAULT
from carp_spec.requests import require_query
from carp_spec.shapes import require_shape
from carproof.engines import engine_named, repaired, repairs_by_default, warm


def plan(instance: Instance, planner: Planner | None = None, *, repair: bool | None = None) -> Solution:
    """Plan all robots of the instance at tick 0, by the neighbourhood planner if none is named.

    With `repair`, robots that the planner leaves out are planned together with others; `None` repairs after the
    neighbourhood planner with its baseline. Raises `Refusal` for a malformed instance or planner, and for numbers that
    are too large.
    """
    require_shape(repair, bool | None, "$.repair")
    chosen = BY_DEFAULT if planner is None else planner
    solution = engine_named(None).plan(instance, chosen)
    return repaired(instance, solution) if (repairs_by_default(chosen) if repair is None else repair) else solution


def plan_within(
    instance: Instance,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
    clock: Callable[[], float] = perf_counter,
) -> Solution:
    """The best plans that are found in that many seconds, 10 unless given; `advance` gets rounds, unplanned and total.

    With `iterations`, first plans are improved by that many rounds: equal iterations and seed give an equal solution
    on every machine. With seconds they need not. Robots that have no plan when the time is over are unplanned. The
    time, that of `clock`, begins when the planner is compiled, which happens once. Raises `Refusal` for a malformed
    instance, wrong options, and numbers that are too large.
    """
    warm()
    from carp_optimized.improve import anytime  # noqa: PLC0415 - numba is slow to load

    found = anytime.plan_within(
        instance, iterations=iterations, seconds=seconds, seed=seed, advance=advance, clock=clock
    )
    return found.solution


def certified_query(
    instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0
) -> tuple[Plan | None, QueryCertificateDocument]:
    """The plan that `query` finds, and a certificate that no plan arrives earlier, which `verify_query` checks.

    Raises what `query` raises.
    """
    require_query(instance, committed, robot, now)
    own = [each for each in committed if each.robot == robot]
    certifier = engine_named(None).certifier(instance)
    certifier.commit([each for each in committed if each.robot != robot])
    return certifier.certify(robot, own[-1] if own else None, now)


def polish(  # noqa: PLR0913 - how long, how, and when
    instance: Instance,
    solution: Solution,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    now: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """Improve a solution by large neighbourhood search; `advance` gets rounds, unplanned robots and total.

    With `seconds`, robots without a plan are planned first, in at most half of the time, and rounds may raise the total
    for a while (simulated annealing); the best plans seen are the result. Otherwise `iterations` rounds of `polish/...`
    are played, 10,000 unless given. They never raise the total, and equal iterations and seed give an equal solution.
    Robots keep what they have done by the tick `now`; after tick 0, those without a plan get none. Raises `Refusal` for
    wrong options, for a solution that breaks a rule, and for numbers that are too large.
    """
    polished = engine_named(None).polish
    return polished(instance, solution, iterations=iterations, seconds=seconds, seed=seed, now=now, advance=advance)
