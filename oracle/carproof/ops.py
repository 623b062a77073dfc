"""What the oracle does for each op of the protocol.

A handler takes the fields of its op, ends the request, and returns the result's document. To add an op, write its
handler and put it into `OPS`.
"""

from collections.abc import Callable, Mapping
from importlib.metadata import version
from typing import Any, TypeAlias, cast

from carp_spec import Neighbourhood, Refusal, Solution, judge, planner_named
from carp_spec.documents import solution_document, verdict_document
from carp_spec.query_certificates import read_query_certificate
from carp_verify.kernel import UndecidedError, is_answer
from carproof.engines import Engine, warm
from carproof.extras import require
from carproof.optima import optimum_document
from carproof.options import DEFAULT_LIMIT, DEFAULT_SECONDS
from carproof.protocol import VERSION, Request, fields_are_right, value_of, version_is_spoken
from carproof.requests import (
    inside,
    limit_is_positive,
    require_new_robot,
    require_robot,
    require_tick,
    sound_solution,
)
from carproof.results import query_document

ENDLESS = 2**53
Result: TypeAlias = Any
Handler: TypeAlias = Callable[[Request, Engine], Result]
POLISH_OPTIONS = {"iterations", "seconds", "seed"}


def start(request: Request, engine: Engine) -> Result:
    """Agree on the version, and tell the ops."""
    del engine
    asked = request.take("version", value_of(int))
    request.end()
    if not version_is_spoken(asked):
        raise Refusal("request", "$.version", version_is_spoken.id, f"the version must be {VERSION}, not {asked}")
    return {"name": "carproof", "version": version("carproof"), "ops": list(OPS)}


def check(request: Request, engine: Engine) -> Result:
    """Judge a solution."""
    del engine
    instance, solution = request.instance(), request.solution()
    request.end()
    return verdict_document(judge(instance, solution))


def query(request: Request, engine: Engine) -> Result:
    """Plan one robot against committed plans."""
    instance, solution, robot = request.instance(), request.solution(), request.robot()
    now = _now(request)
    request.end()
    require_robot(instance, robot, "$.robot")
    with inside("$.solution"):
        committed = sound_solution(instance, solution, robot)
    with inside("$.instance"):
        return query_document(engine.query(instance, committed.plans, robot, now))


def plan(request: Request, engine: Engine) -> Result:
    """Plan all robots."""
    name = request.take("planner", value_of(str), Neighbourhood.name)
    instance = request.instance()
    planner = planner_named(name, request.options())
    with inside("$.instance"):
        return solution_document(engine.plan(instance, planner))


def add(request: Request, engine: Engine) -> Result:
    """Add one robot."""
    instance, solution, robot = request.instance(), request.solution(), request.robot()
    now = _now(request)
    options = cast("Neighbourhood", planner_named(Neighbourhood.name, request.options()))
    require_new_robot(instance, solution, robot, "$.robot")
    with inside("$.solution"):
        before: Solution = sound_solution(instance, solution)
    with inside("$.instance"):
        return solution_document(engine.add(instance, before, robot, now, options))


def polish(request: Request, engine: Engine) -> Result:
    """Improve a solution."""
    instance, solution = request.instance(), request.solution()
    options = request.options()
    for name in options.keys() - POLISH_OPTIONS:
        raise Refusal("request", f"$.{name}", fields_are_right.id, "the op has no such field")
    with inside("$.solution"):
        before = sound_solution(instance, solution)
    if "seconds" in options:
        warm()
    with inside("$.instance"):
        return solution_document(engine.polish(instance, before, **options))


def optimum(request: Request, engine: Engine) -> Result:
    """Search for the least total cost; `proved` means that the search ended with an answer, which nothing checked."""
    require("pysat")
    from carp_optimum.optimum import optimum as search  # noqa: PLC0415 - a server that is not asked need not load it

    del engine
    instance = request.instance()
    limit: float = request.take("limit", value_of(int | float), DEFAULT_LIMIT)
    request.end()
    if not limit_is_positive(limit):
        message = f"the limit must be a number of seconds above 0, not {limit}"
        raise Refusal("request", "$.limit", limit_is_positive.id, message)
    return optimum_document(search(instance, limit))


def bound(request: Request, engine: Engine) -> Result:
    """Search for a lower bound on the total cost, with a certificate."""
    require("pysat")
    from carp_optimum.bound import lower_bound  # noqa: PLC0415 - a server that is not asked need not load it

    del engine
    instance = request.instance()
    steps: int = request.take("steps", value_of(int), ENDLESS)
    seconds: float = request.take("seconds", value_of(int | float), DEFAULT_SECONDS if steps == ENDLESS else ENDLESS)
    request.end()
    if not limit_is_positive(seconds):
        message = f"it must be a number of seconds above 0, not {seconds}"
        raise Refusal("request", "$.seconds", limit_is_positive.id, message)
    if not limit_is_positive(steps):
        raise Refusal("request", "$.steps", limit_is_positive.id, f"it must be a number above 0, not {steps}")
    warm()
    with inside("$.instance"):
        return lower_bound(instance, seconds, steps)


def verify_query(request: Request, engine: Engine) -> Result:
    """Check the certificate of a query."""
    from carproof.verdicts import verify_query as verify  # noqa: PLC0415 - a server that is not asked need not load it

    del engine
    instance, solution = request.instance(), request.solution()
    certificate = request.take("certificate", read_query_certificate)
    kernel: bool = request.take("kernel", value_of(bool), False)
    request.end()
    return verify(instance, solution, certificate, kernel)


def audit(request: Request, engine: Engine) -> Result:
    """Certify each plan of a solution in its planning order."""
    from carproof.audit import ask_kernel, audit_in_order  # noqa: PLC0415 - a server that is not asked need not load it
    from carproof.results import audit_document  # noqa: PLC0415

    instance, solution = request.instance(), request.solution()
    kernel: bool = request.take("kernel", value_of(bool), False)
    request.end()
    with inside("$.solution"):
        sound = sound_solution(instance, solution)
    with inside("$.instance"):
        found = audit_in_order(instance, sound, engine)
    if kernel:
        ask_kernel(instance, sound, found)
    return audit_document(found, sound)


def stop(request: Request, engine: Engine) -> Result:
    """Say goodbye; `serve` ends after it."""
    del engine
    request.end()
    return {}


OPS: Mapping[str, Handler] = {
    "start": start,
    "check": check,
    "query": query,
    "plan": plan,
    "add": add,
    "polish": polish,
    "optimum": optimum,
    "bound": bound,
    "verify-query": verify_query,
    "audit": audit,
    "stop": stop,
}


def answer(request: Request, op: str, engine: Engine) -> Result:
    """The result of a request."""
    if op not in OPS:
        raise Refusal("request", "$.op", fields_are_right.id, f"the op must be one of {', '.join(OPS)}, not {op!r}")
    try:
        return OPS[op](request, engine)
    except UndecidedError as error:
        raise Refusal("limit", "$.kernel", is_answer.id, str(error)) from error


def _now(request: Request) -> int:
    now: int = request.take("now", value_of(int), 0)
    require_tick(now, "$.now")
    return now
