"""Queries with certificates: the plan that arrives earliest, and the evidence that none arrives earlier."""

from collections.abc import Sequence

from carp_optimized.fleet import PlannedFleet
from carp_spec import Instance, Plan, RobotId
from carp_spec.documents.query_certificates import QueryCertificateDocument, ServedLayer, certificate_of
from carp_spec.plan_rules import stops_left


class Certifier:
    """Plans robots one by one beside plans that are committed, each with its certificate."""

    def __init__(self, instance: Instance) -> None:
        """Begin without plans. Raises `Refusal` if the instance has numbers that are too large."""
        self._instance = instance
        self._fleet = PlannedFleet(instance, shortcuts=False)
        self._ids = [resource.id for resource in instance.graph.resources]

    def commit(self, plans: Sequence[Plan]) -> None:
        """Add plans that break no rule together with those committed."""
        self._fleet.commit(plans)

    def certify(
        self, robot: RobotId, followed: Plan | None = None, now: int = 0
    ) -> tuple[Plan | None, QueryCertificateDocument]:
        """The plan of the robot that arrives earliest, `None` if it has none, and its certificate.

        `followed` is the plan that the robot has followed until the tick `now`. The labels are the windows expanded
        from which the goal is not reached at the bound or later.
        """
        index = self._fleet.index(robot)
        plan, expanded = self._fleet.find_with_labels(index, followed, now)
        bound = None if plan is None else plan.visits[-1].enter
        layers = [
            ServedLayer(
                labels=tuple(
                    (self._ids[resource], tick)
                    for resource, tick in labels
                    if bound is None or tick + potential[resource] < bound
                ),
                potential=tuple(zip(map(self._ids.__getitem__, potential), potential.values(), strict=True)),
            )
            for labels, potential in zip(expanded, self._fleet.potentials(index), strict=True)
        ]
        left = len(stops_left(self._instance.robot[robot], followed, now))
        return plan, certificate_of(robot, now, bound, layers[-left:])
