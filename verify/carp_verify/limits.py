"""The limit of certificates and proofs: they know of no forbidden following, `limit/following`."""

from carp_spec import Instance, Refusal
from carp_spec.rule import DESIGN, rule


@rule(
    "limit/following",
    "Optima, lower bounds, certificates, proofs and the kernel know of no forbidden following, and refuse an instance "
    "that forbids it.",
    DESIGN,
)
def following_is_allowed(instance: Instance) -> bool:  # noqa: D103 - its statement stands in its decorator
    return instance.following == "allowed"


def require_following(instance: Instance) -> None:
    """Raise `Refusal` if the instance forbids following."""
    if not following_is_allowed(instance):
        message = "following must be allowed here: checks and planners alone know of instances that forbid it"
        raise Refusal("limit", "$.following", following_is_allowed.id, message)
