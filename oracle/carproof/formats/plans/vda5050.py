"""Orders of VDA 5050, versions 2 and 3: one message for each robot, on a line of its own.

Points are nodes and lanes are edges; where a robot moves from one point to the next without a lane, the move is the
edge. The base, what is released, is what the robot may enter by the planned order; the horizon is the rest. A stop with
a service is an action of its node. The format has no times, so that waiting is expressed by later releases alone.
"""

import json
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime, timedelta
from fractions import Fraction
from hashlib import sha256
from typing import Any, cast

from carp_spec import Instance, Plan, Refusal, RobotId, Solution
from carp_spec.execution.dependencies import dependencies
from carp_spec.inputs.values import require_solution
from carp_spec.rule import DESIGN, Found, fault_rule, is_between
from carproof.formats.plans.checks import ids_by_text, require_lawful
from carproof.formats.plans.services import stops_in
from carproof.input_rules import Code
from carproof.layouts.lanes import lanes_of

VERSIONS: Mapping[str, str] = {"vda5050-2": "2.1.0", "vda5050-3": "3.0.0"}
"""The versions that are written, by the names of the formats."""
SECONDS_OF_DATES = 253_402_300_800
Element = dict[str, Any]


@dataclass(frozen=True, slots=True)
class OrderSettings:
    """What orders have that plans do not.

    `at` is the tick at which they are sent. With `since`, that of the orders before, they are updates of these. `tick`
    is in seconds, and `unit`, that of positions, in millimetres.
    """

    at: int = 0
    since: int | None = None
    version: str = "3.0.0"
    tick: Fraction = Fraction(1)
    unit: Fraction = Fraction(1)
    map_id: str = "map"
    manufacturer: str = "carproof"


@fault_rule(
    "order/settings",
    "An order is sent at a tick of at least 0, before the year 10,000. An update is sent after the order before it. "
    f"The version is one of {', '.join(VERSIONS.values())}; a tick and the unit of positions are above 0.",
    DESIGN,
)
def settings_are_right(settings: OrderSettings) -> Found:
    """Look at each of the settings."""
    given: dict[str, Any] = asdict(settings)
    for name in ("tick", "unit"):
        if not (isinstance(given[name], Fraction) and given[name] > 0):
            yield f"$.{name}", f"it must be a fraction above 0, not {given[name]!r}"
            return
    if not (is_between(settings.at, 0) and settings.at * settings.tick < SECONDS_OF_DATES):
        yield "$.at", f"it must be a tick of at least 0, before the year 10,000, not {settings.at!r}"
    elif settings.since is not None and not is_between(settings.since, 0, settings.at - 1):
        yield "$.since", f"it must be a tick of at least 0, before {settings.at}, not {settings.since!r}"
    if settings.version not in VERSIONS.values():
        yield "$.version", f"it must be one of {', '.join(VERSIONS.values())}, not {settings.version!r}"
    for name in ("map_id", "manufacturer"):
        if not isinstance(given[name], str):
            yield f"$.{name}", f"it must be text, not {given[name]!r}"


RIGHT_NAMES = Code("order/names", "Ids of an instance of which orders are written print differently.", "VDA 5050")
DEFAULTS = OrderSettings()


def write_orders(instance: Instance, solution: Solution, settings: OrderSettings = DEFAULTS) -> bytes:
    """Write orders of VDA 5050, a message on each line.

    A robot whose first node may not be released has none, nor, with `since`, has one of which no more is released than
    then. Raises `Refusal` if the solution is malformed or breaks a rule.
    """
    require_solution(instance, solution)
    if not isinstance(cast("object", settings), OrderSettings):
        raise Refusal("option", "$.orders", settings_are_right.id, f"they must be OrderSettings, not {settings!r}")
    for fault in settings_are_right(settings):
        raise Refusal("option", fault.path, fault.rule, fault.message)
    require_lawful(instance, solution)
    now = released(instance, solution, settings.at)
    then = {} if settings.since is None else released(instance, solution, settings.since)
    writer = _Writer(instance, settings)
    orders = (writer.order(plan, now[plan.robot], then.get(plan.robot, 0)) for plan in solution.plans)
    return b"".join(json.dumps(each, ensure_ascii=False).encode() + b"\n" for each in orders if each is not None)


def released(instance: Instance, solution: Solution, at: int) -> Mapping[RobotId, int]:
    """How many visits of each plan may be released at a tick, if all robots have kept to their plans so far.

    A visit may be released once every robot that is planned to leave its resource, or a group of it, before has left.
    A robot that is not yet released has none. The solution is lawful.
    """
    entries = {(plan.robot, place): visit.enter for plan in solution.plans for place, visit in enumerate(plan.visits)}
    waits: dict[RobotId, list[int]] = defaultdict(list)
    for each in dependencies(instance, solution.plans):
        if each.kind == "order" and entries[each.before] + each.ticks > at:
            robot, place = each.after
            waits[robot].append(place)
    return {
        plan.robot: 0 if instance.robot[plan.robot].release > at else min(waits[plan.robot], default=len(plan.visits))
        for plan in solution.plans
    }


class _Writer:
    """Writes the order of each plan."""

    def __init__(self, instance: Instance, settings: OrderSettings) -> None:
        self.instance = instance
        self.settings = settings
        ids_by_text(instance, RIGHT_NAMES)  # which refuses two that print alike
        self.lanes = lanes_of(instance)

    def order(self, plan: Plan, now: int, then: int) -> Element | None:
        """The order of a plan of which `now` visits are released, and `then` were before; `None` if it has none."""
        places = [place for place, visit in enumerate(plan.visits) if visit.resource not in self.lanes]
        base = sum(place < now for place in places)
        before = sum(place < then for place in places)
        if base == before:
            return None
        nodes = [*self._nodes(plan, places, base)]
        first = max(before - 1, 0)
        settings = self.settings
        sent = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(milliseconds=int(settings.at * settings.tick * 1000))
        return {
            "headerId": settings.at,
            "timestamp": sent.strftime("%Y-%m-%dT%H:%M:%S.") + f"{sent.microsecond // 1000:03}Z",
            "version": settings.version,
            "manufacturer": settings.manufacturer,
            "serialNumber": str(plan.robot),
            "orderId": self._order_id(plan),
            "orderUpdateId": settings.at if before else 0,
            "nodes": nodes[first:],
            "edges": [*self._edges(plan, places, nodes)][first:],
        }

    def _order_id(self, plan: Plan) -> str:
        """The same for plans along the same resources."""
        stops = [[stop.resource, stop.service] for stop in self.instance.robot[plan.robot].stops]
        way = json.dumps([plan.robot, [visit.resource for visit in plan.visits], stops])
        return f"{plan.robot}-{sha256(way.encode()).hexdigest()[:16]}"

    def _nodes(self, plan: Plan, places: Sequence[int], base: int) -> Iterator[Element]:
        serves, metres = stops_in(self.instance, plan), self.settings.unit / 1000
        for count, place in enumerate(places):
            at = self.instance.graph.resource[plan.visits[place].resource]
            node: Element = {"nodeId": str(at.id), "sequenceId": 2 * count, "released": count < base}
            if at.x is not None and at.y is not None:
                x, y = float(at.x * metres), float(at.y * metres)
                node["nodePosition"] = {"x": x, "y": y, "mapId": self.settings.map_id}
            yield {**node, "actions": [*self._actions(plan, place, serves)]}

    def _actions(self, plan: Plan, place: int, serves: Mapping[int, int]) -> Iterator[Element]:
        """The service of the stop that the visit serves, if it takes time."""
        stops = self.instance.robot[plan.robot].stops
        if place in serves and stops[serves[place]].service:
            yield {
                "actionType": "service",
                "actionId": f"{self._order_id(plan)}-{serves[place] + 1}",
                "blockingType": "HARD",
                "actionParameters": [
                    {"key": "stop", "value": serves[place] + 1},
                    {"key": "duration", "value": float(stops[serves[place]].service * self.settings.tick)},
                ],
            }

    def _edges(self, plan: Plan, places: Sequence[int], nodes: Sequence[Element]) -> Iterator[Element]:
        for count in range(len(places) - 1):
            lane = plan.visits[places[count] + 1].resource
            ends = (nodes[count]["nodeId"], nodes[count + 1]["nodeId"])
            edge: Element = {
                "edgeId": str(lane) if lane in self.lanes else f"{ends[0]} -> {ends[1]}",
                "sequenceId": 2 * count + 1,
                "released": nodes[count + 1]["released"],
            }
            if self.settings.version == VERSIONS["vda5050-2"]:
                edge |= {"startNodeId": ends[0], "endNodeId": ends[1]}
            yield {**edge, "actions": []}
