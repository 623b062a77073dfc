"""Queries with certificates: the plan that arrives earliest, and the evidence that none arrives earlier."""

from collections.abc import Sequence
from dataclasses import replace

from carp_reference.problem import prepare
from carp_reference.query import Node, find_plan
from carp_spec import Instance, Plan, RobotId
from carp_spec.documents.query_certificates import QUERY_FORMAT, QueryCertificateDocument
from carp_spec.limits import refuse


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
        refuse(self._problem.instance, "stops")
        problem = replace(self._problem, now=now, before={} if followed is None else {robot: followed})
        ticks_to_goal = problem.ticks_to_goal[robot][-1]
        expanded: list[Node] = []
        plan = find_plan(problem, self._committed, robot, expanded=expanded)
        bound = None if plan is None else plan.visits[-1].enter
        labels = dict.fromkeys(
            (node.resource, node.enter)
            for node in expanded[1:]
            if bound is None or node.enter + ticks_to_goal[node.resource] < bound
        )
        certificate = QueryCertificateDocument(QUERY_FORMAT, robot, now, bound, (*labels,), (*ticks_to_goal.items(),))
        return plan, certificate
