"""In which visits a plan serves stops."""

from collections.abc import Mapping

from carp_spec import Instance, Plan
from carp_spec.plan_rules import stops_served


def stops_in(instance: Instance, plan: Plan) -> Mapping[int, int]:
    """The places of the visits in which a plan serves its stops, each with the place of the stop.

    Every stop but the last is served as soon as a visit allows it, the last one in the last visit.
    """
    *stops, _ = instance.robot[plan.robot].stops
    serves: dict[int, int] = {}
    for place, visit in enumerate(plan.visits[:-1]):
        if stops_served(stops[len(serves) :][:1], (visit,)):
            serves[place] = len(serves)
    if plan.visits and len(serves) == len(stops):
        serves[len(plan.visits) - 1] = len(stops)
    return serves
