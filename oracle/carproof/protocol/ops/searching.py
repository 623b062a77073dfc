"""The ops that search for optima and bounds; they need the extra `prove`."""

from carp_spec import Instance, Refusal
from carp_spec.documents.bounds import BoundDocument
from carp_spec.inputs.options import SEARCH_SECONDS
from carproof.extras import require
from carproof.optima import OptimumDocument, optimum_document
from carproof.requests import POSITIVE_LIMIT, inside


def optimum(instance: Instance, limit: float = SEARCH_SECONDS) -> OptimumDocument:
    """Search for the least total cost of plans for all robots. The search takes at most `limit` seconds."""
    require("pysat")
    from carproof.api import searching  # noqa: PLC0415 - a server that is not asked need not load it

    if limit <= 0:
        message = f"the limit must be a number of seconds above 0, not {limit}"
        raise Refusal("request", "$.limit", POSITIVE_LIMIT.id, message)
    with inside("$.instance"):
        return optimum_document(searching.optimum(instance, limit))


def bound(instance: Instance, seconds: float | None = None, steps: int | None = None) -> BoundDocument:
    """Search for a lower bound on the total cost, with a certificate. Without a limit it takes 10 s."""
    require("pysat")
    from carproof.api import searching  # noqa: PLC0415 - a server that is not asked need not load it

    for name, limit in (("seconds", seconds), ("steps", steps)):
        if limit is not None and limit <= 0:
            raise Refusal("request", f"$.{name}", POSITIVE_LIMIT.id, f"it must be a number above 0, not {limit}")
    with inside("$.instance"):
        return searching.bound(instance, seconds, steps)
