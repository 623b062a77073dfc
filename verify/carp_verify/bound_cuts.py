"""Cuts: groups of robots whose costs add up to more than prices can show, with proofs that others can check.

The proof of a cut is that of an optimum's lower half, of the group as an instance of its own (`carp_verify.proof`):
the formula of a total below `least` is made anew from the instance, and a DRAT refutation of it is replayed. No plans
of the group cost less in the whole instance either, where there are more robots in the way.
"""

from collections.abc import Sequence

from carp_spec import Instance, RobotId
from carp_spec.bounds import CutDocument
from carp_spec.rule import is_whole
from carp_verify.clauses import dimacs
from carp_verify.encoding import Encoding
from carp_verify.optimum import Evidence
from carp_verify.proof import beat_formula


def group_of(instance: Instance, robots: Sequence[RobotId]) -> Instance:
    """The instance of some of the robots."""
    return Instance(instance.graph, tuple(instance.robot[robot] for robot in robots), instance.after_goal)


def why_unproved(instance: Instance, cut: CutDocument) -> str | None:
    """Why the cut's proof does not hold, or `None` if it does; its robots must be known.

    Raises `Refusal` if its formula would not fit into memory.
    """
    group = group_of(instance, cut.robots)
    count = len(group.robots)
    if Encoding(group).wayless:
        return "a robot of the group has no way to its goal"
    if not all(map(is_whole, (cut.least, *cut.horizons, *cut.order))):
        return "its least total, horizons and order must be whole numbers"
    if len(cut.horizons) != count or sorted(cut.order) != list(range(count)):
        return f"it must have a horizon of each of {count} robots, and an order of them"
    if any(not 0 <= horizon <= cut.least for horizon in cut.horizons):
        return "a horizon must be between 0 and the least total"
    formula = beat_formula(group, cut.least, Evidence(cut.horizons, cut.order)).formula
    return _why_not_refuted(dimacs(formula), cut.refutation)


def _why_not_refuted(formula: str, refutation: str) -> str | None:
    from dratify import check_proof, parse_dimacs  # noqa: PLC0415 - only for certificates with cuts

    try:
        result = check_proof(parse_dimacs(formula), refutation)
    except ValueError as error:
        return f"the refutation must be a DRAT proof: {error}"
    return None if result.ok else f"the refutation does not show that the group cannot cost less: {result}"
