"""A case: one question to a program. It holds nothing of the answer."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from carp_spec import (
    Carp,
    Instance,
    Neighbourhood,
    Plan,
    Planner,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
)
from carp_spec.shapes import Number, numbers_of
from carproof.engines import Engine, engine_named
from carproof.protocol.ops import OPS
from carproof.protocol.ops.op import PolishOptions

ASKED_OPS = ("check", "query", "plan", "add", "polish", "optimum", "bound")
"""The ops of the table that programs are asked."""
EXECUTION = "execute"
"""The op of an execution, through which an executor is led by many requests `drive`."""
Stage: TypeAlias = Literal["saved", "smoke", "vectors", "random", "large"]
OPTIMUM_SECONDS = 60
"""A search for the optimum of a small case takes less, also on a machine that is busy."""
BOUND_STEPS = 100
POLISH_ROUNDS = 30
NO_PLANS = Solution((), ())
MOST_ROBOTS, MOST_RESOURCES = 8, 24
"""Of a small instance, about which the reference is asked."""


@dataclass(frozen=True, slots=True)
class NumberOf:
    """A number of the robots or of the resources of an instance."""

    kind: type[Robot | Resource]
    name: str
    number: Number

    def parts(self, instance: Instance) -> Sequence[Robot | Resource]:
        """The robots or the resources."""
        return instance.robots if self.kind is Robot else instance.graph.resources

    def values(self, instance: Instance) -> Mapping[ResourceId, int]:
        """The number of each that has more than the least."""
        values = ((each.id, getattr(each, self.name)) for each in self.parts(instance))
        return {id: value for id, value in values if value > self.number.least}


NUMBERS = tuple(NumberOf(kind, *each) for kind in (Robot, Resource) for each in numbers_of(kind).items())


@dataclass(frozen=True, slots=True)
class Case:
    """A question: an op of the protocol with its fields.

    A planner of `None` for `plan` leaves the choice to the program; programs that only plan whole instances are asked
    this. A `classical` question is answered in a format of classical planners, which does not have the order of the
    plans. The `delays` of an execution are [robot, position of the visit, ticks].
    """

    stage: Stage
    name: str
    op: str
    instance: Instance
    solution: Solution = NO_PLANS
    robot: RobotId | None = None
    now: int = 0
    planner: Planner | None = None
    classical: bool = False
    delays: tuple[tuple[RobotId, int, int], ...] = ()

    @property
    def size(self) -> tuple[int, ...]:
        """The size of the question, by which the smallest failure is chosen."""
        graph = self.instance.graph
        visits = sum(len(plan.visits) for plan in self.solution.plans)
        late = sum(ticks for _, _, ticks in self.delays)
        return (len(self.instance.robots), len(graph.resources), len(graph.edges), visits, len(self.delays), late)

    @property
    def asked_robot(self) -> RobotId:
        """The robot of a question about one."""
        assert self.robot is not None  # noqa: S101 - a promise of ours
        return self.robot

    @property
    def others(self) -> list[Plan]:
        """The plans of the other robots."""
        return [plan for plan in self.solution.plans if plan.robot != self.robot]

    @property
    def options(self) -> Neighbourhood:
        """The options of `add`."""
        return self.planner if isinstance(self.planner, Neighbourhood) else Neighbourhood()


def is_large(instance: Instance) -> bool:
    """Whether the reference would take long."""
    return len(instance.robots) > MOST_ROBOTS or len(instance.graph.resources) > MOST_RESOURCES


def renamed(instance: Instance, name: Callable[[int], ResourceId]) -> Instance:
    """The instance with the names of numbers as ids: those of the places of resources, of groups and of robots."""
    graph = instance.graph
    ids = {id: name(number) for id, number in graph.index.items()}
    resources = tuple(replace(each, id=ids[each.id]) for each in graph.resources)
    edges = tuple((ids[source], ids[target]) for source, target in graph.edges)
    groups = tuple(
        replace(each, id=name(number), resources=tuple(ids[member] for member in each.resources))
        for number, each in enumerate(graph.groups)
    )
    robots = (replace(each.in_names(ids.__getitem__), id=name(number)) for number, each in enumerate(instance.robots))
    return replace(instance, graph=ResourceGraph(resources, edges, graph.directed, groups), robots=tuple(robots))


def engine_for(instance: Instance) -> Engine:
    """The planner with which answers are compared: the reference, or the compiled one where that would take long."""
    return engine_named(None if is_large(instance) else "reference")


def planned_by(engine: Engine, case: Case) -> Solution:
    """The engine's answer to a question `plan` or `add`."""
    if case.op == "plan":
        return engine.plan(case.instance, case.planner or Carp())
    return engine.add(case.instance, case.solution, case.asked_robot, case.now, case.options)


def request_of(case: Case) -> dict[str, Any]:
    """The request: values for the parameters of its op."""
    settings: dict[str, dict[str, Any]] = {
        "polish": {"options": PolishOptions(POLISH_ROUNDS)},
        "optimum": {"limit": OPTIMUM_SECONDS},
        "bound": {"steps": BOUND_STEPS},
        "execute": {"driver": "order", "now": None},
    }
    of_case = {part.name: getattr(case, part.name) for part in OPS[case.op].parts if hasattr(case, part.name)}
    return {**of_case, **settings.get(case.op, {})}


def request_fields(case: Case) -> dict[str, Any]:
    """The fields of the request besides its id and op."""
    return OPS[case.op].request_fields(request_of(case))
