"""Checks the certificate of a query: whole numbers, the standard library, and nothing of the planners' search.

Why the bound holds: take any plan of the robot that breaks no rule, alone or together with the plans of the others.
Follow it from the start, which is where the robot is at the tick `now`. As long as t + potential is before the bound,
the window that the plan enters at t has a label no later than t: from the start or a label, every window that can be
entered has one, and a robot that is ready earlier can enter every window at least as early. The plan cannot end at such
a label, so it comes to a window at which t + potential has reached the bound. From there on that sum never falls, as
the potential grows along no move by more than the robot needs, and at the goal it is the arrival.

A robot with several stops has labels and a potential for each number of stops served. Serving a stop leads from one to
the next within a window; t is then the tick from which the robot may leave, less the duration.

A plan that has ended stays as it is. Where the plans of the others leave no room for what the robot has done, it has no
plan at all, and every claim about its plans is true.

The same conditions are proved sufficient in `kernel/QueryCertificate.v`.
"""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import accumulate, pairwise, zip_longest

from carp_spec import Instance, Plan, Refusal, ResourceId, Robot, Rule, Solution, Stop, Visit, has_ended
from carp_spec.documents.query_certificates import QueryCertificateDocument, ServedLayer
from carp_spec.inputs.values import require_solution
from carp_spec.plan_rules import stops_left
from carp_spec.shapes import require_shape
from carp_spec.windows import Window
from carp_verify.query.rules import (
    LARGEST_CHECK,
    fits_stops,
    is_closed,
    is_no_later,
    is_potential,
    plans_are_lawful,
    robot_is_known,
    size_fits,
)


class Traffic:
    """The committed plans by constraint and tick: it takes plans one by one, and gives the free windows.

    `watch` is called for each look at windows, and may raise an error of its own to end a check.
    """

    def __init__(self, instance: Instance, watch: Callable[[], None] = lambda: None) -> None:
        self.instance = instance
        self._watch = watch
        self._capacities = [constraint.capacity for constraint in instance.graph.constraints]
        self._changes: dict[int, dict[int, int]] = defaultdict(lambda: {0: 0})
        self._counts: dict[int, tuple[list[int], list[int]]] = {}
        self._entered: dict[tuple[int, int], set[ResourceId]] = defaultdict(set)

    def commit(self, plan: Plan) -> None:
        """Add the stays and the moves of a plan; in a group, visits one after the other take up its room once."""
        graph = self.instance.graph
        for visit, following in zip_longest(plan.visits, plan.visits[1:]):
            kept = () if following is None else graph.constraints_of(following.resource)
            for constraint in graph.constraints_of(visit.resource):
                gap = 0 if constraint in kept else self.instance.gap
                self._change(constraint, visit.enter, 1)
                if visit.leave is not None:
                    self._change(constraint, visit.leave + gap, -1)
        for visit, following in pairwise(plan.visits):
            for area in graph.areas_of(visit.resource):
                self._entered[following.enter, area].add(following.resource)

    def _change(self, constraint: int, tick: int, robots: int) -> None:
        """Note that so many robots more are in what the constraint is on from the tick on."""
        changes = self._changes[constraint]
        changes[tick] = changes.get(tick, 0) + robots
        self._counts.pop(constraint, None)

    def _count(self, constraint: int) -> tuple[list[int], list[int]]:
        """The ticks at which something changes, and the number of robots inside from each on."""
        if constraint not in self._counts:
            changes = self._changes[constraint]
            ticks = sorted(changes)
            self._counts[constraint] = ticks, [*accumulate(map(changes.__getitem__, ticks))]
        return self._counts[constraint]

    def size(self, resource: ResourceId) -> int:
        """The number of ticks at which the number of robots in the resource or its groups may change."""
        return sum(len(self._changes[each]) for each in self.instance.graph.constraints_of(resource))

    def windows(self, resource: ResourceId, tick: int) -> Iterator[Window]:
        """The free windows of the resource that end after the tick, in order of time."""
        self._watch()
        own, *groups = (self._room(each, tick) for each in self.instance.graph.constraints_of(resource))
        return reduce(_both, groups, own)

    def _room(self, constraint: int, tick: int) -> Iterator[Window]:
        """The intervals in which the constraint has room that end after the tick, in order of time."""
        changes, inside = self._count(constraint)
        capacity = self._capacities[constraint]
        position = bisect_right(changes, tick) - 1
        while position > 0 and inside[position] < capacity and inside[position - 1] < capacity:
            position -= 1
        opened: int | None = None
        for place in range(position, len(changes)):
            if opened is None and inside[place] < capacity:
                opened = changes[place]
            elif opened is not None and inside[place] >= capacity:
                closed = changes[place] - self.instance.gap
                if closed > max(opened, tick):
                    yield Window(opened, closed)
                opened = None
        if opened is not None:
            yield Window(opened, None)

    def window_at(self, resource: ResourceId, tick: int) -> Window | None:
        """The free window that holds the tick."""
        window = next(self.windows(resource, tick), None)
        return window if window is not None and window.start <= tick else None

    def is_exchange(self, tick: int, source: ResourceId, target: ResourceId) -> bool:
        """Whether a committed robot moves at the tick from an area of the target to one of the source."""
        graph = self.instance.graph
        places = [self._entered.get((tick, area), set()) for area in graph.areas_of(target)]
        if any(source in each for each in places) or source not in graph.groups_of:
            return any(source in each for each in places)
        return any(graph.are_close(each, source) for each in set().union(*places))

    def allows(self, visits: Sequence[Visit]) -> bool:
        """Whether one more robot can make these visits."""
        around = [(visit, self.window_at(visit.resource, visit.enter)) for visit in visits]
        free = all(window is not None and window.lasts_until(visit.leave) for visit, window in around)
        return free and not any(self.is_exchange(to.enter, at.resource, to.resource) for at, to in pairwise(visits))


def _both(one: Iterator[Window], other: Iterator[Window]) -> Iterator[Window]:
    """What intervals of one kind have in common with those of another; both are in order of time, and apart."""
    here, there = next(one, None), next(other, None)
    while here is not None and there is not None:
        start = max(here.start, there.start)
        end = min((each.end for each in (here, there) if each.end is not None), default=None)
        if end is None or start < end:
            yield Window(start, end)
        if end is None:
            return
        here, there = (next(one, None) if here.end == end else here), (next(other, None) if there.end == end else there)


def verify_query(instance: Instance, solution: Solution, certificate: QueryCertificateDocument) -> int | None:
    """The bound that the certificate proves, beside the plans of the other robots in the solution; `None`: no plan.

    A plan of the robot itself in the solution is what it has followed until the tick `now`. Raises `Refusal` with what
    is wrong with the certificate.
    """
    require_solution(instance, solution)
    require_shape(certificate, QueryCertificateDocument)
    message = "the plans must each break no rule, and be of different robots of the instance"
    _require(plans_are_lawful, plans_are_lawful(instance, solution.plans), "$", message)
    robot = certificate.robot
    message = f"the instance must have the robot, and has no {robot!r}"
    _require(robot_is_known, robot_is_known(instance, robot), "$.robot", message)
    traffic = Traffic(instance)
    for plan in solution.plans:
        if plan.robot != robot:
            traffic.commit(plan)
    require_certificate(traffic, certificate, next((plan for plan in solution.plans if plan.robot == robot), None))
    return certificate.bound


def require_certificate(traffic: Traffic, certificate: QueryCertificateDocument, followed: Plan | None = None) -> None:
    """Raise `Refusal` unless the certificate shows its bound beside the plans committed.

    The plan followed until now, and the plans committed, must be lawful.
    """
    if followed is not None and has_ended(followed, certificate.now):
        if traffic.allows(followed.visits):
            arrival = followed.visits[-1].enter
            message = f"the plan that has ended arrives at {arrival}, so the bound must be no later"
            _require(is_no_later, is_no_later(certificate.bound, arrival), "$.bound", message)
        return
    *past, current = history(traffic.instance, certificate, followed)
    if traffic.allows((*past, current)):
        left = stops_left(traffic.instance.robot[certificate.robot], followed, certificate.now)
        Check(traffic, certificate, left).require(current)


def history(instance: Instance, certificate: QueryCertificateDocument, followed: Plan | None) -> tuple[Visit, ...]:
    """The visits that the robot has entered by now; the last is the current one, left as early as possible."""
    robot = instance.robot[certificate.robot]
    visits = () if followed is None else followed.visits
    entered = [visit for visit in visits if visit.enter <= certificate.now]
    *past, current = entered or [Visit(robot.start, robot.release, None)]
    ready = max(current.enter + instance.duration(robot.id, current.resource), certificate.now)
    return (*past, Visit(current.resource, current.enter, ready))


@dataclass(frozen=True, slots=True)
class Place:
    """A window that the robot entered at a tick, that from which it may leave, and the number of stops served."""

    resource: ResourceId
    window: Window
    enter: int
    ready: int
    served: int
    path: str


class Layer:
    """What a certificate says of the robot once it has served so many stops."""

    def __init__(self, layer: ServedLayer, path: str) -> None:
        self.path = path
        self.labels = layer.labels
        self.potential: Mapping[ResourceId, int] = dict(layer.potential)
        self._entries: dict[ResourceId, list[int]] = defaultdict(list)
        for resource, tick in sorted(layer.labels, key=lambda label: label[1]):
            self._entries[resource].append(tick)

    def first_label(self, resource: ResourceId, window: Window) -> int | None:
        """The tick of the first label of the resource from the start of the window on."""
        entries = self._entries[resource]
        position = bisect_left(entries, window.start)
        return entries[position] if position < len(entries) else None


class Check:
    """The conditions on one certificate beside committed plans."""

    def __init__(self, traffic: Traffic, certificate: QueryCertificateDocument, stops: Sequence[Stop]) -> None:
        """`stops` are those left."""
        self.traffic = traffic
        self.instance = traffic.instance
        self.robot: Robot = self.instance.robot[certificate.robot]
        self.certificate = certificate
        self.stops = stops
        paths = ("$", *(f"$.served[{number}]" for number in range(len(certificate.served))))
        self.layers = [Layer(layer, path) for layer, path in zip(certificate.layers, paths, strict=True)]

    def require(self, current: Visit) -> None:
        """Raise `Refusal` unless the certificate shows its bound for a robot in its current visit."""
        self._require_size()
        self._require_potentials()
        ready = current.leave
        window = self.traffic.window_at(current.resource, current.enter)
        assert window is not None  # noqa: S101 - the traffic allows the visit
        assert ready is not None  # noqa: S101 - the history has it
        if not self._is_late(current.resource, 0, current.enter):
            self._require_closed(
                Place(current.resource, window, current.enter, ready, 0, "$.labels"), self._overstayed(current)
            )
        for served, layer in enumerate(self.layers):
            for number, (resource, tick) in enumerate(layer.labels):
                if resource in self.instance.graph.resource and tick >= 0 and not self._is_late(resource, served, tick):
                    around = self.traffic.window_at(resource, tick)
                    if around is not None:
                        ready = tick + self._ticks(resource)
                        path = f"{layer.path}.labels[{number}]"
                        self._require_closed(Place(resource, around, tick, ready, served, path), overstayed=False)

    def _ticks(self, resource: ResourceId) -> int:
        return self.instance.duration(self.robot.id, resource)

    def _overstayed(self, current: Visit) -> bool:
        """Whether the robot, which must leave the goal as soon as it has served it, is there for longer by now."""
        return current.enter + self.instance.stay(self.robot.id, self.robot.stops[-1]) < self.certificate.now

    def _is_late(self, resource: ResourceId, served: int, tick: int) -> bool:
        """Whether the robot, if it enters the resource at the tick, enters its goal no earlier than the bound."""
        potential, bound = self.layers[served].potential, self.certificate.bound
        if resource not in potential:
            return True
        return bound is not None and bound <= tick + potential[resource]

    def _require_size(self) -> None:
        message = f"there must be labels and potentials before each of {len(self.stops)} stops left"
        _require(fits_stops, fits_stops(len(self.layers), len(self.stops)), "$.served", message)
        graph, size = self.instance.graph, self.traffic.size
        labels = [resource for layer in self.layers for resource, _ in layer.labels]
        resources: Iterable[ResourceId] = {each for each in labels if each in graph.resource}
        steps = {
            each: size(each) + sum(size(each) + size(target) for target in graph.successors[each]) for each in resources
        }
        moves = sum(1 + len(targets) for targets in graph.successors.values())
        total = len(labels) + sum(steps.get(resource, 0) for resource in labels) + len(self.layers) * moves
        message = f"there would be {total} windows and moves to look at, and at most {LARGEST_CHECK} are allowed"
        _require(size_fits, size_fits(total), "$.labels", message)

    def _require_potentials(self) -> None:
        graph = self.instance.graph
        moves = [(each.id, graph.successors[each.id], self._ticks(each.id)) for each in graph.resources]
        for stop, layer, behind in zip_longest(self.stops, self.layers, self.layers[1:]):
            extra = self.instance.stay(self.robot.id, stop) - self._ticks(stop.resource)
            following = None if behind is None else behind.potential
            for fault in is_potential(layer.potential, moves, stop.resource, extra, following):
                raise Refusal("document", f"{layer.path}.potential", is_potential.id, fault)

    def _require_closed(self, place: Place, overstayed: bool) -> None:
        """Require that the plan cannot end in the place, and that all that can follow it is labelled."""
        stop = self.stops[place.served]
        if stop.resource == place.resource:
            leave = place.enter + self.instance.stay(self.robot.id, stop)
            if place.served + 1 < len(self.stops):
                self._require_served(place, max(leave, place.ready))
            else:
                parks = self.instance.after_goal == "park"
                can_end = place.window.end is None if parks else place.window.lasts_until(leave) and not overstayed
                message = f"the robot can end its plan in {place.resource}, before the bound"
                _require(is_closed, is_closed(can_end, []), place.path, message)
        for target in self.instance.graph.successors[place.resource]:
            if target in self.layers[place.served].potential:
                self._require_labels(place, target)

    def _require_served(self, place: Place, ready: int) -> None:
        """Require a label for the robot once it has served the next stop in the window, if it can."""
        if place.window.lasts_until(ready):
            tick = ready - self._ticks(place.resource)
            message = f"a stop can be served in {place.resource} by {ready}, and must have a label for it"
            self._require_label(place, place.resource, place.window, place.served + 1, tick, message)

    def _require_labels(self, place: Place, target: ResourceId) -> None:
        """Require a label for every window of the target that can be entered early enough."""
        ticks = self._ticks(target)
        for window in self.traffic.windows(target, place.ready):
            if not place.window.lasts_until(window.start):
                return
            tick = max(place.ready, window.start)
            while self._is_possible(place, window, tick, ticks) and self.traffic.is_exchange(
                tick, place.resource, target
            ):
                tick += 1
            if self._is_possible(place, window, tick, ticks):
                message = f"{target} can be entered at {tick} from {place.resource}, and must have a label by then"
                self._require_label(place, target, window, place.served, tick, message)

    def _require_label(
        self, place: Place, resource: ResourceId, window: Window, served: int, tick: int, message: str
    ) -> None:
        if not self._is_late(resource, served, tick):
            first = self.layers[served].first_label(resource, window)
            _require(is_closed, is_closed(False, [(tick, first)]), place.path, message)

    def _is_possible(self, place: Place, window: Window, tick: int, ticks: int) -> bool:
        """Whether the robot can move into the window at the tick and stay there, exchanges aside."""
        return place.window.lasts_until(tick) and window.lasts_until(tick + ticks)


def _require(rule: Rule[..., bool], kept: bool, path: str, message: str) -> None:
    if not kept:
        raise Refusal("document", path, rule.id, message)
