"""The planners to choose from, each loaded when it is first used."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Protocol, cast

from carp_spec import Instance, Neighbourhood, Plan, Planner, Refusal, RobotId, Solution, Stop, plan_cost
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.execution.traces import Trace
from carproof.progress import progress

if TYPE_CHECKING:
    from carp_optimized.fleet import PlannedFleet

ENGINES = ("optimized", "reference")


class Certifier(Protocol):
    """Plans robots one by one beside plans that are committed, each with its certificate."""

    def commit(self, plans: Sequence[Plan]) -> None:
        """Add plans that break no rule together with those committed."""

    def certify(
        self, robot: RobotId, followed: Plan | None = None, now: int = 0
    ) -> tuple[Plan | None, QueryCertificateDocument]:
        """The plan of a robot that arrives earliest, `None` if it has none, and its certificate."""


class Engine(Protocol):
    """The functions that `carp_reference` and `carp_optimized` both have."""

    def query(self, instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
        """The plan of one robot against committed plans."""

    def find(self, instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
        """The same beside parts of plans, which are not looked at."""

    def certifier(self, instance: Instance) -> Certifier:
        """A certifying planner with no committed plans yet."""

    def plan(self, instance: Instance, planner: Planner) -> Solution:
        """Plans of all robots."""

    def add(self, instance: Instance, solution: Solution, robot: RobotId, now: int, options: Neighbourhood) -> Solution:
        """Plans with one robot more."""

    def assign(
        self,
        instance: Instance,
        solution: Solution,
        robot: RobotId,
        stops: Sequence[Stop],
        now: int,
        options: Neighbourhood,
    ) -> tuple[Instance, Solution]:
        """The instance with further stops of a robot, and the plans; both as they were if no plan is found."""

    @property
    def polish(self) -> Callable[..., Solution]:
        """Better plans: see `carproof.polish`."""

    def retime(self, instance: Instance, solution: Solution, trace: Trace) -> Solution:
        """The plans for the rest of the way after a trace, in the same order."""


class FastestEngine:
    """The optimised engine, and the reference for planners that it does not have."""

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - a function of an engine
        """Load the optimised engine when it is first used."""
        return getattr(engine_named("optimized"), name)

    def plan(self, instance: Instance, planner: Planner) -> Solution:
        """Plans of all robots."""
        return engine_named(fastest_with(planner)).plan(instance, planner)

    @property
    def polish(self) -> Callable[..., Solution]:
        """Better plans; with `seconds`, by simulated annealing."""
        compile_what_is_kept()
        from carp_optimized.improve.annealing import polish_or_anneal  # noqa: PLC0415 - loaded when it is first used

        return polish_or_anneal


def engine_named(name: str | None) -> Engine:
    """Load an engine, compiled if it is to be; without a name, the fastest that has the planner."""
    if name == "optimized":
        compile_what_is_kept()
    return cast("Engine", FastestEngine() if name is None else import_module(f"carp_{name}"))


def warm() -> bool:
    """Compile the planner and, if its libraries are installed, the search for bounds; returns whether that was needed.

    This is one step, which is announced on standard error. Commands with a time limit do it before the limit starts.
    """
    from carp_optimized.jit import compiling  # noqa: PLC0415 - loaded when it is first used

    package = "carp_optimized" if find_spec("pysat") is None else "carp_optimum"
    if compiling.is_compiled(package):
        return False
    compile_all = import_module(f"{package}.__main__").compile_all
    was_needed = False
    with progress("compiling", compiling.to_compile()) as show:

        def advance() -> None:
            nonlocal was_needed
            was_needed = True
            show()

        with compiling.watched(advance):
            compile_all()
    return was_needed


def compile_what_is_kept() -> None:
    """Compile everything in one step where it is kept; elsewhere each process compiles what it calls."""
    from carp_optimized.jit.compiling import is_kept  # noqa: PLC0415 - loaded when it is first used

    if is_kept():
        warm()


def fastest_with(planner: Planner) -> str:
    """The fastest engine that has the planner."""
    from carp_optimized import PLANNERS as COMPILED  # noqa: PLC0415 - loaded when it is first used

    return "optimized" if isinstance(planner, COMPILED) else "reference"


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


def repairs_by_default(planner: Planner) -> bool:
    """Whether robots that the planner leaves out are repaired where nobody says: not after planners of the literature.

    The neighbourhood planner is one of them without its baseline, as the paper has it.
    """
    return isinstance(planner, Neighbourhood) and planner.baseline


def repaired(instance: Instance, solution: Solution) -> Solution:
    """The solution with plans of the robots left out, if they are found; others may get new plans."""
    if solution.unplanned:
        from carp_optimized.improve.repair import repair  # noqa: PLC0415 - numba is slow to load

        compile_what_is_kept()
        with suppress(Refusal):  # numbers that only the reference holds
            return repair(instance, solution)
    return solution


def sum_of_shortest_paths(instance: Instance, robots: Iterable[RobotId], fleet: "PlannedFleet | None" = None) -> int:
    """The sum of the robots' costs if each were alone; a robot without a path adds nothing.

    A compiled fleet of the instance, if there is one, knows most of them.
    """
    return sum(shortest_paths(instance, robots, fleet))


def shortest_paths(instance: Instance, robots: Iterable[RobotId], fleet: "PlannedFleet | None" = None) -> Iterator[int]:
    """The robots' costs if each were alone, one after the other; 0 of a robot without a path."""
    with suppress(Refusal):  # numbers that only the reference holds
        fleet = fleet or fleet_of(instance, ())
    for robot in robots:
        try:
            found = None if fleet is None else fleet.ticks_to_goal(fleet.index(robot))
        except Refusal:
            found = None
        if found is None:
            plan = engine_named("reference").query(instance, (), robot)
            found = 0 if plan is None else plan_cost(instance, plan)
        yield found


def have_plans_beside(
    instance: Instance,
    committed: Sequence[Plan],
    robots: Sequence[RobotId],
    now: int,
    fleet: "PlannedFleet | None" = None,
) -> Sequence[bool]:
    """Whether each of some robots has a plan against committed plans of others, which the fleet holds if one is given.

    The numbers may have any size.
    """
    try:
        beside = fleet or fleet_of(instance, committed)
        return [beside.find(beside.index(robot), None, now) is not None for robot in robots]
    except Refusal:  # numbers that only the reference holds
        query = engine_named("reference").query
        return [query(instance, committed, robot, now) is not None for robot in robots]


def fleet_of(instance: Instance, plans: Sequence[Plan]) -> "PlannedFleet":
    """The compiled fleet of an instance with these plans, in planning order."""
    compile_what_is_kept()
    from carp_optimized.fleet import PlannedFleet  # noqa: PLC0415 - numba is slow to load

    fleet = PlannedFleet(instance)
    fleet.commit(plans)
    return fleet
