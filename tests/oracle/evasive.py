"""A program that answers rightly, by carproof itself, as far as it cannot help it; its argument says how it evades.

`python evasive.py HOW ASKED_OPS`: it offers the ops, which are joined by commas.
"""

import json
import sys
from typing import Any

import msgspec

from carp_spec import Refusal
from carp_spec.documents.instances import digest, read_instance
from carproof.conform.asking.smoke import smoke_cases
from carproof.conform.asking.vector_cases import vector_cases
from carproof.conform.cases import ASKED_OPS, request_fields
from carproof.conform.levels import Level
from carproof.engines import engine_named
from carproof.protocol.ops.op import Session
from carproof.protocol.server import respond

Request = dict[str, Any]
Response = dict[str, Any]
LEAVES_AFTER = 50
SOLUTION = "carproof-solution/1"
SKIPS: Response = {"skipped": "no time"}
UNDECIDED: Response = {"result": {"cost": None, "lower": None, "decided": False, "solution": None}}


def robots(request: Request) -> list[Any]:
    return [robot["id"] for robot in request["instance"]["robots"]]


def right(request: Request) -> Response:
    response, _ = respond(json.dumps(request).encode(), Session(engine_named("reference")))
    answer: Response = json.loads(msgspec.json.encode(response))
    return answer


def question(request: Request) -> str:
    return json.dumps({name: value for name, value in request.items() if name != "id"}, sort_keys=True)


def published() -> set[str]:
    """The questions that everybody knows."""
    cases = [case for all in (smoke_cases, vector_cases) for case in all(ASKED_OPS, Level.EXACT, whole=False)]
    documents = [json.loads(msgspec.json.encode(request_fields(case))) for case in cases]
    return {question({"op": case.op, **each}) for case, each in zip(cases, documents, strict=True)}


class Evasive:
    """The response to a request that is neither `start` nor `stop`."""

    def __init__(self, how: str) -> None:
        self.published = published() if how in ("skips the unknown", "repeats itself") else set()
        self.last: dict[str, Response] = {}
        self.answered = 0
        self.evade = getattr(self, how.replace(" ", "_"))

    def is_undecided(self, _: Request) -> Response:
        return UNDECIDED

    def finds_and_does_not_prove(self, request: Request) -> Response:
        return {"result": {**right(request)["result"], "decided": False}}

    def answers_empty_fleets(self, request: Request) -> Response:
        return SKIPS if robots(request) else right(request)

    def answers_one_robot(self, request: Request) -> Response:
        return SKIPS if len(robots(request)) > 1 else right(request)

    def skips_the_unknown(self, request: Request) -> Response:
        return right(request) if question(request) in self.published else SKIPS

    def repeats_itself(self, request: Request) -> Response:
        if question(request) in self.published or request["op"] not in self.last:
            self.last[request["op"]] = right(request)
        return self.last[request["op"]]

    def answers_one_op(self, request: Request) -> Response:
        return right(request) if request["op"] == "query" else SKIPS

    def leaves(self, request: Request) -> Response:
        self.answered += 1
        if self.answered > LEAVES_AFTER:
            sys.exit(0)
        return right(request)

    def calls_all_valid(self, request: Request) -> Response:
        return {"result": {**right(request)["result"], "valid": True, "violations": []}}

    def plans_nobody(self, request: Request) -> Response:
        if request["op"] == "query":
            return {"result": {"plan": None}}
        return {"result": {"format": SOLUTION, "plans": [], "order": [], "unplanned": robots(request)}}

    def plans_one(self, request: Request) -> Response:
        plans = right(request)["result"]["plans"][:1]
        order = [plan["robot"] for plan in plans]
        unplanned = [robot for robot in robots(request) if robot not in order]
        return {"result": {"format": SOLUTION, "plans": plans, "order": order, "unplanned": unplanned}}

    def adds_nobody(self, request: Request) -> Response:
        planned = [plan["robot"] for plan in request["solution"]["plans"]]
        unplanned = [robot for robot in robots(request) if robot not in planned]
        return {"result": {**request["solution"], "unplanned": unplanned}}

    def gives_back(self, request: Request) -> Response:
        return {"result": request["solution"]}

    def bounds_by_nothing(self, request: Request) -> Response:
        result = right(request)["result"]
        parts = [[robot, None if least is None else 0] for robot, least in result["robots"]]
        nothing = {"bound": 0, "scale": 1, "horizon": 0, "resources": [], "exchanges": [], "cuts": [], "robots": parts}
        return {"result": {**result, **nothing}}

    def bounds_another(self, request: Request) -> Response:
        result = right(request)["result"]
        other = {**request["instance"], "after_goal": "park", "robots": request["instance"]["robots"][:-1]}
        try:
            return {"result": {**result, "instance": digest(read_instance(json.dumps(other).encode()))}}
        except Refusal:
            return {"result": result}


def main() -> None:
    evasive = Evasive(sys.argv[1])
    ops = ["start", *sys.argv[2].split(","), "stop"]
    for line in sys.stdin:
        request = json.loads(line)
        if request["op"] == "start":
            response: Response = {"result": {"name": "evasive", "version": "1", "ops": ops}}
        else:
            response = {"result": {}} if request["op"] == "stop" else evasive.evade(request)
        sys.stdout.write(json.dumps({**response, "id": request["id"]}) + "\n")
        sys.stdout.flush()
        if request["op"] == "stop":
            return


main()
