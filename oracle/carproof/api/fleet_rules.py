"""What a fleet in memory requires of news: no tick that has passed, robots of its own, and no more than it holds."""

from collections.abc import Container
from dataclasses import replace

from carp_spec import Instance, Refusal, ResourceId, Robot, RobotId, Stop
from carp_spec.instance_rules import ROBOT_RULES
from carp_spec.rule import DESIGN
from carp_spec.shapes import require_shape
from carproof.input_rules import Code

MOST_ROBOTS = 10_000
MOST_STOPS = 64
MOST_VISITS = 4_000_000
NOT_BACK = Code(
    "fleet/now",
    "News for a fleet have no earlier tick than those before, and a robot to add is released no earlier than its news. "
    "A trace keeps what traces before it told of the robots that they named.",
    DESIGN,
)
OWN_ROBOTS = Code(
    "fleet/robot",
    "A robot to add has an id that no robot of the fleet has; one that gets stops or is removed is in the fleet, "
    "and so are those of a trace.",
    DESIGN,
)
FEW_ROBOTS = Code(
    "fleet/size",
    f"A fleet has at most {MOST_ROBOTS} robots, each with at most {MOST_STOPS} stops. It gets no more robots and stops "
    f"while its plans have more than {MOST_VISITS} visits. What is done counts until it is forgotten.",
    DESIGN,
)


def require_own(robot: RobotId, robots: Container[RobotId], path: str) -> None:
    """Raise `Refusal` unless the robot is one of the fleet's."""
    require_shape(robot, RobotId, path)
    if robot not in robots:
        message = f"it must be a robot of the fleet, which has no {robot!r}"
        raise Refusal("request", path, OWN_ROBOTS.id, message)


def require_new(robots: tuple[Robot, ...], empty: Instance, own: Container[RobotId], now: int) -> None:
    """Raise `Refusal` unless the robots are right, of ids that none of the fleet has, and released no earlier than now.

    `empty` is the instance of the fleet without robots.
    """
    if len(robots) != 1 or not _is_right(robots[0], empty.graph.index):
        require_shape(robots, tuple[Robot, ...], "$.robots")
        alone = replace(empty, robots=robots)
        for rule in ROBOT_RULES:
            for fault in rule(alone):
                raise Refusal("document", fault.path, fault.rule, fault.message)
    for place, robot in enumerate(robots):
        path = f"$.robots[{place}]"
        if robot.id in own:
            message = f"the id must be new to the fleet, which has a robot {robot.id!r}"
            raise Refusal("request", f"{path}.id", OWN_ROBOTS.id, message)
        require_time(robot, now, path)


def _is_right(robot: Robot, places: Container[ResourceId]) -> bool:
    """Whether it is seen quickly that a robot with one stop has the right types and keeps the rules of robots."""
    if type(robot) is not Robot or type(robot.stops) is not tuple or [*map(type, robot.stops)] != [Stop]:
        return False
    stop = robot.stops[0]
    names, numbers = (robot.id, robot.start, stop.resource), (robot.release, robot.pace, stop.service)
    if not ({*map(type, names)} <= {str, int} and {*map(type, numbers)} == {int}):
        return False
    is_there = robot.start in places and stop.resource in places
    return is_there and robot.release >= 0 and robot.pace >= 1 and stop.service >= 0


def require_time(robot: Robot, now: int, path: str) -> None:
    """Raise `Refusal` for a robot that is released before the tick at which it is added."""
    if robot.release < now:
        message = f"the release must be at least {now}, the tick at which it is added, and is {robot.release}"
        raise Refusal("request", f"{path}.release", NOT_BACK.id, message)
