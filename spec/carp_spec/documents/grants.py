"""The document of grants, `carproof-grants/1`."""

from typing import Final, Literal

import msgspec

from carp_spec.model import ResourceId, RobotId

GRANTS_FORMAT: Final = "carproof-grants/1"


class GrantDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The next resources of a robot's plan, which it may enter without asking again."""

    robot: RobotId
    resources: tuple[ResourceId, ...]


class GrantsDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What robots are granted beyond the resources that they are in."""

    format: Literal["carproof-grants/1"]
    grants: tuple[GrantDocument, ...]
