"""The ops of executions: traces, dependency graphs, simulations, plans for the rest, and giving way."""

from dataclasses import dataclass

import msgspec

from carp_reference.execution import order_of
from carp_spec import Instance, Refusal, ResourceId, RobotId, Solution, Verdict, Visit, total_cost
from carp_spec.documents.grants import GrantDocument
from carp_spec.documents.solutions import SolutionDocument, TraceDocument, solution_document, trace_document
from carp_spec.documents.verdicts import VerdictDocument, verdict_document
from carp_spec.execution.execution_rules import require_followed, trace_violations
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_robot, require_tick
from carp_verify.release.rules import Grant
from carproof.api.executing import check_grants as grants_checked
from carproof.api.executing import release as released
from carproof.engines import Engine
from carproof.execution.delays import Delay, late_robots, may_enter, until
from carproof.execution.giving_way import give_way as given_way
from carproof.execution.release_documents import (
    GrantsVerdictDocument,
    ReleaseDocument,
    grants_verdict_document,
    released_document,
)
from carproof.execution.simulation import DependenciesDocument, Driver, delays_are_right, dependencies_document
from carproof.execution.simulation import execute as executed
from carproof.execution.untangling import untangle as untangled
from carproof.requests import inside, sound_within


@dataclass(frozen=True, slots=True)
class CheckTraceRequest:
    """A solution, and the trace of what has happened."""

    instance: Instance
    solution: Solution
    trace: Trace


def check_trace(request: CheckTraceRequest, engine: Engine) -> VerdictDocument:
    """Judge whether a trace follows a solution: paths, durations, and the planned order."""
    del engine
    sound = sound_within(request.instance, request.solution)
    violations = trace_violations(request.instance, sound, request.trace)
    cost = total_cost(request.instance, sound.plans)
    return verdict_document(Verdict(cost, len(sound.unplanned), violations))


@dataclass(frozen=True, slots=True)
class DependenciesRequest:
    """A solution, and delays whose effect is asked for: each is [robot, position of the visit, ticks]."""

    instance: Instance
    solution: Solution
    delays: tuple[tuple[RobotId, int, int], ...] = ()


def dependencies(request: DependenciesRequest, engine: Engine) -> DependenciesDocument:
    """Make the action dependency graph of a solution, and compute the effect of delays."""
    del engine
    sound = sound_within(request.instance, request.solution)
    delays = _delays(sound, request.delays)
    order = order_of(request.instance, sound)
    return dependencies_document(order, late_robots(order, delays) if delays else None)


@dataclass(frozen=True, slots=True)
class ExecuteRequest:
    """A solution, a driver, and delays, each [robot, position of the visit, ticks]; `now` is the end of the trace."""

    instance: Instance
    solution: Solution
    driver: Driver
    delays: tuple[tuple[RobotId, int, int], ...] = ()
    now: int | None = None


class ExecutedDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The trace, the solution whose order was kept, the collisions, and the robots that stand for ever."""

    trace: TraceDocument
    followed: SolutionDocument
    collisions: tuple[str, ...]
    standing: tuple[RobotId, ...]


def execute(request: ExecuteRequest, engine: Engine) -> ExecutedDocument:
    """Simulate robots that need longer at some visits than planned."""
    del engine
    if request.now is not None:
        require_tick(request.now, "$.now")
    sound = sound_within(request.instance, request.solution)
    found = executed(request.instance, sound, request.driver, _delays(sound, request.delays))
    return ExecutedDocument(
        trace_document(found.trace if request.now is None else until(found.trace, request.now)),
        solution_document(found.followed),
        tuple(map(str, found.collisions)),
        found.standing,
    )


@dataclass(frozen=True, slots=True)
class RetimeRequest:
    """A solution, and the trace of what has happened."""

    instance: Instance
    solution: Solution
    trace: Trace


def retime(request: RetimeRequest, engine: Engine) -> Solution:
    """Make plans for the rest of the way, in the same order and as early as possible."""
    sound = sound_within(request.instance, request.solution)
    with inside("$.trace"):
        return engine.retime(request.instance, sound, request.trace)


@dataclass(frozen=True, slots=True)
class UntangleRequest:
    """A solution that may have rotations."""

    instance: Instance
    solution: Solution


class UntangledDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The solution without rotations, and the ticks by which its cost grew.

    `rotation` has the robots of a rotation that is left because none of them finds another plan.
    """

    solution: SolutionDocument
    extra: int
    rotation: tuple[RobotId, ...]


def untangle(request: UntangleRequest, engine: Engine) -> UntangledDocument:
    """Replan robots until no robots enter each other's places in a circle."""
    sound = sound_within(request.instance, request.solution)
    with inside("$.instance"):
        found = untangled(request.instance, sound, engine)
    return UntangledDocument(solution_document(found.solution), found.extra, found.rotation)


@dataclass(frozen=True, slots=True)
class GiveWayRequest:
    """A robot that must go first at the tick `now`, perhaps on a route, which has visits like those of a plan."""

    instance: Instance
    solution: Solution
    robot: RobotId
    now: int = 0
    route: tuple[tuple[ResourceId, int, int | None], ...] | None = None


class GivenWayDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The new plans (null if there are none), the arrival, and a lower bound on the arrival in any lawful update.

    With a route, the bound holds for updates on that route. `extra` are pairs of a robot replanned and the ticks by
    which it arrives later; `stuck` are robots that find no plan around the earliest one.
    """

    solution: SolutionDocument | None
    arrival: int | None
    least: int | None
    extra: tuple[tuple[RobotId, int], ...]
    stuck: tuple[RobotId, ...]


def give_way(request: GiveWayRequest, engine: Engine) -> GivenWayDocument:
    """Give a robot the earliest plan that the histories of the others allow, and plan the others around it."""
    require_tick(request.now, "$.now")
    require_robot(request.instance, request.robot, "$.robot")
    sound = sound_within(request.instance, request.solution)
    route = None if request.route is None else tuple(Visit(*visit) for visit in request.route)
    found = given_way(request.instance, sound, request.robot, request.now, engine, route)
    return GivenWayDocument(
        None if found.solution is None else solution_document(found.solution),
        found.arrival,
        found.least,
        tuple(found.extra.items()),
        found.stuck,
    )


@dataclass(frozen=True, slots=True)
class DriveRequest:
    """A solution, the trace of what has happened by the tick now, and the robots that can go on then.

    A robot that is `ready` has been released, or has stayed in its last visit for the duration and its delay.
    """

    instance: Instance
    solution: Solution
    trace: Trace
    ready: tuple[RobotId, ...]


class DriveDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The robots among those ready that enter their next visit at the tick `now` of the trace."""

    enter: tuple[RobotId, ...]


def drive(request: DriveRequest, engine: Engine) -> DriveDocument:
    """Let robots enter their next visits, in the planned order at each resource."""
    del engine
    sound = sound_within(request.instance, request.solution)
    with inside("$.trace"):
        require_followed(request.instance, sound, request.trace)
    for robot in request.ready:
        require_robot(request.instance, robot, "$.ready")
    return DriveDocument(may_enter(order_of(request.instance, sound), request.trace, request.ready))


@dataclass(frozen=True, slots=True)
class ReleaseRequest:
    """A solution, the trace of what has happened, and the robots for which grants beyond the order are searched."""

    instance: Instance
    solution: Solution
    trace: Trace
    beyond: tuple[RobotId, ...] = ()
    states: int | None = None
    seconds: float | None = None


def release(request: ReleaseRequest, engine: Engine) -> ReleaseDocument:
    """Tell which further resources of their plans robots may be granted, so that everybody can still finish."""
    del engine
    sound = sound_within(request.instance, request.solution)
    with inside("$.trace"):
        found = released(request.instance, sound, request.trace, request.beyond, request.states, request.seconds)
    return released_document(found)


@dataclass(frozen=True, slots=True)
class CheckGrantsRequest:
    """A solution, the trace of what has happened, and what robots are granted."""

    instance: Instance
    solution: Solution
    trace: Trace
    grants: tuple[GrantDocument, ...]
    states: int | None = None
    seconds: float | None = None


def check_grants(request: CheckGrantsRequest, engine: Engine) -> GrantsVerdictDocument:
    """Decide whether everybody can still finish if robots are granted these resources, and show why."""
    del engine
    sound = sound_within(request.instance, request.solution)
    grants = [Grant(each.robot, each.resources) for each in request.grants]
    verdict = grants_checked(request.instance, sound, request.trace, grants, request.states, request.seconds)
    return grants_verdict_document(request.instance, verdict)


def _delays(solution: Solution, delays: tuple[tuple[RobotId, int, int], ...]) -> tuple[Delay, ...]:
    """The delays of a request; raises `Refusal` if they are not right."""
    found = tuple(Delay(*delay) for delay in delays)
    if not delays_are_right(solution, found):
        message = "each delay must be of another visit that is planned, for at least a tick"
        raise Refusal("request", "$.delays", delays_are_right.id, message)
    return found
