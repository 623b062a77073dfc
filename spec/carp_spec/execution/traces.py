"""Traces: what robots have done by a tick."""

from collections.abc import Mapping
from dataclasses import dataclass

from carp_spec.model import Plan, RobotId, Visit


@dataclass(frozen=True, slots=True)
class Trace:
    """The visits that robots have entered by the tick `now`, that tick included.

    A visit not left yet has a leave of `None`, and a robot that has not appeared yet no visits.
    """

    now: int
    plans: tuple[Plan, ...]

    @property
    def happened(self) -> Mapping[tuple[RobotId, int], Visit]:
        """The visits by robot and position in its plan."""
        return {(plan.robot, place): visit for plan in self.plans for place, visit in enumerate(plan.visits)}
