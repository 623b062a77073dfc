"""The test vectors that a program can be asked. It sees only their questions; the judges compute the answers again."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from carp_spec import Carp, Instance
from carp_spec.documents.decoding import write
from carp_spec.documents.vectors import Vector
from carp_spec.limits import goals_stand_alone
from carproof.conform.cases import ASKED_OPS, Case
from carproof.conform.judging.claims import EVERYTHING, Claims
from carproof.conform.levels import Level
from carproof.protocol.lines import Request
from carproof.protocol.ops import OPS
from carproof.testing.vectors import vectors


def vector_cases(ops: Sequence[str], level: Level, whole: bool, claims: Claims = EVERYTHING) -> Iterator[Case]:
    """The vectors of the ops that are offered; those with malformed documents are for readers of documents.

    A program need not support instances that forbid following, nor, unless it claims them, groups and stops.
    """
    for vector in vectors():
        is_offered = vector.op in ops and vector.op in ASKED_OPS and "refused" not in vector.answer
        if is_offered and _is_known(vector.read_instance(), claims):
            case = case_of(vector)
            if _is_asked(case, level, whole):
                yield replace(case, planner=None) if whole else case


def _is_known(instance: Instance, claims: Claims) -> bool:
    knows_groups = claims.groups or not instance.graph.groups
    knows_stops = claims.stops or goals_stand_alone(instance)
    return instance.following == "allowed" and knows_groups and knows_stops


def _is_asked(case: Case, level: Level, whole: bool) -> bool:
    """Whether the level covers the vector: below `exact`, programs are asked for no planner but CARP."""
    if case.op == "plan":
        return whole or level >= Level.EXACT or isinstance(case.planner, Carp)
    return case.op != "optimum" or level >= Level.COMPLETE


def case_of(vector: Vector) -> Case:
    """The question of a vector; raises `Refusal` if it is none."""
    request = Request(write({"id": vector.id, **vector.request}))
    asked = OPS[request.op()].read(request)
    names = ("solution", "robot", "now", "planner", "delays")
    fields = {name: asked[name] for name in names if asked.get(name) is not None}
    options = {"planner": asked["options"]} if vector.op == "add" else {}
    return Case("vectors", vector.id, vector.op, asked["instance"], **fields, **options)
