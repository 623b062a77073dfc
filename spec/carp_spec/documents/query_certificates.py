"""The document that proves how early one robot can arrive beside the plans of the others: `carproof-query/1`."""

from collections.abc import Sequence
from typing import Annotated, Final, Literal

import msgspec

from carp_spec.documents.decoding import decode
from carp_spec.model import ResourceId, RobotId

QUERY_FORMAT: Final = "carproof-query/1"


class ServedLayer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The labels and the potential of a robot once it has served so many stops, as those of `QueryCertificateDocument`.

    The tick of a label in a window in which the last of these stops was served is later than the entry, by what the
    service takes longer than the resource's duration.
    """

    labels: tuple[tuple[ResourceId, int], ...]
    potential: tuple[tuple[ResourceId, int], ...]


class QueryCertificateDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A tick before which no plan of the robot arrives, or null where it has no plan, and the evidence.

    The certificate is about an instance and a solution, which are not in it: the robot is planned at the tick `now`
    beside the plans of the others. A label is a pair of a resource and a tick: the robot enters the free window that
    holds the tick no earlier than then. `potential` gives for a resource the least ticks that the robot needs from
    entering it to entering its goal. From a resource that is not listed, the robot cannot reach its goal.

    Where stops are left to serve before the goal, these labels and this potential are those before any of them, and
    `served` has further ones: for one stop served, for two, and so on.
    """

    format: Literal["carproof-query/1"]
    robot: RobotId
    now: Annotated[int, msgspec.Meta(ge=0)]
    bound: int | None
    labels: tuple[tuple[ResourceId, int], ...]
    potential: tuple[tuple[ResourceId, int], ...]
    served: tuple[ServedLayer, ...] = ()

    @property
    def layers(self) -> tuple[ServedLayer, ...]:
        """The labels and potentials for no stop served, for one, and so on."""
        return (ServedLayer(self.labels, self.potential), *self.served)


def certificate_of(
    robot: RobotId, now: int, bound: int | None, layers: Sequence[ServedLayer]
) -> QueryCertificateDocument:
    """The certificate with these layers."""
    first, *served = layers
    return QueryCertificateDocument(QUERY_FORMAT, robot, now, bound, first.labels, first.potential, (*served,))


def read_query_certificate(data: bytes) -> QueryCertificateDocument:
    """Read a query certificate; raises `Refusal` if it is malformed."""
    return decode(data, QueryCertificateDocument, QUERY_FORMAT)
