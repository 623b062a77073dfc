"""The ops of fleets that the server keeps: a request has the news, and its answer the plans that changed."""

import gc
import re
from dataclasses import dataclass, field

import msgspec

from carp_spec import Instance, Neighbourhood, Refusal, Robot, RobotId, Solution, Stop
from carp_spec.documents.fields import all_converted
from carp_spec.documents.instances import InstanceDocument, StopDocument, instance_document
from carp_spec.documents.solutions import PlanColumns, PlanDocument, SolutionDocument, solution_document
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_tick
from carp_spec.rule import DESIGN
from carproof.api.fleet import FEW_ROBOTS, NOT_BACK, OWN_ROBOTS, Change, Fleet
from carproof.input_rules import Code
from carproof.judging.documents import AuditDocument, audit_document
from carproof.protocol.ops.op import PolishOptions, Session
from carproof.requests import inside, sound_within

MOST_FLEETS = 8
LONGEST_NAME = 100
MOST_RESOURCES = 1_000_000
OWN_NAMES = Code(
    "fleet/name",
    f"A server keeps at most {MOST_FLEETS} fleets, each with a name of its own of at most {LONGEST_NAME} characters; "
    "a request names one of them.",
    DESIGN,
)
FEW_RESOURCES = Code("fleet/resources", f"The fleets of a server have at most {MOST_RESOURCES} resources.", DESIGN)


class FleetDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The tick, and the plans that are new or other than before.

    `unplanned` is the robot that found no plan: one to be added is not in the fleet, one to get stops has those of
    before. `left` are robots that have vanished and are not in the fleet. `audit`, where it was asked for, has the
    robots with such plans.
    """

    now: int
    plans: tuple[PlanDocument, ...]
    unplanned: tuple[RobotId, ...]
    left: tuple[RobotId, ...]
    audit: AuditDocument | msgspec.UnsetType = msgspec.UNSET


@dataclass(frozen=True, slots=True)
class FleetOpenRequest:
    """A name, and the fleet at the tick now."""

    fleet: str
    instance: Instance
    solution: Solution | None = None
    now: int = 0
    audit: bool = False
    options: Neighbourhood = field(default_factory=Neighbourhood)


def fleet_open(request: FleetOpenRequest, session: Session) -> FleetDocument:
    """Keep a fleet under a name. Robots without a plan are planned one by one, as `add` does with the options."""
    require_tick(request.now)
    _require_room(request, session)
    sound = None if request.solution is None else sound_within(request.instance, request.solution)
    with inside("$.instance"):
        fleet = Fleet(request.instance, sound, request.now, request.options, audit=request.audit)
    session.fleets[request.fleet] = fleet
    gc.freeze()  # its many plans need not be looked through for garbage again and again
    return _document(fleet, fleet.opening)


@dataclass(frozen=True, slots=True)
class FleetAddRequest:
    """A robot to add at the tick now, which is that of the news before unless given."""

    fleet: str
    robot: Robot
    now: int | None = None
    audit: bool = False


def fleet_add(request: FleetAddRequest, session: Session) -> FleetDocument:
    """Add a robot to a fleet; robots near it may get new plans from `now` on."""
    fleet = _named(request.fleet, session)
    try:
        change = fleet.add(request.robot, now=request.now, audit=request.audit)
    except Refusal as refusal:
        path = re.sub(r"^\$\.robots(\[0\])?", "$.robot", refusal.path)
        raise Refusal(refusal.kind, path, refusal.rule, refusal.message) from refusal
    return _document(fleet, change)


@dataclass(frozen=True, slots=True)
class FleetAssignRequest:
    """A robot of a fleet that gets further stops at the tick now, which is that of the news before unless given."""

    fleet: str
    robot: RobotId
    stops: tuple[StopDocument, ...]
    now: int | None = None
    audit: bool = False


def fleet_assign(request: FleetAssignRequest, session: Session) -> FleetDocument:
    """Give a robot under way or parked further stops; it and robots near it get new plans from `now` on."""
    fleet = _named(request.fleet, session)
    stops = all_converted(request.stops, Stop)
    return _document(fleet, fleet.assign(request.robot, stops, request.now, audit=request.audit))


@dataclass(frozen=True, slots=True)
class FleetForgetRequest:
    """A fleet."""

    fleet: str


def fleet_forget(request: FleetForgetRequest, session: Session) -> FleetDocument:
    """Forget what is done by now: stops that are served, and all visits but those under way and to come."""
    fleet = _named(request.fleet, session)
    fleet.forget()
    return _document(fleet, Change(fleet.now, tuple(map(PlanColumns.of, fleet.solution.plans)), (), ()))


@dataclass(frozen=True, slots=True)
class FleetAdvanceRequest:
    """A fleet, and the tick that it is now."""

    fleet: str
    now: int


def fleet_advance(request: FleetAdvanceRequest, session: Session) -> FleetDocument:
    """Let time go on: what was planned by `now` has happened. No plan changes."""
    fleet = _named(request.fleet, session)
    return _document(fleet, fleet.advance(request.now))


@dataclass(frozen=True, slots=True)
class FleetTraceRequest:
    """A fleet, and a trace of the robots that have not done what was planned by the tick `now` of the trace."""

    fleet: str
    trace: Trace
    audit: bool = False


def fleet_trace(request: FleetTraceRequest, session: Session) -> FleetDocument:
    """Report delays: plans are made later, in the same order. Robots not named have done what was planned."""
    fleet = _named(request.fleet, session)
    with inside("$.trace"):
        change = fleet.trace(request.trace, audit=request.audit)
    return _document(fleet, change)


@dataclass(frozen=True, slots=True)
class FleetPolishRequest:
    """A fleet, and how long to improve its plans."""

    fleet: str
    audit: bool = False
    options: PolishOptions = field(default_factory=PolishOptions)


def fleet_polish(request: FleetPolishRequest, session: Session) -> FleetDocument:
    """Improve the plans for the rest of the way, for a number of rounds or for a time."""
    fleet, options = _named(request.fleet, session), request.options
    change = fleet.polish(
        iterations=options.iterations, seconds=options.seconds, seed=options.seed, audit=request.audit
    )
    return _document(fleet, change)


@dataclass(frozen=True, slots=True)
class FleetRestRequest:
    """A fleet."""

    fleet: str


class FleetRestDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An instance and its solution; a robot under way starts where it is."""

    now: int
    instance: InstanceDocument
    solution: SolutionDocument


def fleet_rest(request: FleetRestRequest, session: Session) -> FleetRestDocument:
    """Show all that is to come after the moves of the tick `now`."""
    fleet = _named(request.fleet, session)
    instance, solution = fleet.rest()
    return FleetRestDocument(fleet.now, instance_document(instance), solution_document(solution))


@dataclass(frozen=True, slots=True)
class FleetCloseRequest:
    """A fleet."""

    fleet: str


class FleetClosedDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The names of the fleets that are left."""

    fleets: tuple[str, ...]


def fleet_close(request: FleetCloseRequest, session: Session) -> FleetClosedDocument:
    """Forget a fleet."""
    _named(request.fleet, session)
    del session.fleets[request.fleet]
    return FleetClosedDocument(tuple(session.fleets))


def _require_room(request: FleetOpenRequest, session: Session) -> None:
    if request.fleet in session.fleets:
        message = f"the name must be new, and there is a fleet {request.fleet!r}"
        raise Refusal("request", "$.fleet", OWN_NAMES.id, message)
    if len(request.fleet) > LONGEST_NAME:
        message = f"the name must have at most {LONGEST_NAME} characters, and has {len(request.fleet)}"
        raise Refusal("limit", "$.fleet", OWN_NAMES.id, message)
    if len(session.fleets) == MOST_FLEETS:
        message = f"there must be at most {MOST_FLEETS} fleets; fleet/close forgets one"
        raise Refusal("limit", "$.fleet", OWN_NAMES.id, message)
    graphs = [request.instance.graph, *(fleet.instance.graph for fleet in session.fleets.values())]
    size = sum(len(graph.resources) for graph in graphs)
    if size > MOST_RESOURCES:
        message = f"all fleets together must have at most {MOST_RESOURCES} resources, and would have {size}"
        raise Refusal("limit", "$.instance.graph", FEW_RESOURCES.id, message)


def _named(name: str, session: Session) -> Fleet:
    if name not in session.fleets:
        message = f"it must be the name of a fleet that is open, and {name[:LONGEST_NAME]!r} is not"
        raise Refusal("request", "$.fleet", OWN_NAMES.id, message)
    return session.fleets[name]


def _document(fleet: Fleet, change: Change) -> FleetDocument:
    audit = msgspec.UNSET if change.audit is None else audit_document(change.audit, fleet.solution)
    return FleetDocument(
        change.now, tuple(each.document for each in change.columns), change.unplanned, change.left, audit
    )


FLEET_RULES: tuple[Code, ...] = (OWN_NAMES, NOT_BACK, OWN_ROBOTS, FEW_ROBOTS, FEW_RESOURCES)
