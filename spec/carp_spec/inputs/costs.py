"""Costs of plans, and stops that visits serve, where any may be malformed."""

from collections.abc import Sequence
from typing import cast

from carp_spec import plan_rules
from carp_spec.inputs.values import require_instance
from carp_spec.model import Instance, Plan, RobotId, Stop, Visit
from carp_spec.refusal import Refusal
from carp_spec.shapes import require_each, require_shape


def plan_cost(instance: Instance, plan: Plan) -> int:
    """The ticks from the robot's release to the entry of the last visit.

    Raises `Refusal` for a malformed instance or plan, for a robot that the instance does not have, and where there is
    no visit.
    """
    require_instance(instance)
    return _cost(instance, plan, "$")


def total_cost(instance: Instance, plans: Sequence[Plan]) -> int:
    """The sum of costs of the plans; raises `Refusal` as `plan_cost` does."""
    require_instance(instance)
    if not isinstance(cast("object", plans), Sequence):
        require_each(plans, Plan, "$.plans")
    return sum(_cost(instance, plan, f"$.plans[{place}]") for place, plan in enumerate(plans))


def makespan(instance: Instance, plans: Sequence[Plan]) -> int:
    """The latest tick at which a plan enters its last visit, 0 without plans; raises `Refusal` as `plan_cost` does."""
    total_cost(instance, plans)
    return max((plan.visits[-1].enter for plan in plans), default=0)


def stops_served(stops: Sequence[Stop], visits: Sequence[Visit]) -> int:
    """How many of the stops the visits have served, in order: each that is left serves the next stop if it can.

    Raises `Refusal` for malformed stops and visits.
    """
    require_each(stops, Stop, "$.stops")
    require_each(visits, Visit, "$.visits")
    return plan_rules.stops_served(stops, visits)


def _cost(instance: Instance, plan: Plan, path: str) -> int:
    if type(plan) is not Plan or type(plan.visits) is not tuple or not all(map(_is_entered, plan.visits[-1:])):
        require_shape(plan, Plan, path)
    if not plan.visits:
        raise Refusal("request", path, plan_rules.plan_starts_at_release.id, "there is no visit")
    if type(plan.robot) not in (str, int) or plan.robot not in instance.robot:
        require_shape(plan.robot, RobotId, f"{path}.robot")
        raise Refusal("request", path, "solution/covers", "the instance has no such robot")
    return plan_rules.plan_cost(instance, plan)


def _is_entered(visit: object) -> bool:
    return type(visit) is Visit and type(visit.enter) is int
