"""The planners to choose from, each loaded when it is first used."""

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Protocol, cast

from carp_spec import Instance, Neighbourhood, Plan, Planner, Refusal, RobotId, Solution, total_cost
from carp_spec.query_certificates import QueryCertificateDocument
from carp_spec.traces import Trace
from carproof.progress import progress

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

    def certifier(self, instance: Instance) -> Certifier:
        """A certifying planner with no committed plans yet."""

    def plan(self, instance: Instance, planner: Planner) -> Solution:
        """Plans of all robots."""

    def add(self, instance: Instance, solution: Solution, robot: RobotId, now: int, options: Neighbourhood) -> Solution:
        """Plans with one robot more."""

    def polish(
        self,
        instance: Instance,
        solution: Solution,
        *,
        iterations: int | None = None,
        seconds: float | None = None,
        seed: int = 0,
        advance: Callable[[int, int, int], None] = ...,
    ) -> Solution:
        """Better plans; `advance` gets rounds, unplanned robots and total."""

    def retime(self, instance: Instance, solution: Solution, trace: Trace) -> Solution:
        """The plans for the rest of the way after a trace, in the same order."""


class FastestEngine:
    """The optimised engine, and the reference for planners that it does not have."""

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - a function of an engine
        """Load the optimised engine when it is first used."""
        return getattr(engine_named("optimized"), name)

    def plan(self, instance: Instance, planner: Planner) -> Solution:
        """Plans of all robots."""
        return engine_named(_fastest_with(planner)).plan(instance, planner)


def engine_named(name: str | None) -> Engine:
    """Load an engine; without a name, the fastest that has the planner."""
    return cast("Engine", FastestEngine() if name is None else import_module(f"carp_{name}"))


def warm() -> bool:
    """Compile the planner and, if its libraries are installed, the search for bounds; returns whether that was needed.

    This is one step, which is announced on standard error. Commands with a time limit do it before the limit starts.
    """
    package = "carp_optimized" if find_spec("pysat") is None else "carp_optimum"
    compile_all = import_module(f"{package}.__main__").compile_all
    from carp_optimized.compiling import is_compiled  # noqa: PLC0415 - loaded when it is first used

    if is_compiled():
        return False
    compile_all()
    return True


def plan_showing(label: str, engine: str | None, instance: Instance, planner: Planner) -> Solution:
    """Plans of all robots; if the optimised planner makes them, a terminal shows its progress."""
    if (engine or _fastest_with(planner)) == "reference":
        return engine_named("reference").plan(instance, planner)
    from carp_optimized import plan, steps  # noqa: PLC0415 - loaded when it is first used

    with progress(label, steps(instance, planner)) as advance:
        return plan(instance, planner, advance)


def _fastest_with(planner: Planner) -> str:
    from carp_optimized import PLANNERS as COMPILED  # noqa: PLC0415 - loaded when it is first used

    return "optimized" if isinstance(planner, COMPILED) else "reference"


def sum_of_shortest_paths(instance: Instance, robots: Iterable[RobotId]) -> int:
    """The sum of the robots' costs if each were alone; a robot without a path adds nothing."""
    from carp_optimized import sum_of_shortest_paths as fast  # noqa: PLC0415 - loaded when it is first used

    asked = tuple(robots)
    try:
        return fast(instance, asked)
    except Refusal:  # numbers that only the reference holds
        alone = (engine_named("reference").query(instance, (), robot) for robot in asked)
        return total_cost(instance, [plan for plan in alone if plan is not None])


def have_plans_beside(
    instance: Instance, committed: Sequence[Plan], robots: Sequence[RobotId], now: int
) -> Sequence[bool]:
    """Whether each of some robots has a plan against committed plans of others, whatever the size of the numbers."""
    try:
        certifier = engine_named("optimized").certifier(instance)
        certifier.commit(committed)
    except Refusal:  # numbers that only the reference holds
        certifier = engine_named("reference").certifier(instance)
        certifier.commit(committed)
    return [certifier.certify(robot, None, now)[0] is not None for robot in robots]
