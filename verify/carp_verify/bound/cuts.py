"""Cuts and deadlines: groups of robots that provably cost more together than prices alone can show.

A cut is proved like the lower half of an optimum (`carp_verify.optimum.proof`), with the group as an instance of its
own: the formula of a total below `least` is made again from the instance, and its refutation is checked. In the whole
instance, where more robots are in the way, no plans of the group cost less either.

Deadlines are proved in the same way, by the formula of plans of the group that keep all of them: each robot's horizon
is the delay with which it would just keep its own, and none is later than that. Robots that are seen at a tick are
described up to it: then each is in one of its places, or has arrived by its deadline.
"""

from collections.abc import Sequence
from dataclasses import replace

from carp_spec import Instance, RobotId
from carp_spec.documents.bounds import CutDocument, DeadlinesDocument
from carp_verify.bound.rules import is_deadline
from carp_verify.optimum.clauses import Formula
from carp_verify.optimum.encoding import Encoding, Evidence, beat_formula
from carp_verify.optimum.refutation import NotRefutedError, require_refutation


def group_of(instance: Instance, robots: Sequence[RobotId]) -> Instance:
    """The instance of some of the robots."""
    return replace(instance, robots=tuple(instance.robot[robot] for robot in robots))


def formula_of(instance: Instance, cut: CutDocument, most: int) -> Formula:
    """The formula that a cut refutes; its robots must be known.

    Raises `NotRefutedError` if the cut has no such formula, and `Refusal` if that has more than `most` clauses.
    """
    group = group_of(instance, cut.robots)
    count = len(group.robots)
    if Encoding(group).wayless:
        raise NotRefutedError("a robot of the group has no way to its goal")
    if len(cut.horizons) != count or sorted(cut.order) != list(range(count)):
        raise NotRefutedError(f"it must have a horizon of each of {count} robots, and an order of them")
    if any(not 0 <= horizon <= cut.least for horizon in cut.horizons):
        raise NotRefutedError("a horizon must be between 0 and the least total")
    return beat_formula(group, cut.least, Evidence(cut.horizons, cut.order), most).formula


def formula_of_deadlines(instance: Instance, deadlines: DeadlinesDocument, most: int) -> Formula:
    """The formula that shows deadlines which cannot all be kept; raises as `formula_of` does."""
    group = group_of(instance, tuple(dict.fromkeys(deadlines.robots)))
    if len(deadlines.ticks) != len(deadlines.robots):
        raise NotRefutedError(f"it must have a deadline of each of {len(deadlines.robots)} robots")
    if deadlines.seen:
        return _formula_of_seen(group, deadlines, most)
    encoding = Encoding(group, most=most)
    for robot, tick in zip(encoding.robots, deadlines.ticks, strict=True):
        earliest = None if robot.shortest is None else robot.earliest
        if not is_deadline(tick, earliest):
            raise NotRefutedError(f"robot {robot.robot.id} can be at its goal at {earliest}, not at {tick!r}")
    encoding.grow_to([tick - robot.earliest for robot, tick in zip(encoding.robots, deadlines.ticks, strict=True)])
    encoding.forbid_all()
    encoding.close()
    return encoding.formula


def _formula_of_seen(group: Instance, deadlines: DeadlinesDocument, most: int) -> Formula:
    """The formula of deadlines of robots that are seen."""
    if len(deadlines.seen) != len(deadlines.robots):
        raise NotRefutedError(f"it must see each of {len(deadlines.robots)} robots")
    last: dict[RobotId, int] = {}
    for name, tick, (seen, places) in zip(deadlines.robots, deadlines.ticks, deadlines.seen, strict=True):
        if not is_deadline(tick, 0) or not is_deadline(seen, 0):
            raise NotRefutedError(f"robot {name} must have whole ticks of at least 0, not {tick!r} and {seen!r}")
        if not group.graph.index.keys() >= set(places):
            raise NotRefutedError(f"the places of robot {name} must be resources")
        if seen <= last.get(name, -1):
            raise NotRefutedError(f"robot {name} must be seen again later than at {last[name]}, not at {seen}")
        last[name] = seen
    encoding = Encoding(group, most=most, seen=[*last.values()])
    if encoding.wayless:
        raise NotRefutedError("a robot of the group has no way to its goal")
    described = dict(zip(last, encoding.robots, strict=True))
    members = [
        (described[name], seen, places, min(tick, seen))
        for name, tick, (seen, places) in zip(deadlines.robots, deadlines.ticks, deadlines.seen, strict=True)
    ]
    horizons = dict.fromkeys(last, 0)
    for robot, seen, places, arrival in members:
        horizons[robot.robot.id] = max(horizons[robot.robot.id], robot.largest_delay(seen, places, arrival))
    encoding.grow_to([*horizons.values()])
    encoding.forbid_all()
    encoding.close()
    for robot, seen, places, arrival in members:
        robot.demand(seen, places, arrival)
    return encoding.formula


def require_refuted(instance: Instance, group: CutDocument | DeadlinesDocument, most: int) -> int:
    """Check the refutation, and return how many clauses the formula has; raises as `formula_of` does."""
    if isinstance(group, CutDocument):
        formula = formula_of(instance, group, most)
    else:
        formula = formula_of_deadlines(instance, group, most)
    require_refutation(formula.clauses, group.refutation)
    return len(formula.clauses)
