"""The document of a lower bound on the total cost, with everything needed to check it: `carproof-bound/1`.

`carp_verify` checks it, whatever made it. Its rules are `bound/...`.
"""

from typing import Annotated, Final, Literal, TypeAlias

import msgspec

from carp_spec.documents.decoding import Positive, Tick, decode
from carp_spec.model import ResourceId, RobotId

BOUND_FORMAT: Final = "carproof-bound/1"

Price: TypeAlias = Annotated[int, msgspec.Meta(extra_json_schema={"minimum": 0})]
Sight: TypeAlias = tuple[int, tuple[ResourceId, ...]]
"""A tick at which a robot is seen, and the places that count for it then."""


class CutDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A group of robots whose costs add up to at least `least`, and its weight in the bound, in parts of a tick.

    The other fields prove this for the group as an instance of its own. The horizon of each robot and an order of the
    robots define the formula of a smaller total. The refutation of that formula is LRAT without RAT steps.
    """

    robots: tuple[RobotId, ...]
    least: int
    multiplier: Price
    horizons: tuple[int, ...]
    order: tuple[int, ...]
    refutation: str


class DeadlinesDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Deadlines that the robots of a group cannot all keep, and what each of them pays if it keeps its own.

    A robot keeps a deadline if it enters its goal for the last time at that tick or before. In `seen`, each robot may
    have a tick at which it is seen, and places. Then it keeps its deadline if it has done so when it is seen, or if it
    is in one of the places then, and enters its goal for the last time later. A robot that is seen more than once is
    named each time, in the order of the ticks, and has a deadline each. The price is in parts of a tick. The
    refutation is that of the formula of plans of the group that keep all deadlines: LRAT without RAT steps.
    """

    robots: tuple[RobotId, ...]
    ticks: tuple[int, ...]
    price: Price
    refutation: str
    seen: tuple[Sight, ...] = ()


class BoundDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A lower bound on the total cost of plans for all robots that can reach their goals, and its certificate.

    `instance` is the digest of the instance's document. Prices, multipliers and least costs are in parts of a tick,
    `scale` of them. A price of `resources` is [resource, tick, price], one of `exchanges` [resource, other, tick,
    price], and one of `groups` [group, tick, price]; those not listed are 0, and so are all at or after the tick
    `horizon`. `robots` gives each robot's least cost with prices, those of its deadlines among them, or null where no
    way leads to its goal. A document may leave out `deadlines` and `groups` that it does not have.
    """

    format: Literal["carproof-bound/1"]
    instance: str
    bound: int
    scale: Positive
    horizon: Annotated[int, msgspec.Meta(ge=0)]
    resources: tuple[tuple[ResourceId, Tick, Price], ...]
    exchanges: tuple[tuple[ResourceId, ResourceId, Tick, Price], ...]
    cuts: tuple[CutDocument, ...]
    robots: tuple[tuple[RobotId, int | None], ...]
    deadlines: tuple[DeadlinesDocument, ...] = ()
    groups: tuple[tuple[ResourceId, Tick, Price], ...] = ()


def read_bound(data: bytes) -> BoundDocument:
    """Read the document of a bound; raises `Refusal` if it is malformed. `carp_verify` checks whether it is right."""
    return decode(data, BoundDocument, BOUND_FORMAT)
