"""The ops of fleets that the server keeps: a request has the news, and its answer the plans that changed."""

import gc
import re
from dataclasses import asdict

import msgspec

from carp_spec import Instance, Neighbourhood, Refusal, Robot, RobotId, Solution, Stop
from carp_spec.documents.fields import all_converted
from carp_spec.documents.instances import InstanceDocument, StopDocument, instance_document
from carp_spec.documents.solutions import PlanColumns, PlanDocument, SolutionDocument, solution_document
from carp_spec.execution.traces import Trace
from carp_spec.requests import require_tick
from carp_spec.rule import DESIGN
from carproof.api.fleet import Fleet
from carproof.api.fleet_memory import Change
from carproof.api.fleet_rules import FEW_ROBOTS, NOT_BACK, OWN_ROBOTS
from carproof.input_rules import Code
from carproof.judging.documents import AuditDocument, audit_document
from carproof.protocol.ops.op import PolishOptions, Session
from carproof.requests import inside, inside_documents, sound_within

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
    before. `left` are robots that have vanished or were removed. `audit`, where it was asked for, has the
    robots with such plans.
    """

    now: int
    plans: tuple[PlanDocument, ...]
    unplanned: tuple[RobotId, ...]
    left: tuple[RobotId, ...]
    audit: AuditDocument | msgspec.UnsetType = msgspec.UNSET


def fleet_open(  # noqa: PLR0913 - one parameter for each field
    fleet: str,
    instance: Instance,
    solution: Solution | None = None,
    now: int = 0,
    audit: bool = False,
    *,
    options: Neighbourhood,
    session: Session,
) -> FleetDocument:
    """Keep a fleet under a name. Robots without a plan are planned one by one, as `add` does with the options."""
    require_tick(now)
    _require_room(fleet, instance, session)
    sound = None if solution is None else sound_within(instance, solution)
    with inside_documents():
        opened = Fleet(instance, sound, now, options, audit=audit)
    session.fleets[fleet] = opened
    gc.freeze()  # its many plans need not be looked through for garbage again and again
    return _document(opened, opened.opening)


def fleet_add(
    fleet: str, robot: Robot, now: int | None = None, audit: bool = False, *, session: Session
) -> FleetDocument:
    """Add a robot to a fleet; robots near it may get new plans from `now` on.

    `now` is the tick of the news before unless given.
    """
    kept = _named(fleet, session)
    try:
        change = kept.add(robot, now=now, audit=audit)
    except Refusal as refusal:
        path = re.sub(r"^\$\.robots(\[0\])?", "$.robot", refusal.path)
        raise Refusal(refusal.kind, path, refusal.rule, refusal.message) from refusal
    return _document(kept, change)


def fleet_assign(
    fleet: str,
    robot: RobotId,
    stops: tuple[StopDocument, ...],
    now: int | None = None,
    audit: bool = False,
    *,
    session: Session,
) -> FleetDocument:
    """Give a robot under way or parked further stops; it and robots near it get new plans from `now` on.

    `now` is the tick of the news before unless given.
    """
    kept = _named(fleet, session)
    return _document(kept, kept.assign(robot, all_converted(stops, Stop), now, audit=audit))


def fleet_remove(fleet: str, robot: RobotId, now: int | None = None, *, session: Session) -> FleetDocument:
    """Take a robot off the floor: it has `left`, and from the tick now on its places are free. No plan changes.

    `now` is the tick of the news before unless given.
    """
    kept = _named(fleet, session)
    return _document(kept, kept.remove(robot, now))


def fleet_forget(fleet: str, session: Session) -> FleetDocument:
    """Forget what is done by now: stops that are served, and all visits but those under way and to come."""
    kept = _named(fleet, session)
    kept.forget()
    return _document(kept, Change(kept.now, tuple(map(PlanColumns.of, kept.solution.plans)), (), ()))


def fleet_advance(fleet: str, now: int, session: Session) -> FleetDocument:
    """Let time go on: what was planned by `now` has happened. No plan changes."""
    kept = _named(fleet, session)
    return _document(kept, kept.advance(now))


def fleet_trace(fleet: str, trace: Trace, audit: bool = False, *, session: Session) -> FleetDocument:
    """Report delays: plans are made later, in the same order. Robots not named have done what was planned."""
    kept = _named(fleet, session)
    with inside("$.trace"):
        change = kept.trace(trace, audit=audit)
    return _document(kept, change)


def fleet_polish(fleet: str, audit: bool = False, *, options: PolishOptions, session: Session) -> FleetDocument:
    """Improve the plans for the rest of the way, for a number of rounds or for a time."""
    kept = _named(fleet, session)
    return _document(kept, kept.polish(**asdict(options), audit=audit))


class FleetRestDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An instance and its solution; a robot under way starts where it is."""

    now: int
    instance: InstanceDocument
    solution: SolutionDocument


def fleet_rest(fleet: str, session: Session) -> FleetRestDocument:
    """Show all that is to come after the moves of the tick `now`."""
    kept = _named(fleet, session)
    instance, solution = kept.rest()
    return FleetRestDocument(kept.now, instance_document(instance), solution_document(solution))


class FleetClosedDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The names of the fleets that are left."""

    fleets: tuple[str, ...]


def fleet_close(fleet: str, session: Session) -> FleetClosedDocument:
    """Forget a fleet."""
    _named(fleet, session)
    del session.fleets[fleet]
    return FleetClosedDocument(tuple(session.fleets))


def _require_room(name: str, instance: Instance, session: Session) -> None:
    if name in session.fleets:
        message = f"the name must be new, and there is a fleet {name!r}"
        raise Refusal("request", "$.fleet", OWN_NAMES.id, message)
    if len(name) > LONGEST_NAME:
        message = f"the name must have at most {LONGEST_NAME} characters, and has {len(name)}"
        raise Refusal("limit", "$.fleet", OWN_NAMES.id, message)
    if len(session.fleets) == MOST_FLEETS:
        message = f"there must be at most {MOST_FLEETS} fleets; fleet/close forgets one"
        raise Refusal("limit", "$.fleet", OWN_NAMES.id, message)
    graphs = [instance.graph, *(fleet.instance.graph for fleet in session.fleets.values())]
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
