"""Queries with certificates: the plan that arrives earliest, and the evidence that none arrives earlier."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.jit.kinds import Ints
from carp_optimized.state.arrays import LARGEST, TOO_FAR, UNREACHABLE, WHOLE
from carp_optimized.windows.fitting import STANDING
from carp_spec import Instance, Plan, RobotId
from carp_spec.documents.query_certificates import QueryCertificateDocument, ServedLayer, certificate_of
from carp_spec.plan_rules import stops_left

Labels: TypeAlias = list[tuple[int, int]]


class Certifier:
    """Plans robots one by one beside plans that are committed, each with its certificate."""

    def __init__(self, instance: Instance) -> None:
        """Begin without plans. Raises `Refusal` if the instance has numbers that are too large."""
        self._instance = instance
        self._fleet = PlannedFleet(instance)
        self._ids = [resource.id for resource in instance.graph.resources]

    def commit(self, plans: Sequence[Plan]) -> None:
        """Add plans that break no rule together with those committed."""
        self._fleet.commit(plans)

    def certify(
        self, robot: RobotId, followed: Plan | None = None, now: int = 0
    ) -> tuple[Plan | None, QueryCertificateDocument]:
        """The plan of the robot that arrives earliest, `None` if it has none, and its certificate.

        `followed` is the plan that the robot has followed until the tick `now`. The labels are the windows from which
        the goal might be reached before the bound.
        """
        index = self._fleet.index(robot)
        plan = self._fleet.find(index, followed, now)
        expanded = labels_before_arrival(self._fleet, index, followed, now)
        bound = None if plan is None else plan.visits[-1].enter
        layers = [
            ServedLayer(
                labels=tuple(
                    (self._ids[resource], tick)
                    for resource, tick in labels
                    if bound is None or tick + potential[resource] < bound
                ),
                potential=tuple(zip(map(self._ids.__getitem__, potential), potential.values(), strict=True)),
            )
            for labels, potential in zip(expanded, potentials(self._fleet, index), strict=True)
        ]
        left = len(stops_left(self._instance.robot[robot], followed, now))
        return plan, certificate_of(robot, now, bound, layers[-left:])


def labels_before_arrival(fleet: PlannedFleet, robot: int, before: Plan | None, now: int) -> list[Labels]:
    """The windows that the query of a robot expands, asked for the `WHOLE`.

    Told are their resources, each with the tick of its entry. A robot with stops has such a list for each number of
    stops served; the tick is then that from which it may leave, less the duration.
    """
    search = fleet.state.search
    search.expansions[0] = 0
    search.generation[0] += 1
    fleet.find(robot, before, now, WHOLE)
    own = fleet.instance.robots[robot]
    return [_labels(fleet, robot)] if own.has_goal_alone else _labels_over_stops(fleet, len(own.stops))


def _labels(fleet: PlannedFleet, robot: int) -> Labels:
    """The labels of the last query, of a robot with a goal alone.

    The start is entered as late as the robot may be there to leave it as early: the query does not come back to it,
    but other plans may. Who has stayed at its goal too long to end there does come back, and has no such label.
    """
    search = fleet.state.search
    count = int(search.expansions[0])
    if count == 0:
        return []
    resources = search.expanded[:count]
    enters = search.entered[:count].copy()
    start, ready = int(resources[0]), int(search.ready[0])
    ticks = int(fleet.state.robots.pace[robot]) * int(fleet.state.graph.duration[start])
    overstayed = start == fleet.state.robots.goal[robot] and not fleet.state.parks and ready > enters[0] + ticks
    first = 1 if overstayed else 0
    enters[0] = ready - ticks
    return [*zip(resources[first:].tolist(), enters[first:].tolist(), strict=True)]


def _labels_over_stops(fleet: PlannedFleet, count: int) -> list[Labels]:
    """The labels of the last query, of a robot with so many stops, but for the start."""
    stops, base = fleet.state.stops, int(fleet.state.search.generation[0]) << 32
    ticks = (base - stops.reached).reshape(-1, stops.stride).T
    layers: list[Labels] = []
    for own in ticks[:count]:
        found = np.flatnonzero((own < 1 << 32) & (base > 0))
        found = found[found != STANDING]
        layers.append([*zip(fleet.state.windows.resource[found].tolist(), own[found].tolist(), strict=True)])
    return layers


def potentials(fleet: PlannedFleet, robot: int) -> list[dict[int, int]]:
    """By number of stops served: the resources from which the robot can reach its goal, with the ticks to it.

    Ticks beyond the largest are counted as one more than that.
    """
    own = fleet.instance.robots[robot]
    if own.has_goal_alone:
        return [_reaching(_guide(fleet, robot), 0)]
    layers: list[dict[int, int]] = []
    rest: int | None = 0
    first = int(fleet.state.stops.first[robot])
    for number, stop in reversed([*enumerate(own.stops, first)]):
        place = fleet.instance.graph.index[stop.resource]
        if layers:
            longer = fleet.instance.stay(own.id, stop) - fleet.instance.duration(own.id, stop.resource)
            rest = layers[0][place] + longer if place in layers[0] else None
        layers.insert(0, {} if rest is None else _reaching(_guide_to_stop(fleet, number), rest))
    return layers


def _guide(fleet: PlannedFleet, robot: int) -> Ints:
    """The guide of the robot's destination: ticks to the goal."""
    fleet.call(lambda: passes.reach_from_everywhere(fleet.native, robot))
    guides = fleet.state.guides
    guide: Ints = guides.ticks[int(guides.slot[fleet.state.robots.destination[robot]])]
    return guide


def _guide_to_stop(fleet: PlannedFleet, number: int) -> Ints:
    """The guide to a stop, one of those of all robots."""
    slot = fleet.call(lambda: passes.reach_stop(fleet.native, number))
    guide: Ints = fleet.state.guides.ticks[slot]
    return guide


def _reaching(guide: Ints, rest: int) -> dict[int, int]:
    """The resources that a guide reaches, with their ticks and the rest, at most one more than the largest."""
    ticks = np.where(guide == TOO_FAR, LARGEST + 1, np.minimum(guide.astype(np.int64) + rest, LARGEST + 1))
    reaching = np.flatnonzero(guide != UNREACHABLE)
    return dict(zip(reaching.tolist(), ticks[reaching].tolist(), strict=True))
