"""Queries with certificates: the plan that arrives earliest, and the evidence that none arrives earlier."""

from collections.abc import Sequence
from dataclasses import replace

from carp_reference.problem import prepare
from carp_reference.query import find_plan, nodes_before_arrival
from carp_spec import Instance, Plan, RobotId
from carp_spec.documents.query_certificates import QueryCertificateDocument, ServedLayer, certificate_of
from carp_spec.plan_rules import stops_left


class Certifier:
    """Plans robots beside committed plans, each with its certificate."""

    def __init__(self, instance: Instance) -> None:
        self._problem = prepare(instance, 0)
        self._committed: list[Plan] = []

    def commit(self, plans: Sequence[Plan]) -> None:
        """Add plans that break no rule together with those committed."""
        self._committed.extend(plans)

    def certify(
        self, robot: RobotId, followed: Plan | None = None, now: int = 0
    ) -> tuple[Plan | None, QueryCertificateDocument]:
        """The plan of the robot that arrives earliest, `None` if it has none, and its certificate.

        `followed` is its plan until the tick `now`. The labels are the nodes expanded after the start from which the
        goal is reached before the bound.
        """
        instance = self._problem.instance
        problem = replace(self._problem, now=now, before={} if followed is None else {robot: followed})
        plan = find_plan(problem, self._committed, robot)
        expanded = nodes_before_arrival(problem, self._committed, robot)
        bound = None if plan is None else plan.visits[-1].enter
        left = len(stops_left(instance.robot[robot], followed, now))
        layers = []
        for served, potential in [*enumerate(problem.ticks_to_goal[robot])][-left:]:
            nodes = [node for node in expanded if node.served == served]
            ticks = [(node.resource, node.ready - instance.duration(robot, node.resource)) for node in nodes]
            labels = [label for label in ticks if bound is None or label[1] + potential[label[0]] < bound]
            layers.append(ServedLayer((*dict.fromkeys(labels),), (*potential.items(),)))
        return plan, certificate_of(robot, now, bound, layers)
