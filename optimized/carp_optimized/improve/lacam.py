"""Plans of all robots together, step by step, where each move takes one tick (classical multi-agent path finding).

A configuration is the place of every robot at a tick. The search is LaCAM (Okumura 2023): depth-first over
configurations, each with ever longer demands on its successor, which fix the place of one more robot at a time.
Successors come from PIBT (Okumura et al. 2022): robots choose their places in order of priority, and a robot that
stands in a chosen place has to choose next. So crowds are planned for which no order of robots works. Totals are far
from the least; a polish lowers them. Nothing here is trusted: the law judges the plans.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random
from typing import TypeAlias

from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Plan, Visit

STEPS = 10_000
"""The search ends after this number of configurations; most searches that succeed need a few hundred."""
GONE = -1
"""The place of a robot that has vanished."""
NOWHERE = -2
Configuration: TypeAlias = tuple[int, ...]
"""The index of each robot's resource, or `GONE`."""


@dataclass(slots=True)
class _Node:
    """A configuration, how it was reached, and what is still to be tried from it.

    `order` begins with the robots that were at their goals longest ago, as `waiting` counts. Each of `demands` fixes
    the next places of the first robots in that order.
    """

    places: Configuration
    parent: "_Node | None"
    waiting: tuple[int, ...]
    order: tuple[int, ...]
    demands: deque[tuple[int, ...]]


def is_stepwise(instance: Instance) -> bool:
    """Whether all robots are there from tick 0, and each needs one tick and a place of its own."""
    return (
        instance.following == "allowed"
        and all(each.capacity == 1 and each.duration == 1 for each in instance.graph.resources)
        and all(each.release == 0 and each.pace == 1 for each in instance.robots)
    )


def plans_by_steps(instance: Instance, steps: int = STEPS) -> tuple[Plan, ...] | None:
    """Plans of all robots; `None` if the search finds none in that many steps, or the instance is not `is_stepwise`."""
    if not is_stepwise(instance):
        return None
    crowd = _Crowd(instance)
    if not crowd.can_begin():
        return None
    random = Random(0)  # noqa: S311 - not for secrets
    stack = [crowd.node(crowd.starts, None)]
    known = {stack[0].places: stack[0]}
    for _ in range(steps):
        node = stack[-1]
        if crowd.is_done(node.places):
            return crowd.plans(node)
        demands = node.demands.popleft()
        if len(demands) < len(node.order):
            robot = node.order[len(demands)]
            node.demands.extend((*demands, place) for place in crowd.choices(robot, node.places[robot], random))
        places = _successor(crowd, node, demands, random)
        if places is not None:
            stack.append(known.setdefault(places, crowd.node(places, node)))
        while stack and not stack[-1].demands:
            stack.pop()
        if not stack:
            return None
    return None


def _successor(crowd: "_Crowd", node: _Node, demands: Sequence[int], random: Random) -> Configuration | None:
    """A configuration that can follow and meets the demands; `None` if none is found."""
    step = _Step(crowd, node, random)
    for robot, place in zip(node.order, demands, strict=False):
        if not step.is_open(robot, place):
            return None
        step.take(robot, place)
    for robot in node.order:
        if step.waits(robot) and not step.choose(robot):
            return None
    return tuple(step.next)


class _Crowd:
    """The robots of an instance as numbers, with their distances to their goals."""

    def __init__(self, instance: Instance) -> None:
        graph = instance.graph
        self._instance = instance
        self._parks = instance.after_goal == "park"
        self.targets = [[graph.index[each] for each in graph.successors[one.id]] for one in graph.resources]
        self._goals = [graph.index[robot.goal] for robot in instance.robots]
        fleet = PlannedFleet(instance)
        far = len(self.targets)  # more than any way
        self.to_goal = [
            [potential.get(place, far) for place in range(far)]
            for potential in map(fleet.potential, range(len(self._goals)))
        ]
        self.starts: Configuration = tuple(graph.index[robot.start] for robot in instance.robots)

    def can_begin(self) -> bool:
        """Whether no two robots start in one place, or park in one, and each has a way to its goal."""
        starts = self.starts
        has_ways = all(table[start] < len(table) for table, start in zip(self.to_goal, starts, strict=True))
        goals_differ = not self._parks or len({*self._goals}) == len(self._goals)
        return has_ways and goals_differ and len({*starts}) == len(starts)

    def is_done(self, places: Configuration) -> bool:
        """Whether every robot is at its goal or gone."""
        return all(place in (goal, GONE) for place, goal in zip(places, self._goals, strict=True))

    def node(self, places: Configuration, parent: _Node | None) -> _Node:
        """A configuration from which nothing has been tried yet."""
        tick = len(self.targets) + 1  # longer than any way, so that robots that wait equally long differ by their ways
        if parent is None:
            waiting = tuple(table[place] for table, place in zip(self.to_goal, places, strict=True))
        else:
            waiting = tuple(
                before % tick if place == goal else before + tick
                for before, place, goal in zip(parent.waiting, places, self._goals, strict=True)
            )
        present = (robot for robot, place in enumerate(places) if not self._leaves(robot, place))
        return _Node(places, parent, waiting, tuple(sorted(present, key=lambda each: -waiting[each])), deque([()]))

    def _leaves(self, robot: int, place: int) -> bool:
        """Whether the robot is gone at the next tick."""
        return place == GONE or (place == self._goals[robot] and not self._parks)

    def choices(self, robot: int, place: int, random: Random) -> list[int]:
        """The places in which the robot can be next, the nearest to its goal first; equal ones in random order."""
        choices = [*self.targets[place], place]
        random.shuffle(choices)
        return sorted(choices, key=self.to_goal[robot].__getitem__)

    def plans(self, node: _Node) -> tuple[Plan, ...]:
        """The plans by which the robots get to this configuration."""
        ways: list[Configuration] = []
        last: _Node | None = node
        while last is not None:
            ways.append(last.places)
            last = last.parent
        ways.reverse()
        return tuple(
            Plan(robot.id, tuple(self._visits([places[k] for places in ways])))
            for k, robot in enumerate(self._instance.robots)
        )

    def _visits(self, way: list[int]) -> Iterator[Visit]:
        """The visits of a robot that is in these places, tick by tick."""
        present = [place for place in way if place != GONE]
        enter = 0
        for tick in range(1, len(present) + 1):
            is_last = tick == len(present)
            if is_last or present[tick] != present[enter]:
                leave = None if is_last and self._parks else tick
                yield Visit(self._instance.graph.resources[present[enter]].id, enter, leave)
                enter = tick


class _Step:
    """One tick: where the robots stand, and the places that they have chosen so far."""

    def __init__(self, crowd: _Crowd, node: _Node, random: Random) -> None:
        self._crowd = crowd
        self._random = random
        self._places = node.places
        self._stands = {node.places[robot]: robot for robot in node.order}
        self._takers: dict[int, int] = {}
        self.next = [GONE] * len(node.places)
        for robot in node.order:
            self.next[robot] = NOWHERE

    def is_open(self, robot: int, place: int) -> bool:
        """Whether the robot can be there next: nobody else has chosen the place, or comes from there to its own."""
        other = self._stands.get(place)
        return place not in self._takers and (other is None or self.next[other] != self._places[robot])

    def take(self, robot: int, place: int) -> None:
        """Choose the place for the robot."""
        self.next[robot] = place
        self._takers[place] = robot

    def choose(self, first: int) -> bool:
        """Choose places for the robot and for those in its way; `False` if it has to stay because they cannot leave."""
        turns = [self._turn(first)]
        while turns:
            robot = turns[-1].robot
            place = next((each for each in turns[-1].wishes if self.is_open(robot, each)), None)
            if place is None:
                self.take(robot, self._places[robot])
                turns.pop()
                continue
            self.take(robot, place)
            other = self._stands.get(place)
            if other is None or not self.waits(other):
                self._pull(turns)
                return True
            turns.append(self._turn(other))
        return False

    def _turn(self, robot: int) -> "_Turn":
        """The robot's wishes: from the nearest to its goal, or from the farthest if it has to let a partner pass."""
        wishes = self._crowd.choices(robot, self._places[robot], self._random)
        partner = self._partner(robot, wishes[0])
        if partner is not None:
            wishes.reverse()
        return _Turn(robot, iter(wishes), wishes[0], partner)

    def _pull(self, turns: Sequence["_Turn"]) -> None:
        """Let partners follow into the places that are left for them."""
        for turn in reversed(turns):
            left = self._places[turn.robot]
            is_first = self.next[turn.robot] == turn.first
            if turn.partner is not None and is_first and self.waits(turn.partner) and self.is_open(turn.partner, left):
                self.take(turn.partner, left)

    def _partner(self, robot: int, wish: int) -> int | None:
        """The robot with which this one has to change places, and can, by leaving for a junction with it behind."""
        here = self._places[robot]
        if wish == here:
            return None
        other = self._stands.get(wish)
        if other is not None and self.waits(other) and self._must_swap(robot, other, here, wish):
            return other if self._can_swap(wish, here) else None
        for place in self._crowd.targets[here]:
            other = self._stands.get(place)
            if other is None or place == wish:
                continue
            if self._must_swap(other, robot, here, wish) and self._can_swap(wish, here):
                return other
        return None

    def waits(self, robot: int) -> bool:
        """Whether the robot has still to choose."""
        return self.next[robot] == NOWHERE

    def _must_swap(self, pusher: int, puller: int, behind: int, ahead: int) -> bool:
        """Whether the pusher, driving the puller ahead of it, gets nowhere before they have changed places."""
        to_goal = self._crowd.to_goal
        while to_goal[pusher][ahead] < to_goal[pusher][behind]:
            ways = self._ways_on(behind, ahead)
            if len(ways) > 1:
                return False
            if not ways:
                break
            behind, ahead = ahead, ways[0]
        return to_goal[puller][behind] < to_goal[puller][ahead] and (
            to_goal[pusher][behind] == 0 or to_goal[pusher][ahead] < to_goal[pusher][behind]
        )

    def _can_swap(self, behind: int, ahead: int) -> bool:
        """Whether the way on from `ahead` leads to a junction, where two robots can change places."""
        origin = behind
        for _ in self._crowd.targets:
            ways = self._ways_on(behind, ahead)
            if len(ways) != 1 or ahead == origin:
                return len(ways) > 1 and ahead != origin
            behind, ahead = ahead, ways[0]
        return False

    def _ways_on(self, behind: int, ahead: int) -> list[int]:
        """The places next to `ahead`, but for the one behind and dead ends in which a robot is at its goal."""
        return [each for each in self._crowd.targets[ahead] if each != behind and not self._is_shut(each)]

    def _is_shut(self, place: int) -> bool:
        robot = self._stands.get(place)
        return robot is not None and len(self._crowd.targets[place]) == 1 and self._crowd.to_goal[robot][place] == 0


@dataclass(slots=True)
class _Turn:
    """A robot that chooses: its wishes not yet tried, the first of all, and the partner that follows it there."""

    robot: int
    wishes: Iterator[int]
    first: int
    partner: int | None
