"""The planner's face: `query`, `plan`, `add`, the same as `carp_reference` has.

Importing it loads neither numpy nor numba; planning does.
"""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import TYPE_CHECKING

from carp_optimized.neighbourhood.reuse import Reuse
from carp_spec import (
    Carp,
    FixedPaths,
    Greedy,
    Instance,
    LongestFirst,
    Neighbourhood,
    Plan,
    Planner,
    Refusal,
    RobotId,
    Shuffled,
    Solution,
    Stop,
)
from carp_spec.inputs.options import require_planner, require_polish_options
from carp_spec.inputs.values import known, require_instance
from carp_spec.planners import BY_DEFAULT
from carp_spec.polish_rules import last_round
from carp_spec.requests import (
    about_stops,
    require_addition,
    require_assignment,
    require_query,
    require_tick,
    sound_solution,
)

if TYPE_CHECKING:
    from carp_optimized.certifying import Certifier
    from carp_optimized.fleet import PlannedFleet
    from carp_spec.execution.traces import Trace

PLANNERS = (Carp, Shuffled, LongestFirst, Greedy, Neighbourhood, FixedPaths)


def _fleet(instance: Instance, reuse: Reuse | None = None) -> "PlannedFleet":
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415 - numba is slow to load

    return PlannedFleet(instance, reuse)


def query(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
    """The plan of one robot with the earliest arrival against the committed plans, or `None` if none exists.

    A plan of the robot itself among those committed is what it has followed until the tick `now`.
    """
    require_query(instance, committed, robot, now)
    return find(instance, committed, robot, now)


def find(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
    """The same, beside plans that may be parts of plans; neither these nor the request are looked at."""
    own = [plan for plan in committed if plan.robot == robot]
    fleet = _fleet(instance)
    fleet.commit([plan for plan in committed if plan.robot != robot])
    return fleet.find(fleet.index(robot), own[-1] if own else None, now)


def certifier(instance: Instance) -> "Certifier":
    """A certifying planner with no committed plans yet."""
    from carp_optimized.certifying import Certifier  # noqa: PLC0415 - numba is slow to load

    require_instance(instance)
    return Certifier(instance)


def retime(instance: Instance, solution: Solution, trace: "Trace") -> Solution:
    """The plans for the rest of the way after a trace, in the same order and as early as possible."""
    from carp_optimized.execution.following import retime as compiled  # noqa: PLC0415 - numba is slow to load

    return compiled(instance, solution, trace)


def plan(
    instance: Instance,
    planner: Planner = BY_DEFAULT,
    advance: Callable[[], None] = lambda: None,
    reuse: Reuse | None = None,
) -> Solution:
    """Plan all robots of the instance at tick 0, by the neighbourhood planner if none is named.

    `advance` is called as each attempt or robot is done.

    Raises `Refusal` for a planner that only the reference has, and for numbers that are too large.
    """
    return plan_with_fleet(instance, planner, advance, reuse)[0]


def plan_with_fleet(
    instance: Instance, planner: Planner, advance: Callable[[], None], reuse: Reuse | None = None
) -> tuple[Solution, "PlannedFleet"]:
    """The same solution, and the fleet that made it, which answers further questions."""
    require_instance(instance)
    if not isinstance(planner, PLANNERS):
        names = ", ".join(each.__name__ for each in PLANNERS)
        message = (
            f"the optimised engine has no {planner!r}, only values of {names}; the reference engine has all planners"
        )
        raise Refusal("option", "$.planner", "planner/options", message)
    require_planner(planner)
    from carp_optimized.adding import add as add_robot  # noqa: PLC0415 - numba is slow to load
    from carp_optimized.fixed_paths import fixed_paths  # noqa: PLC0415 - numba is slow to load
    from carp_optimized.orderings import carp, greedy, shuffled  # noqa: PLC0415 - numba is slow to load

    fleet = _fleet(instance, reuse)
    everyone = range(len(instance.robots))
    match planner:
        case Carp():
            carp(fleet, everyone)
        case Shuffled():
            shuffled(fleet, planner, everyone, advance)
        case LongestFirst():
            carp(fleet, sorted(everyone, key=lambda robot: -fleet.ticks_to_goal(robot)))
        case Greedy():
            greedy(fleet, advance)
        case FixedPaths():
            fixed_paths(fleet, planner)
        case Neighbourhood():
            for robot in everyone:
                add_robot(fleet, robot, 0, planner)
                advance()
    return known(instance, Solution.of(instance, fleet.plans)), fleet


def steps(instance: Instance, planner: Planner) -> int:
    """The most calls of `advance` by `plan`."""
    return planner.attempts if isinstance(planner, Shuffled) else len(instance.robots)


def add(
    instance: Instance,
    solution: Solution,
    robot: RobotId,
    now: int = 0,
    options: Neighbourhood = BY_DEFAULT,
    reuse: Reuse | None = None,
) -> Solution:
    """Add a robot of the instance to a solution of the others at the tick `now`.

    If no plan is found, the robot is unplanned and all other plans stay as they are.
    """
    from carp_optimized.adding import add as add_robot  # noqa: PLC0415 - numba is slow to load

    require_addition(instance, solution, robot, now, options)
    fleet = _fleet(instance, reuse)
    fleet.commit_solution(solution)
    add_robot(fleet, fleet.index(robot), now, options)
    order = tuple(each.robot for each in fleet.plans)
    missing = {*solution.unplanned, robot}.difference(order)
    return known(instance, Solution(fleet.plans, order, tuple(each for each in instance.robot if each in missing)))


def assign(
    instance: Instance,
    solution: Solution,
    robot: RobotId,
    stops: Sequence[Stop],
    now: int = 0,
    options: Neighbourhood = BY_DEFAULT,
) -> tuple[Instance, Solution]:
    """Give a robot that is under way or parked further stops at the tick `now`, behind those that it has.

    It is planned again together with robots near it, as by `add`; all keep what they have done by now. Returns the
    instance with its stops, and the plans; if no plan is found, both as they were. Raises `Refusal` for stops that
    break `instance/stops`, for a robot that has left, and for a solution that breaks a rule.
    """
    from carp_optimized.adding import add as add_robot  # noqa: PLC0415 - numba is slow to load

    further = require_assignment(instance, solution, robot, stops, now, options)
    by_robot = {each.robot: each for each in solution.plans}
    with about_stops([*further.robot].index(robot)):
        fleet = _fleet(further)
    fleet.commit([by_robot[each] for each in solution.order if each != robot])
    if not add_robot(fleet, fleet.index(robot), now, options, before=by_robot[robot]):
        return instance, solution
    order = tuple(each.robot for each in fleet.plans)
    return further, known(further, Solution(fleet.plans, order, solution.unplanned))


def polish(
    instance: Instance,
    solution: Solution,
    *,
    iterations: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    now: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """Improve a solution for that many rounds or seconds; `advance` gets rounds, unplanned robots and total.

    It ends earlier if no plan can be shorter. Robots keep what they have done by the tick `now`; after tick 0, those
    without a plan get none. Equal iterations and seed give an equal solution. The time is looked at between calls of
    `advance`, at most 50 rounds apart.
    Raises `Refusal` for wrong options, for a solution that breaks a rule, and for numbers that are too large.
    """
    started = perf_counter()
    require_polish_options(iterations, seconds, seed)
    require_tick(now)
    whole = sound_solution(instance, solution)
    last = last_round(iterations, seconds)
    return polish_while(
        instance, whole, lambda: seconds is None or perf_counter() - started < seconds, last, seed, now, advance
    )


def polish_while(
    instance: Instance,
    whole: Solution,
    goes_on: Callable[[], bool],
    last: int | None,
    seed: int,
    now: int = 0,
    advance: Callable[[int, int, int], None] = lambda _, __, ___: None,
) -> Solution:
    """The same for sound input, as long as it goes on, up to the last round, if there is one."""
    from carp_optimized.polishing import polish_fleet  # noqa: PLC0415 - numba is slow to load

    fleet = _fleet(instance)
    fleet.commit_solution(whole)
    polish_fleet(fleet, goes_on, last, seed, now, advance)
    return known(instance, Solution.of(instance, fleet.plans))
