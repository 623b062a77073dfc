"""The ops that plan."""

from dataclasses import asdict

import msgspec

from carp_spec import Instance, Neighbourhood, Plan, Planner, ResourceId, RobotId, Solution, Stop, Visit
from carp_spec.documents.fields import all_converted
from carp_spec.documents.instances import InstanceDocument, StopDocument, instance_document
from carp_spec.documents.solutions import SolutionDocument, solution_document, visits_document
from carp_spec.planners import BY_DEFAULT
from carp_spec.requests import require_new_robot, require_robot, require_tick
from carproof.api import planning
from carproof.engines import Engine, repaired, warm
from carproof.protocol.ops.op import PolishOptions
from carproof.requests import inside, inside_documents, sound_within


class QueryDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The visits of the plan, or null if none exists."""

    plan: tuple[tuple[ResourceId, int, int | None], ...] | None

    def plan_of(self, robot: RobotId) -> Plan | None:
        """The plan of the robot that was asked for."""
        return None if self.plan is None else Plan(robot, tuple(Visit(*visit) for visit in self.plan))


def query_document(plan: Plan | None) -> QueryDocument:
    """The document of a query's result."""
    return QueryDocument(None if plan is None else visits_document(plan))


def query(instance: Instance, solution: Solution, robot: RobotId, now: int = 0, *, engine: Engine) -> QueryDocument:
    """Plan one robot beside the plans of the others.

    A plan of the robot itself in `solution` is its history: its visits before `now` stay, and the rest of the plan is
    in no robot's way.
    """
    require_tick(now, "$.now")
    require_robot(instance, robot, "$.robot")
    committed = sound_within(instance, solution, robot)
    with inside_documents():
        return query_document(engine.query(instance, committed.plans, robot, now))


def plan(instance: Instance, planner: Planner | None = None, *, engine: Engine) -> Solution:
    """Plan all robots: exactly as the planner does, if it or one of its options is named.

    Otherwise robots that are left out are planned together with others.
    """
    with inside("$.instance"):
        if planner is not None:
            return engine.plan(instance, planner)
        return repaired(instance, engine.plan(instance, BY_DEFAULT))


def plan_within(instance: Instance, *, options: PolishOptions) -> Solution:
    """Plan all robots as well as possible in `seconds`, 10 unless given, or by `iterations` rounds."""
    with inside("$.instance"):
        return planning.plan_within(instance, **asdict(options))


def add(
    instance: Instance,
    solution: Solution,
    robot: RobotId,
    now: int = 0,
    *,
    options: Neighbourhood,
    engine: Engine,
) -> Solution:
    """Add one robot by the neighbourhood planner; robots near it may get new plans from `now` on."""
    require_tick(now, "$.now")
    require_new_robot(instance, solution, robot, "$.robot")
    before = sound_within(instance, solution)
    with inside_documents():
        return engine.add(instance, before, robot, now, options)


class AssignDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The instance with the further stops, and the plans; null and the plans of before if no plan was found."""

    instance: InstanceDocument | None
    solution: SolutionDocument


def assign(  # noqa: PLR0913 - one parameter for each field
    instance: Instance,
    solution: Solution,
    robot: RobotId,
    stops: tuple[StopDocument, ...],
    now: int = 0,
    *,
    options: Neighbourhood,
    engine: Engine,
) -> AssignDocument:
    """Give a robot that is under way or parked further stops; it and robots near it are planned again from `now` on."""
    before = sound_within(instance, solution)
    wanted = all_converted(stops, Stop)
    with inside_documents():
        further, after = engine.assign(instance, before, robot, wanted, now, options)
    found = None if further is instance else instance_document(further)
    return AssignDocument(found, solution_document(after))


def polish(instance: Instance, solution: Solution, now: int = 0, *, options: PolishOptions, engine: Engine) -> Solution:
    """Improve a solution, for a number of rounds or for a time; after tick 0 robots without a plan get none."""
    require_tick(now, "$.now")
    before = sound_within(instance, solution)
    if options.seconds is not None:
        warm()
    with inside_documents():
        return engine.polish(instance, before, now=now, **asdict(options))
