"""What part of an instance a search or a checker does not know, and so refuses: `limit/...`."""

from carp_spec.model import Instance
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, rule


@rule("limit/stops", "What knows goals alone refuses robots with several stops or with service.", DESIGN)
def goals_stand_alone(instance: Instance) -> bool:  # noqa: D103 - its statement stands in its decorator
    return all(robot.has_goal_alone for robot in instance.robots)


def refuse_stops(instance: Instance) -> None:
    """Raise `Refusal` if a robot has more than a goal."""
    if not goals_stand_alone(instance):
        message = "each robot must have a goal alone here: not all searches and checkers know robots with stops"
        raise Refusal("limit", "$.robots", goals_stand_alone.id, message)
