"""The planners to choose from, each loaded when it is first used."""

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Protocol, cast

from carp_spec import Instance, Neighbourhood, Plan, Planner, RobotId, Solution, plan_cost

ENGINES = ("reference", "optimized")
DEFAULT_ENGINE = "reference"


class Engine(Protocol):
    """What `carp_reference` and `carp_optimized` both have."""

    def query(self, instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> Plan | None:
        """The plan of one robot against committed plans."""

    def plan(self, instance: Instance, planner: Planner, advance: Callable[[], None] = ...) -> Solution:
        """Plans of all robots; `advance` is called at each step."""

    def steps(self, instance: Instance, planner: Planner) -> int:
        """How many steps `plan` takes at most."""

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
        """Better plans; `advance` is told rounds, unplanned robots and total."""


def engine_named(name: str) -> Engine:
    """Load an engine."""
    return cast("Engine", import_module(f"carp_{name}"))


def shortest_path_cost(instance: Instance, robot: RobotId) -> int | None:
    """The cost of a robot's plan if it were alone, or `None` if it has no path."""
    alone = engine_named("reference").query(instance, (), robot)
    return None if alone is None else plan_cost(instance, alone)


def why_unplanned(instance: Instance, committed: Sequence[Plan], robot: RobotId, now: int = 0) -> str:
    """Why a robot finds no plan against committed plans of others."""
    from carp_reference import why_unplanned as why  # noqa: PLC0415 - a command that plans nothing need not load it

    return why(instance, committed, robot, now)
