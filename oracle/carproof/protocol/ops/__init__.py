"""The ops of the protocol, in one table from which server, `conform`, schema, documentation and help are made.

To add an op, write a class of its result, and a handler whose parameters are the fields of a request, into a module of
this package, and put the handler into `OPS`. `make generated` then writes the schema and the documentation again.
"""

from collections.abc import Callable, Mapping
from difflib import get_close_matches
from importlib.metadata import version as installed

import msgspec

from carp_spec import Refusal
from carp_verify.kernel import UndecidedError, is_answer
from carproof.protocol.lines import RIGHT_FIELDS, SPOKEN_VERSION, VERSION, Request
from carproof.protocol.ops import executing, judging, keeping, planning, searching
from carproof.protocol.ops.op import Op, Session, op_of


class StartDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The name and version of the program, and the ops that it offers."""

    name: str
    version: str
    ops: tuple[str, ...]


def start(version: int) -> StartDocument:
    """Agree on the version of the protocol, and list the ops that may be asked."""
    if version != VERSION:
        message = f"the version must be {VERSION}, not {version}"
        raise Refusal("request", "$.version", SPOKEN_VERSION.id, message)
    return StartDocument("carproof", installed("carproof"), tuple(OPS))


class StopDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An empty object."""


def stop() -> StopDocument:
    """End the process after this response."""
    return StopDocument()


_HANDLERS: tuple[Callable[..., object], ...] = (
    start,
    judging.check,
    planning.query,
    planning.plan,
    planning.plan_within,
    planning.add,
    planning.assign,
    planning.polish,
    searching.optimum,
    searching.bound,
    judging.verify_bound,
    judging.verify_query,
    judging.audit,
    executing.check_trace,
    executing.dependencies,
    executing.execute,
    executing.drive,
    executing.retime,
    executing.untangle,
    executing.give_way,
    executing.release,
    executing.check_grants,
    keeping.fleet_open,
    keeping.fleet_add,
    keeping.fleet_assign,
    keeping.fleet_advance,
    keeping.fleet_trace,
    keeping.fleet_remove,
    keeping.fleet_polish,
    keeping.fleet_rest,
    keeping.fleet_forget,
    keeping.fleet_close,
    stop,
)
OPS: Mapping[str, Op] = {op.name: op for op in map(op_of, _HANDLERS)}


def answer(request: Request, name: str, session: Session) -> object:
    """The result of a request, as JSON holds it."""
    if name not in OPS:
        near = get_close_matches(name, OPS, 1)
        meant = f"did you mean {near[0]}? The" if near else "the"
        message = f"there is no op {name!r}; {meant} op start lists all"
        raise Refusal("request", "$.op", RIGHT_FIELDS.id, message)
    try:
        return OPS[name].answer(request, session)
    except UndecidedError as error:
        raise Refusal("limit", "$.kernel", is_answer.id, str(error)) from error
