"""The ops of executions: traces, dependency graphs, simulations, plans for the rest, and giving way."""

from time import perf_counter
from typing import TypeAlias

import msgspec

from carp_reference.execution import order_of
from carp_spec import Instance, Refusal, ResourceId, RobotId, Solution, Visit
from carp_spec.documents.grants import GrantDocument
from carp_spec.documents.solutions import SolutionDocument, TraceDocument, solution_document, trace_document
from carp_spec.documents.verdicts import VerdictDocument, verdict_document
from carp_spec.execution.execution_rules import require_followed
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_robot, require_tick
from carp_verify.release.rules import Grant
from carproof.api.judging import check_trace as trace_checked
from carproof.engines import Engine
from carproof.execution.delays import Delay, late_robots, may_enter, until
from carproof.execution.giving_way import give_way as given_way
from carproof.execution.release_documents import (
    GrantsVerdictDocument,
    ReleaseDocument,
    grants_verdict_document,
    released_document,
)
from carproof.execution.releasing import Releasing, limit_of
from carproof.execution.simulation import DependenciesDocument, Driver, dependencies_document, require_delays
from carproof.execution.simulation import execute as executed
from carproof.execution.untangling import untangle as untangled
from carproof.requests import below, deadline, document_of, inside, inside_documents, sound_within

DelayFields: TypeAlias = tuple[RobotId, int, int]
"""A robot, the position of a visit, and ticks."""


def check_trace(instance: Instance, solution: Solution, trace: Trace) -> VerdictDocument:
    """Judge whether a trace follows a solution: paths, durations, and the planned order."""
    return verdict_document(trace_checked(instance, sound_within(instance, solution), trace))


def dependencies(instance: Instance, solution: Solution, delays: tuple[DelayFields, ...] = ()) -> DependenciesDocument:
    """Make the action dependency graph of a solution, and compute the effect of delays.

    Each of `delays` is [robot, position of the visit, ticks].
    """
    sound = sound_within(instance, solution)
    late = _delays(sound, delays)
    order = order_of(instance, sound)
    return dependencies_document(order, late_robots(order, late) if late else None)


class ExecutedDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The trace, the solution whose order was kept, the collisions, and the robots that stand for ever."""

    trace: TraceDocument
    followed: SolutionDocument
    collisions: tuple[str, ...]
    standing: tuple[RobotId, ...]


def execute(
    instance: Instance,
    solution: Solution,
    driver: Driver,
    delays: tuple[DelayFields, ...] = (),
    now: int | None = None,
) -> ExecutedDocument:
    """Simulate robots that need longer at some visits than planned.

    Each of `delays` is [robot, position of the visit, ticks]. The trace ends at the tick `now`, if that is given.
    """
    if now is not None:
        require_tick(now, "$.now")
    sound = sound_within(instance, solution)
    found = executed(instance, sound, driver, _delays(sound, delays))
    return ExecutedDocument(
        trace_document(found.trace if now is None else until(found.trace, now)),
        solution_document(found.followed),
        tuple(map(str, found.collisions)),
        found.standing,
    )


def retime(instance: Instance, solution: Solution, trace: Trace, *, engine: Engine) -> Solution:
    """Make plans for the rest of the way, in the same order and as early as possible.

    Where robots are at the tick of the trace is told: other ops keep it with a `now` of at least the next tick.
    """
    sound = sound_within(instance, solution)
    try:
        return engine.retime(instance, sound, trace)
    except Refusal as refusal:
        too_large = document_of(refusal) if refusal.kind == "limit" else None
        raise below(f"$.{too_large or 'trace'}", refusal) from refusal


class UntangledDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The solution without rotations, and the ticks by which its cost grew.

    `rotation` has the robots of a rotation that is left, as none of them finds another plan. If it is `undecided`, the
    time was over, and more rotations may be left than the one that was found last.
    """

    solution: SolutionDocument
    extra: int
    rotation: tuple[RobotId, ...]
    undecided: bool


def untangle(
    instance: Instance, solution: Solution, seconds: float | None = None, *, engine: Engine
) -> UntangledDocument:
    """Replan robots until no robots enter each other's places in a circle, or the `seconds` are over."""
    ends = deadline(seconds)
    sound = sound_within(instance, solution)
    with inside_documents():
        found = untangled(instance, sound, engine, lambda: perf_counter() < ends)
    return UntangledDocument(solution_document(found.solution), found.extra, found.rotation, found.undecided)


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


def give_way(
    instance: Instance,
    solution: Solution,
    robot: RobotId,
    now: int = 0,
    route: tuple[tuple[ResourceId, int, int | None], ...] | None = None,
    *,
    engine: Engine,
) -> GivenWayDocument:
    """Give a robot the earliest plan that the histories of the others allow, and plan the others around it.

    It goes at the tick `now`, perhaps on a route, which has visits like those of a plan.
    """
    require_tick(now, "$.now")
    require_robot(instance, robot, "$.robot")
    sound = sound_within(instance, solution)
    visits = None if route is None else tuple(Visit(*visit) for visit in route)
    with inside_documents():
        found = given_way(instance, sound, robot, now, engine, visits)
    return GivenWayDocument(
        None if found.solution is None else solution_document(found.solution),
        found.arrival,
        found.least,
        tuple(found.extra.items()),
        found.stuck,
    )


class DriveDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The robots among those ready that enter their next visit at the tick `now` of the trace."""

    enter: tuple[RobotId, ...]


def drive(instance: Instance, solution: Solution, trace: Trace, ready: tuple[RobotId, ...]) -> DriveDocument:
    """Let robots enter their next visits, in the planned order at each resource.

    A robot that is `ready` has been released, or has stayed in its last visit for the duration and its delay.
    """
    sound = sound_within(instance, solution)
    with inside("$.trace"):
        require_followed(instance, sound, trace)
    for robot in ready:
        require_robot(instance, robot, "$.ready")
    return DriveDocument(may_enter(order_of(instance, sound), trace, ready))


def release(
    instance: Instance,
    solution: Solution,
    trace: Trace,
    beyond: tuple[RobotId, ...] = (),
    states: int | None = None,
    seconds: float | None = None,
) -> ReleaseDocument:
    """Tell which further resources of their plans robots may be granted, so that everybody can still finish.

    For the robots of `beyond`, grants beyond the planned order are searched.
    """
    limit = limit_of(states, seconds)
    return released_document(_situation(instance, solution, trace).released(beyond, *limit))


def check_grants(
    instance: Instance,
    solution: Solution,
    trace: Trace,
    grants: tuple[GrantDocument, ...],
    states: int | None = None,
    seconds: float | None = None,
) -> GrantsVerdictDocument:
    """Decide whether everybody can still finish if robots are granted these resources, and show why."""
    limit = limit_of(states, seconds)
    wanted = [Grant(each.robot, each.resources) for each in grants]
    verdict = _situation(instance, solution, trace).check(wanted, *limit)
    return grants_verdict_document(instance, verdict)


def _situation(instance: Instance, solution: Solution, trace: Trace) -> Releasing:
    sound = sound_within(instance, solution)
    try:
        return Releasing(instance, sound, trace)
    except Refusal as refusal:
        raise below("$.solution" if refusal.kind == "request" else "$.trace", refusal) from refusal


def _delays(solution: Solution, delays: tuple[DelayFields, ...]) -> tuple[Delay, ...]:
    return require_delays(solution, [Delay(*delay) for delay in delays], "request")
