"""Checks the certificate of a lower bound: whole numbers, the standard library, and nothing of what found it.

The bound holds by weak duality of Lagrangian relaxation. Take any plans of all robots that break no rule together. They
pay at most the prices times the capacities (the rows of prices and their capacities are below). The weighted cost of
each robot, together with its payments, is at least the least that `least_cost` finds for it. With a cut, a part of its
robots' costs is counted in the cut instead, and their sum is at least the total that the cut proves. The
kernel's theorem is `accepted_bound_is_below_every_solution`.

- The price of a deadline is paid by each robot of its group that enters its goal for the last time at its tick or
  before: by all of the group but one, at most, because its formula has no model. To come late is free of it, so a
  robot that vanishes at its goal may gain by driving through the goal and on. Then it is searched for that, too.
- A robot that is seen at a tick pays if it has come by then, and by the deadline. On its way it pays if it is in one of
  its places at the tick: once, as it is in one place. One that is seen at more ticks pays for each.

- A price of a resource r at a tick t is paid by all who are in r at t: at most the capacity of r, by `joint/capacity`.
- A price of a group at a tick is paid by all who are in one of its resources at the tick: at most the capacity of the
  group, by `joint/group`. A robot in a resource pays the prices of all its groups.
- An exchange price of (r, s) at t is paid by all who move from r to s or from s to r at t, and by all who are in r both
  just before t and at t. No more of them than the capacity of r: by `joint/exchange` nobody makes one of the moves;
  those who make the other are in r just before t, or at t, together with those who stay.
- At the horizon the prices end, but plans need not: from there on a robot pays no more, so that its cheapest way to
  the goal is a shortest one. Every plan is bounded, however late it comes. The prices end after the last of them too,
  which is the horizon that counts here.

Tables that would be too large are refused before the first is made. The search for the least costs takes a bounded
number of steps.
"""

from collections.abc import Sequence

from carp_spec import Instance, Refusal, RobotId
from carp_spec.documents.bounds import BoundDocument, CutDocument, DeadlinesDocument
from carp_spec.documents.instances import digest
from carp_spec.inputs.values import require_instance
from carp_spec.shapes import require_shape
from carp_verify.bound.least import Budget, RobotSearch
from carp_verify.bound.network import network_of
from carp_verify.bound.rules import (
    LARGEST_FORMULA,
    LARGEST_RESTS,
    LARGEST_SEARCH,
    LARGEST_TABLE,
    is_about,
    is_deadline,
    is_least,
    is_rounded_up,
    is_scale,
    is_weight,
    require,
    require_size,
    size_fits,
)
from carp_verify.bound.tariff import Tariff, fees_of


def verify_bound(instance: Instance, certificate: BoundDocument) -> int:
    """The bound that the certificate proves of the instance; raises `Refusal` with what is wrong with it.

    No plans of all robots that can reach their goals have a smaller total cost. Where one cannot, `robots` has null.
    Cuts and deadlines know groups too.
    """
    require_instance(instance)
    require_shape(certificate, BoundDocument)
    require(is_about, is_about(certificate.instance, digest(instance)), "$.instance", "it is about another instance")
    scale = certificate.scale
    require(is_scale, is_scale(scale), "$.scale", f"the scale must be a power of two, and is {scale!r}")
    if [robot for robot, _ in certificate.robots] != list(instance.robot):
        raise Refusal("document", "$.robots", is_least.id, "it must name each robot of the instance once, in its order")
    table = _places(instance, list(instance.robot))
    require_size(table, LARGEST_RESTS, "$.robots", "the table of robots by resources")
    largest = max((_places(instance, [robot]) for robot in instance.robot), default=0)
    require_size(largest, LARGEST_TABLE, "$.robots", "the table of a robot's stops by resources")
    tariff = Tariff(instance, certificate)
    weights, proved, clauses = _weights(instance, certificate)
    worth = _worth(instance, certificate, clauses)
    fees = fees_of(instance, certificate.deadlines)
    network = network_of(instance)
    parts = proved - tariff.worth - worth
    budget = Budget(LARGEST_SEARCH)
    for position, (robot, (_, claimed)) in enumerate(zip(instance.robots, certificate.robots, strict=True)):
        search = RobotSearch(tariff, robot, weights[position], network, budget, fees[robot.id])
        _require_claim(search, claimed, f"$.robots[{position}]")
        parts += claimed or 0
    message = f"the bound must be {-(-parts // scale)}, the sum of all parts rounded up, and is {certificate.bound!r}"
    require(is_rounded_up, is_rounded_up(certificate.bound, parts, scale), "$.bound", message)
    return certificate.bound


def _require_claim(search: RobotSearch, claimed: int | None, path: str) -> None:
    """Raise `Refusal` unless the claim is no more than the robot's least cost, and null just where there is none."""
    robot = search.robot.id
    least = search.least_cost(claimed or 0) if search.has_way() else None
    message = f"robot {robot} can have no more than {least}, the least of its cost and prices, not {claimed!r}"
    if claimed is None:
        message = f"robot {robot} must have a whole number, as a way leads to its goal, and has null"
    require(is_least, is_least(claimed, least), path, message)


def _places(instance: Instance, robots: Sequence[RobotId]) -> int:
    """The places in which so many robots are searched for: resources, for each of their stops."""
    stops = [len(instance.robot[robot].stops) if robot in instance.robot else 1 for robot in robots]
    return sum(stops) * len(instance.graph.resources)


def _weights(instance: Instance, certificate: BoundDocument) -> tuple[Sequence[int], int, int]:
    """The weight of a tick for each robot, the cuts' least totals by their multipliers, and their clauses."""
    left = dict.fromkeys(instance.robot, certificate.scale)
    size = sum(_places(instance, cut.robots) for cut in certificate.cuts)
    require_size(size, LARGEST_TABLE, "$.cuts", "the resources that robots of cuts are searched in")
    proved = clauses = 0
    for number, cut in enumerate(certificate.cuts):
        path = f"$.cuts[{number}]"
        message = f"the multiplier must be a whole number of at least 0, and is {cut.multiplier!r}"
        require(is_weight, cut.multiplier >= 0, f"{path}.multiplier", message)
        require(is_weight, len(cut.robots) > 0, f"{path}.robots", "it must name at least one robot")
        seen: set[RobotId] = set()
        for robot in cut.robots:
            known = robot in left and robot not in seen
            seen.add(robot)
            require(is_weight, known, f"{path}.robots", f"it must name robots of the instance once, also {robot!r}")
            left[robot] -= cut.multiplier
            message = f"the multipliers of robot {robot} must add up to {certificate.scale} at most"
            require(is_weight, is_weight(0, -left[robot]), f"{path}.multiplier", message)
        clauses += _clauses_of(instance, cut, LARGEST_FORMULA - clauses, path)
        proved += cut.multiplier * cut.least
    return list(left.values()), proved, clauses


def _worth(instance: Instance, certificate: BoundDocument, clauses: int) -> int:
    """The most that all robots together can pay for their deadlines, which are checked.

    The formulas of the cuts have `clauses` clauses already.
    """
    size = sum(_places(instance, deadlines.robots) for deadlines in certificate.deadlines)
    require_size(size, LARGEST_TABLE, "$.deadlines", "the resources that robots with deadlines are searched in")
    worth = 0
    for number, deadlines in enumerate(certificate.deadlines):
        path = f"$.deadlines[{number}]"
        price, robots = deadlines.price, deadlines.robots
        message = f"the price must be a whole number of at least 0, and is {price!r}"
        require(is_deadline, price >= 0, f"{path}.price", message)
        message = "it must name robots of the instance, each once, or again where it is seen later"
        known = len(robots) > 0 and instance.robot.keys() >= set(robots)
        once = len(robots) == len(set(robots)) or len(deadlines.seen) > 0
        require(is_deadline, known and once, f"{path}.robots", message)
        clauses += _clauses_of(instance, deadlines, LARGEST_FORMULA - clauses, path)
        worth += price * (len(robots) - 1)
    return worth


def _clauses_of(instance: Instance, group: CutDocument | DeadlinesDocument, most: int, path: str) -> int:
    """The number of clauses in the formula of a cut, or of deadlines; raises `Refusal` if its refutation fails."""
    from carp_verify.bound.cuts import require_refuted  # noqa: PLC0415 - only they need the encoder
    from carp_verify.optimum.refutation import NotRefutedError  # noqa: PLC0415

    rule = is_weight if isinstance(group, CutDocument) else is_deadline
    try:
        return require_refuted(instance, group, most)
    except NotRefutedError as error:
        raise Refusal("document", path, rule.id, f"its proof does not hold: {error}") from error
    except Refusal as refusal:
        message = (
            f"the formulas of all groups must have at most {LARGEST_FORMULA} clauses together, and would have more"
        )
        raise Refusal("document", path, size_fits.id, message) from refusal
