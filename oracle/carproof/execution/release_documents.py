"""The documents of grants, and of the answers about them."""

import msgspec

from carp_spec import Instance, ResourceId, RobotId
from carp_spec.documents.decoding import decode
from carp_spec.documents.fields import all_converted
from carp_spec.documents.grants import GRANTS_FORMAT, GrantDocument, GrantsDocument
from carp_verify.release.rules import Grant
from carp_verify.release.verify import Finish, Overfull, Stuck
from carproof.execution.releasing import Answer, GrantsVerdict, Released


class BeyondDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What one robot may be granted while the others get nothing.

    `next` is the first resource that it may not have, null at the end of its plan, and for a robot that is not
    released yet, which may have nothing. `answer` is that for it: unsafe or undecided, and `robots` those in the way.
    """

    robot: RobotId
    resources: tuple[ResourceId, ...]
    next: ResourceId | None
    answer: Answer
    robots: tuple[RobotId, ...]


class ReleaseDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What all robots may be granted together by the planned order, and what each may be granted alone.

    `follows` is whether the robots have kept the planned order; where they have not, it grants nothing.
    """

    follows: bool
    in_order: tuple[GrantDocument, ...]
    beyond: tuple[BeyondDocument, ...]


class GrantsVerdictDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Whether grants are safe, and a witness.

    Safe: in `moves`, the robots that move on, one after the other, until all have finished; `by_order` is whether the
    grants follow from the planned order. Unsafe: the `robots` are too many in `resources`, which have room for
    `capacity`; or they never all finish, even without the others, and `places` has all positions of their visits that
    they can get to together.
    """

    answer: Answer
    by_order: bool
    moves: tuple[RobotId, ...] | None = None
    robots: tuple[RobotId, ...] | None = None
    resources: tuple[ResourceId, ...] | None = None
    capacity: int | None = None
    places: tuple[tuple[int, ...], ...] | None = None


def read_grants(data: bytes) -> tuple[Grant, ...]:
    """Read a document of grants; raises `Refusal` if it is malformed."""
    document = decode(data, GrantsDocument, GRANTS_FORMAT)
    return all_converted(document.grants, Grant)


def released_document(released: Released) -> ReleaseDocument:
    """The document of what may be granted."""
    beyond = (
        BeyondDocument(each.grant.robot, each.grant.resources, each.next, each.answer, each.robots)
        for each in released.beyond
    )
    return ReleaseDocument(released.follows, all_converted(released.in_order, GrantDocument), tuple(beyond))


def grants_verdict_document(instance: Instance, verdict: GrantsVerdict) -> GrantsVerdictDocument:
    """The document of a verdict."""
    witness, head = verdict.witness, (verdict.answer, verdict.by_order)
    if isinstance(witness, Finish):
        return GrantsVerdictDocument(*head, moves=witness.moves)
    if isinstance(witness, Overfull):
        place = instance.graph.constraints[witness.constraint]
        return GrantsVerdictDocument(*head, robots=witness.robots, resources=place.resources, capacity=place.capacity)
    if isinstance(witness, Stuck):
        return GrantsVerdictDocument(*head, robots=witness.robots, places=tuple(sorted(witness.states)))
    return GrantsVerdictDocument(*head)
