"""What part of an instance a search or a checker does not know, and so refuses: `limit/...`."""

from collections.abc import Mapping
from typing import Literal, TypeAlias

from carp_spec.model import Instance
from carp_spec.refusal import Refusal
from carp_spec.rule import DESIGN, Rule, rule

Feature: TypeAlias = Literal["stops"]


@rule("limit/stops", "What knows goals alone refuses robots with several stops or with service.", DESIGN)
def goals_stand_alone(instance: Instance) -> bool:  # noqa: D103 - its statement stands in its decorator
    return all(robot.has_goal_alone for robot in instance.robots)


LIMITS: Mapping[Feature, tuple[Rule[[Instance], bool], str, str]] = {
    "stops": (
        goals_stand_alone,
        "$.robots",
        "each robot must have a goal alone here: not all searches and checkers know robots with stops",
    ),
}


def refuse(instance: Instance, *features: Feature) -> None:
    """Raise `Refusal` if the instance has one of the features."""
    for keeps, path, message in (LIMITS[feature] for feature in features):
        if not keeps(instance):
            raise Refusal("limit", path, keeps.id, message)
