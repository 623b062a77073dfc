"""The ops that plan."""

from dataclasses import asdict, dataclass, field

import msgspec

from carp_spec import Instance, Neighbourhood, Plan, Planner, ResourceId, RobotId, Solution, Stop, Visit
from carp_spec.documents.fields import all_converted
from carp_spec.documents.instances import InstanceDocument, StopDocument, instance_document
from carp_spec.documents.solutions import SolutionDocument, solution_document, visits_document
from carp_spec.planners import BY_DEFAULT
from carp_spec.requests import require_new_robot, require_robot, require_tick
from carproof.engines import Engine, repaired, warm
from carproof.protocol.ops.op import PolishOptions
from carproof.requests import inside, sound_within


@dataclass(frozen=True, slots=True)
class QueryRequest:
    """A robot to plan at the tick `now`."""

    instance: Instance
    solution: Solution
    robot: RobotId
    now: int = 0


class QueryDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The visits of the plan, or null if none exists."""

    plan: tuple[tuple[ResourceId, int, int | None], ...] | None

    def plan_of(self, robot: RobotId) -> Plan | None:
        """The plan of the robot that was asked for."""
        return None if self.plan is None else Plan(robot, tuple(Visit(*visit) for visit in self.plan))


def query_document(plan: Plan | None) -> QueryDocument:
    """The document of a query's result."""
    return QueryDocument(None if plan is None else visits_document(plan))


def query(request: QueryRequest, engine: Engine) -> QueryDocument:
    """Plan one robot beside the plans of the others.

    A plan of the robot itself in `solution` is its history: its visits before `now` stay, and the rest of the plan is
    in no robot's way.
    """
    require_tick(request.now, "$.now")
    require_robot(request.instance, request.robot, "$.robot")
    committed = sound_within(request.instance, request.solution, request.robot)
    with inside("$.instance"):
        return query_document(engine.query(request.instance, committed.plans, request.robot, request.now))


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """An instance to plan, by the planner named or, without one, by the program's first choice."""

    instance: Instance
    planner: Planner | None = None


def plan(request: PlanRequest, engine: Engine) -> Solution:
    """Plan all robots: exactly as the planner does, if it or one of its options is named.

    Otherwise robots that are left out are planned together with others.
    """
    with inside("$.instance"):
        if request.planner is not None:
            return engine.plan(request.instance, request.planner)
        return repaired(request.instance, engine.plan(request.instance, BY_DEFAULT))


@dataclass(frozen=True, slots=True)
class PlanWithinRequest:
    """An instance to plan within a time."""

    instance: Instance
    options: PolishOptions = field(default_factory=PolishOptions)


def plan_within(request: PlanWithinRequest, engine: Engine) -> Solution:
    """Plan all robots as well as possible in `seconds`, 10 unless given, or by `iterations` rounds."""
    del engine
    warm()
    from carp_optimized.improve.anytime import plan_within as within  # noqa: PLC0415 - numba is slow to load

    with inside("$.instance"):
        return within(request.instance, **asdict(request.options))


@dataclass(frozen=True, slots=True)
class AddRequest:
    """A robot to add at the tick `now`."""

    instance: Instance
    solution: Solution
    robot: RobotId
    now: int = 0
    options: Neighbourhood = field(default_factory=Neighbourhood)


def add(request: AddRequest, engine: Engine) -> Solution:
    """Add one robot by the neighbourhood planner; robots near it may get new plans from `now` on."""
    instance = request.instance
    require_tick(request.now, "$.now")
    require_new_robot(instance, request.solution, request.robot, "$.robot")
    before = sound_within(instance, request.solution)
    with inside("$.instance"):
        return engine.add(instance, before, request.robot, request.now, request.options)


@dataclass(frozen=True, slots=True)
class AssignRequest:
    """A robot that gets further stops at the tick `now`."""

    instance: Instance
    solution: Solution
    robot: RobotId
    stops: tuple[StopDocument, ...]
    now: int = 0
    options: Neighbourhood = field(default_factory=Neighbourhood)


class AssignDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The instance with the further stops, and the plans; null and the plans of before if no plan was found."""

    instance: InstanceDocument | None
    solution: SolutionDocument


def assign(request: AssignRequest, engine: Engine) -> AssignDocument:
    """Give a robot that is under way or parked further stops; it and robots near it are planned again from `now` on."""
    instance = request.instance
    before = sound_within(instance, request.solution)
    stops = all_converted(request.stops, Stop)
    further, after = engine.assign(instance, before, request.robot, stops, request.now, request.options)
    found = None if further is instance else instance_document(further)
    return AssignDocument(found, solution_document(after))


@dataclass(frozen=True, slots=True)
class PolishRequest:
    """A solution to improve; robots keep what they have done by the tick `now`."""

    instance: Instance
    solution: Solution
    now: int = 0
    options: PolishOptions = field(default_factory=PolishOptions)


def polish(request: PolishRequest, engine: Engine) -> Solution:
    """Improve a solution, for a number of rounds or for a time; after tick 0 robots without a plan get none."""
    require_tick(request.now, "$.now")
    before = sound_within(request.instance, request.solution)
    if request.options.seconds is not None:
        warm()
    with inside("$.instance"):
        return engine.polish(request.instance, before, now=request.now, **asdict(request.options))
