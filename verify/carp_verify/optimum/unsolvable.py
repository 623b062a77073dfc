"""The reasons why no plan set exists: the obstacles, and the check of each.

- `no-way`: no moves lead from the robot's start over its stops to its goal.
- `full-goal`: robots park, and more of them have this goal than its capacity. When the last arrives, all are there.
- `clauses`: the encoding of the instance with these horizons and without any bound on the delays has no model. All
  conflicts are forbidden, and robots later than their horizons are left free, so any plan set would be a model.
- `states`: a search over the states of all robots together finds no end (`carp_verify.optimum.joint_search`). After
  the last release the rules do not look at the clock, so a plan set that is in one joint state twice can be cut
  between; hence the states, without the later ticks, are all that can happen. Only few states are searched.

The checks share no code with the search for an optimum. The refutation of clauses is checked by
`carp_verify.optimum.proof`.
"""

from itertools import pairwise
from typing import TypeAlias

import msgspec

from carp_spec import Instance, Refusal, ResourceId, RobotId
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.joint_search import joint_states, least_total_cost
from carp_verify.optimum.rules import LARGEST_TABLE, size_is_bounded

FEW_STATES = 2_000_000


class NoWay(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="no-way"):
    """A robot has no way to its goal."""

    robot: RobotId


class FullGoal(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="full-goal"):
    """More robots are to park in a resource than its capacity."""

    goal: ResourceId


class Clauses(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="clauses"):
    """However late the robots are, they break a joint rule; one horizon for each robot."""

    horizons: tuple[int, ...]


class States(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="states"):
    """None of all joint states is the end of a plan set."""


Obstacle: TypeAlias = NoWay | FullGoal | Clauses | States


def describe(instance: Instance, obstacle: Obstacle) -> str:
    """The obstacle in a sentence; its robot or goal must be one of the instance."""
    match obstacle:
        case NoWay(id):
            robot = instance.robot[id]
            over = "" if len(robot.stops) == 1 else " over its other stops"
            return f"no way leads from {robot.start}{over} to {robot.goal}, the goal of robot {robot.id}"
        case FullGoal(goal):
            capacity = instance.graph.resource[goal].capacity
            return f"{_parkers(instance, goal)} robots are to park in {goal}, which has a capacity of {capacity}"
        case Clauses():
            return "robots are in one place, or exchange places, however late they are"
        case States():
            return "a search over all states of the robots together finds no plan set"


def why_no_obstacle(instance: Instance, obstacle: Obstacle) -> str | None:
    """The reason why the instance does not have the obstacle, `None` if it has it; clauses are still to be refuted."""
    match obstacle:
        case NoWay(id):
            return _why_way(instance, id)
        case FullGoal(goal):
            return _why_room(instance, goal)
        case Clauses(horizons):
            return _why_no_clauses(instance, horizons)
        case States():
            return _why_end(instance)


def is_searched(instance: Instance) -> bool:
    """Whether the joint states, at all ticks up to the last release and one more, are few enough to be searched."""
    last_release = max((robot.release for robot in instance.robots), default=0)
    return joint_states(instance, FEW_STATES) * (last_release + 2) <= FEW_STATES


def _why_way(instance: Instance, id: RobotId) -> str | None:
    if id not in instance.robot:
        return f"the instance has no robot {id}"
    robot = instance.robot[id]
    size = len(robot.stops) * len(instance.graph.resources)
    if not size_is_bounded(size, LARGEST_TABLE):
        return f"its stops by the resources are {size}, and at most {LARGEST_TABLE} are allowed"
    places = [robot.start, *(stop.resource for stop in robot.stops)]
    if all(_leads_to(instance, *leg) for leg in pairwise(places)):
        return f"there is a way from {' to '.join(map(str, places))}"
    return None


def _leads_to(instance: Instance, place: ResourceId, goal: ResourceId) -> bool:
    reached = {place}
    ahead = [place]
    while ahead:
        for target in instance.graph.successors[ahead.pop()]:
            if target not in reached:
                reached.add(target)
                ahead.append(target)
    return goal in reached


def _why_room(instance: Instance, goal: ResourceId) -> str | None:
    if instance.after_goal != "park":
        return "robots do not park"
    if goal not in instance.graph.resource:
        return f"the instance has no resource {goal}"
    capacity, robots = instance.graph.resource[goal].capacity, _parkers(instance, goal)
    return f"{goal} has room for {capacity} robots, and {robots} park there" if robots <= capacity else None


def _parkers(instance: Instance, goal: ResourceId) -> int:
    return sum(robot.goal == goal for robot in instance.robots)


def _why_no_clauses(instance: Instance, horizons: tuple[int, ...]) -> str | None:
    if len(horizons) != len(instance.robots) or any(horizon < 0 for horizon in horizons):
        return f"it must have a horizon, no less than 0, of each of {len(instance.robots)} robots"
    if Encoding(instance).wayless:
        return "a robot has no way to its goal, and so no clauses"
    return None


def _why_end(instance: Instance) -> str | None:
    if not is_searched(instance):
        return f"the joint states may be more than {FEW_STATES}"
    try:
        cost = least_total_cost(instance)
    except Refusal as refusal:
        return refusal.message
    return None if cost is None else f"a plan set costs {cost}"
