"""Audits a solution: whether each plan is optimal beside those before it in the planning order.

The audit's planner is not trusted. A plan counts as optimal if a certificate that none arrives earlier is accepted
(`carp_verify.query.verify`). It counts as late if an earlier plan breaks no rule. If neither holds, carproof has a
fault. An audit does not judge the choice between plans that arrive at the same tick, the order itself, or robots
without a plan.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field

import msgspec

from carp_optimum.deadline import TimeOver
from carp_spec import Instance, Plan, Refusal, RobotId, Solution
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.documents.solutions import solution_document
from carp_verify.bound.rules import ContradictionError
from carp_verify.kernel import ask, request
from carp_verify.query.rules import plans_are_lawful, size_fits
from carp_verify.query.verify import Traffic, require_certificate
from carproof.engines import Engine

CHECKER = "carp_verify"


@dataclass(frozen=True, slots=True)
class Late:
    """A plan, and one with which its robot arrives earlier, both beside the plans before it."""

    plan: Plan
    earlier: Plan
    before: tuple[Plan, ...]


@dataclass(slots=True)
class Audit:
    """The findings of an audit, in the order in which it looked at the plans, and the checker that decided.

    What it had no time to look at is undecided. The certificates are in JSON: those of 1,000 robots may have millions
    of potentials.
    """

    certified: list[Plan] = field(default_factory=list)
    certificates: list[msgspec.Raw] = field(default_factory=list)
    late: list[Late] = field(default_factory=list)
    undecided: list[Plan] = field(default_factory=list)
    by: str = CHECKER

    @property
    def holds(self) -> bool:
        """Whether each plan is certified."""
        return not self.late and not self.undecided


class Beside:
    """The best plans beside those committed so far: the planner is not trusted, and what it finds is checked."""

    def __init__(self, instance: Instance, engine: Engine, goes_on: Callable[[], bool] = lambda: True) -> None:
        self._instance = instance
        self._certifier = engine.certifier(instance)
        self._goes_on = goes_on
        self._traffic = Traffic(instance, self.look)
        self.committed: list[Plan] = []

    def look(self) -> None:
        """Look at the clock; raises `TimeOver`, which ends what is at work, where it is not to go on."""
        if not self._goes_on():
            raise TimeOver

    def commit(self, plan: Plan) -> None:
        """Commit a plan; the next ones are compared beside it."""
        self._certifier.commit([plan])
        self._traffic.commit(plan)
        self.committed.append(plan)

    def has_room(self, plan: Plan) -> bool:
        """Whether the committed plans leave room for the plan."""
        return self._traffic.allows(plan.visits)

    def best(
        self, robot: RobotId, followed: Plan | None = None, now: int = 0
    ) -> tuple[Plan | None, QueryCertificateDocument]:
        """The best plan of a robot that has followed a plan until now, which breaks no rule, and a certificate."""
        plan, certificate = self._certifier.certify(robot, followed, now)
        if plan is not None and not (self.has_room(plan) and plans_are_lawful(self._instance, [plan])):
            raise ContradictionError(f"the plan found for robot {robot} breaks a rule")
        return plan, certificate

    def require(self, certificate: QueryCertificateDocument, followed: Plan | None = None) -> None:
        """Check a certificate; raises `Refusal` where that would take too long."""
        try:
            require_certificate(self._traffic, certificate, followed)
        except Refusal as refusal:
            if refusal.rule == size_fits.id:
                raise
            message = f"the certificate of robot {certificate.robot} was refused: {refusal}"
            raise ContradictionError(message) from refusal


def _earlier_plan(beside: Beside, audit: Audit, plan: Plan, followed: Plan | None = None, now: int = 0) -> Plan | None:
    """A plan that arrives earlier, of a robot that has followed a plan until now; without one this is certified."""
    best, certificate = beside.best(plan.robot, followed, now)
    if best is not None and best.visits[-1].enter < plan.visits[-1].enter:
        return best
    if best is None or best.visits[-1].enter > plan.visits[-1].enter:
        raise ContradictionError(f"robot {plan.robot} has a plan that was not found")
    beside.require(certificate, followed)
    audit.certified.append(plan)
    audit.certificates.append(msgspec.Raw(msgspec.json.encode(certificate)))
    return None


def audit_in_order(  # noqa: PLR0913 - how long, and what robots have followed until when
    instance: Instance,
    solution: Solution,
    engine: Engine,
    advance: Callable[[], None] = lambda: None,
    goes_on: Callable[[], bool] = lambda: True,
    *,
    followed: Mapping[RobotId, Plan | None] | None = None,
    now: int = 0,
) -> Audit:
    """Audit a solution that breaks no rule in its planning order, as long as there is time.

    With `followed`, only the plans of its robots, each with the plan that the robot has followed until now.
    """
    beside, audit = Beside(instance, engine, goes_on), Audit()
    plans = [*in_order(solution)]
    with suppress(TimeOver):
        for plan in plans:
            beside.look()
            if followed is None or plan.robot in followed:
                earlier = _earlier_plan(beside, audit, plan, (followed or {}).get(plan.robot), now)
                if earlier is not None:
                    audit.late.append(Late(plan, earlier, tuple(beside.committed)))
            beside.commit(plan)
            advance()
    audit.undecided = plans[len(beside.committed) :]
    return audit


def audit_in_some_order(
    instance: Instance,
    solution: Solution,
    engine: Engine,
    advance: Callable[[], None] = lambda: None,
    goes_on: Callable[[], bool] = lambda: True,
) -> Audit:
    """Audit a solution that breaks no rule in an order in which each plan is optimal, if there is one.

    A plan that is optimal beside some plans stays optimal beside more of them, which leave less room. So every plan can
    be committed as soon as it is optimal. If none of the rest is optimal, no such order exists: the first of the rest
    would be late in it. A plan stays late as long as there is room for the earlier one that was found. If the time is
    over before, the rest is undecided.
    """
    beside, audit = Beside(instance, engine, goes_on), Audit()
    waiting: list[tuple[Plan, Plan | None]] = [(plan, None) for plan in in_order(solution)]
    is_moving = True
    while is_moving:
        is_moving, asked, waiting = False, waiting, []
        for number, (plan, known) in enumerate(asked):
            try:
                beside.look()
                earlier = known if known is not None and beside.has_room(known) else _earlier_plan(beside, audit, plan)
            except TimeOver:
                audit.undecided = [each for each, _ in (*waiting, *asked[number:])]
                return audit
            if earlier is None:
                beside.commit(plan)
                is_moving = True
                advance()
            else:
                waiting.append((plan, earlier))
    for plan, earlier in waiting:
        if earlier is not None:
            audit.late.append(Late(plan, earlier, tuple(beside.committed)))
    return audit


def in_order(solution: Solution) -> Iterator[Plan]:
    """The plans in planning order."""
    plans = {plan.robot: plan for plan in solution.plans}
    return (plans[robot] for robot in solution.order)


def ask_kernel(instance: Instance, audit: Audit) -> None:
    """Let the kernel decide: the certificates of all plans, or that each earlier plan found breaks no rule.

    Raises `ContradictionError` if it decides otherwise.
    """
    if not audit.late:
        document = solution_document(Solution.of(instance, audit.certified))
        requests = [request("audit", instance, solution=document, certificates=audit.certificates)]
    else:
        solutions = [Solution.of(instance, (*late.before, late.earlier)) for late in audit.late]
        requests = [request("check", instance, solution=solution_document(each)) for each in solutions]
    for answer in ask(requests):
        if not answer.accepted:
            raise ContradictionError(f"{CHECKER} and {answer.by} differ: {answer.message} [{answer.rule}]")
        audit.by = answer.by
