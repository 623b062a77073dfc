"""Ground truth for tiny instances: the least total cost, by Dijkstra over the states of all robots together.

It moves all robots tick by tick, straight from the rules, and shares nothing with the encoding. Its states are finite
in number, because the tick counts only up to the last release. So the search also ends where no plan set exists.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import combinations, product
from math import prod
from typing import Literal, TypeAlias

from carp_spec import Instance, ResourceId, Robot
from carp_spec.inputs.values import require_instance
from carp_verify.optimum.rules import LARGEST_SEARCH, LARGEST_STEPS, refuse_size

Phase: TypeAlias = Literal["waits", "moves", "arrived"]


@dataclass(frozen=True, slots=True)
class State:
    """The state of one robot at a tick.

    It waits for its release (in no resource), moves (in a resource that it must not leave for `ticks` ticks, this one
    counted), or has arrived (it stays for `ticks` more ticks, or for ever with `None`; then it is in no resource). It
    has served so many stops; if the next one is here, its service takes `service` ticks more.
    """

    phase: Phase
    resource: ResourceId | None
    ticks: int | None
    served: int = 0
    service: int = 0


Joint: TypeAlias = tuple[State, ...]
WAITS = State("waits", None, None)
GONE = State("arrived", None, 0)


class _Search:
    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        self.constraints = instance.graph.constraints
        self.last_release = max((robot.release for robot in instance.robots), default=0)
        self.width = max((len(instance.graph.constraints_of(each)) for each in instance.graph.index), default=1)
        self.steps = 0

    def entering(self, robot: Robot, resource: ResourceId, served: int) -> Iterator[State]:
        """The states of a robot that enters a resource now: on its way, and at its last stop also arrived."""
        stop = robot.stops[served]
        is_last, is_here = served == len(robot.stops) - 1, stop.resource == resource
        service = stop.service if is_here and not is_last else 0
        yield State("moves", resource, self.instance.duration(robot.id, resource), served, service)
        if is_here and is_last:
            stay = self.instance.stay(robot.id, stop)
            yield State("arrived", resource, None if self.instance.after_goal == "park" else stay)

    def at(self, robot: Robot, tick: int, before: State) -> Iterator[State]:
        """The states in which a robot can be at the tick, after its state at the tick before."""
        if before.phase == "waits":
            if robot.release == tick:
                yield from self.entering(robot, robot.start, 0)
            else:
                yield WAITS
        elif before.phase == "arrived":
            stays = before.ticks is None or before.ticks > 1
            yield State("arrived", before.resource, before.ticks and before.ticks - 1) if stays else GONE
        elif before.ticks is not None and before.resource is not None:
            further = max(before.ticks - 1, 1), before.served, max(before.service - 1, 0)
            yield State("moves", before.resource, *further)
            if before.ticks <= 1:
                served = before.served + self.serves(robot, before)
                for target in self.instance.graph.successors[before.resource]:
                    yield from self.entering(robot, target, served)

    def serves(self, robot: Robot, state: State) -> bool:
        """Whether a robot that leaves after this tick has served its next stop, which is not the last one."""
        is_last = state.served == len(robot.stops) - 1
        return not is_last and robot.stops[state.served].resource == state.resource and state.service <= 1

    def is_allowed(self, before: Sequence[State], after: Sequence[State]) -> bool:
        """Whether `joint/capacity` and `joint/group` hold now and `joint/exchange` on the way here.

        Where following is forbidden, a robot also counts for the tick after it has left.
        """
        present = Counter(each for states in zip(after, before, strict=True) for each in self.limits_of(*states))
        if any(count > self.constraints[each].capacity for each, count in present.items()):
            return False
        moves = [
            (old.resource, new.resource)
            for old, new in zip(before, after, strict=True)
            if old.resource is not None and new.resource is not None and old.resource != new.resource
        ]
        return not any(
            self.instance.graph.are_close(source, to) and self.instance.graph.are_close(target, away)
            for (source, target), (away, to) in combinations(moves, 2)
        )

    def limits_of(self, after: State, before: State) -> set[int]:
        """The constraints that count a robot in this state."""
        states = (after, before) if self.instance.following == "forbidden" else (after,)
        graph = self.instance.graph
        return {each for state in states if state.resource is not None for each in graph.constraints_of(state.resource)}

    def following(self, tick: int, before: Joint) -> Iterator[Joint]:
        """The joint states at the tick after one at the tick before; all steps to them are counted before the first."""
        choices = [list(self.at(robot, tick, state)) for robot, state in zip(self.instance.robots, before, strict=True)]
        self.steps += self.width * prod(map(len, choices))
        steps = "the joint steps that the search looks at, by the most constraints of a resource,"
        refuse_size(steps, self.steps, LARGEST_STEPS)
        for after in product(*choices):
            if self.is_allowed(before, after):
                yield after


def joint_states(instance: Instance, most: int = LARGEST_SEARCH) -> int:
    """An upper bound on the number of joint states of all robots, apart from the tick; beyond `most` it may be low.

    A robot is in a resource, with a number of ticks to stay and of stops served, or waits for its release, or is gone
    or parked.
    """
    states, resources = 1, instance.graph.resources
    durations = sum(resource.duration for resource in resources)
    for robot in instance.robots:
        layer = robot.pace * durations + len(resources)
        states *= 2 + len(robot.stops) * layer + sum(stop.service for stop in robot.stops)
        if states > most:
            break
    return states


def least_total_cost(
    instance: Instance, most: int = LARGEST_SEARCH, on_step: Callable[[], None] | None = None
) -> int | None:
    """The least total cost of plans for all robots, or `None` if there are none.

    Raises `Refusal` before more than `most` joint states, or `LARGEST_STEPS` steps, are looked at; `on_step` is called
    at each state, and may raise.
    """
    require_instance(instance)
    search = _Search(instance)
    queue: list[tuple[int, int, int, Joint]] = [(0, 0, -1, tuple(WAITS for _ in instance.robots))]
    settled: set[tuple[int, Joint]] = set()
    queued = 1
    while queue:
        cost, _, tick, joint = heappop(queue)
        if (tick, joint) in settled:
            continue
        settled.add((tick, joint))
        if on_step is not None:
            on_step()
        if all(state.phase == "arrived" for state in joint):
            return cost
        ahead = min(tick + 1, search.last_release + 1)
        step = sum(state.phase == "moves" for state in joint)
        for after in search.following(ahead, joint):
            if (ahead, after) not in settled:
                queued += 1
                refuse_size("the joint states that the search looks at", queued, most)
                heappush(queue, (cost + step, queued, ahead, after))
    return None
