"""The document that proves how early one robot can arrive beside the plans of the others: `carproof-query/1`."""

from typing import Annotated, Final, Literal

import msgspec

from carp_spec.documents.decoding import decode
from carp_spec.model import ResourceId, RobotId

QUERY_FORMAT: Final = "carproof-query/1"


class QueryCertificateDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A tick before which no plan of the robot arrives, or null where it has no plan, and the evidence.

    The certificate is about an instance and a solution, which are not in it: the robot is planned at the tick `now`
    beside the plans of the others. A label is a pair of a resource and a tick: the robot enters the free window that
    holds the tick no earlier than then. `potential` gives for a resource the least ticks that the robot needs from
    entering it to entering its goal. From a resource that is not listed, the robot cannot reach its goal.
    """

    format: Literal["carproof-query/1"]
    robot: RobotId
    now: Annotated[int, msgspec.Meta(ge=0)]
    bound: int | None
    labels: tuple[tuple[ResourceId, int], ...]
    potential: tuple[tuple[ResourceId, int], ...]


def read_query_certificate(data: bytes) -> QueryCertificateDocument:
    """Read a query certificate; raises `Refusal` if it is malformed."""
    return decode(data, QueryCertificateDocument, QUERY_FORMAT)
