"""A campaign of random verdicts: the proved kernel and the checkers in Python must agree on all.

A question is a solution to check, sound or broken in one place, or a query certificate to verify, honest or changed.
Each drawn fleet gives some of each kind. A block of questions is put to one run of the kernel.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import chain, count, islice
from typing import Any, Literal

import msgspec

from carp_experiments.measuring.blocks import BlockCase, Questions
from carp_reference import certifier
from carp_spec import Instance, RobotId, Solution, judge
from carp_spec.documents.query_certificates import QueryCertificateDocument, ServedLayer, certificate_of
from carp_spec.documents.solutions import solution_document
from carp_spec.permutations import shuffle, splitmix64
from carp_verify.kernel import KernelVerdict, ask, request
from carproof.judging.verdicts import verify_query
from carproof.testing.mutations import MUTATIONS
from carproof.testing.random_instances import SMALL, WITH_STOPS, Draw, draw_fleet, draw_instance

BROKEN = 4
CHANGED = 3
OF_A_FLEET = BROKEN + CHANGED + 3


class Verdicts(msgspec.Struct):
    """A row: the number of documents accepted and refused of each kind, and the differences."""

    verdicts: int
    sound: int = 0
    broken: int = 0
    proved: int = 0
    refused: int = 0
    differences: list[dict[str, Any]] = msgspec.field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Question:
    """A question to the kernel, and the answer of the checkers in Python."""

    request: bytes
    kind: Literal["sound", "broken", "proved", "refused"]
    rules: Collection[str | None]
    cost: int | None = None
    unplanned: int | None = None
    bound: int | None = None

    def agrees(self, answer: KernelVerdict) -> bool:
        """Whether the kernel says the same: the figures of what is accepted, or one of the rules that are broken."""
        if self.kind in ("sound", "proved"):
            figures = (answer.cost, answer.unplanned, answer.bound)
            return answer.verdict == "accepted" and figures == (self.cost, self.unplanned, self.bound)
        return answer.verdict == "refused" and answer.rule in self.rules


def asked(case: BlockCase) -> Verdicts:
    """Ask the kernel the questions of a block."""
    fleets = (fleet_questions(case.seed, number) for number in count(case.first // OF_A_FLEET))
    questions = list(islice(chain.from_iterable(fleets), case.count))
    return compared(case.first, questions, ask([each.request for each in questions]))


def fleet_questions(seed: int, number: int) -> list[Question]:
    """The questions about the fleet of that number."""
    draw = Draw(splitmix64(next(splitmix64(seed)) + number))
    instance = draw_instance(draw, WITH_STOPS if number % 2 else SMALL)
    fleet = draw_fleet(draw, instance)
    solution, robot = fleet.solution, draw.one_of([*instance.robot])
    mutants = [broken(draw, instance, solution) for _ in range(BROKEN)]
    honest = certified(instance, solution, robot, draw.one_of([0, fleet.now, fleet.now + 1]))
    certificates = [honest, *(changed(draw, honest) for _ in range(CHANGED))]
    return [
        checked(instance, solution),
        *(checked(*mutant) for mutant in mutants),
        *(verified(instance, solution, certificate) for certificate in certificates),
        verified(*mutants[0], honest),
    ]


def checked(instance: Instance, solution: Solution) -> Question:
    """A solution to check: the verdicts must agree whether it is valid, on its cost, and on a rule that it breaks."""
    verdict = judge(instance, solution)
    asked = request("check", instance, solution=solution_document(solution))
    if verdict.valid:
        return Question(asked, "sound", (), verdict.cost, verdict.unplanned)
    return Question(asked, "broken", {violation.rule for violation in verdict.violations})


def broken(draw: Draw, instance: Instance, solution: Solution) -> tuple[Instance, Solution]:
    """The solution changed in one place so that it breaks a rule."""
    kinds = (list(mutation(instance, solution)) for mutation in shuffle(MUTATIONS, draw.stream))
    chosen = draw.one_of(next(mutants for mutants in kinds if mutants))
    return chosen.instance, chosen.solution


def verified(instance: Instance, solution: Solution, certificate: QueryCertificateDocument) -> Question:
    """A query certificate to verify: the verdicts must agree whether it proves its bound, or which rule it breaks."""
    verdict = verify_query(instance, solution, certificate, kernel=False)
    asked = request("verify-query", instance, solution=solution_document(solution), certificate=certificate)
    return Question(asked, "proved" if verdict.proved else "refused", (verdict.rule,), bound=verdict.bound)


def certified(instance: Instance, solution: Solution, robot: RobotId, now: int) -> QueryCertificateDocument:
    """The certificate of the planner to read."""
    own = [plan for plan in solution.plans if plan.robot == robot]
    asked = certifier(instance)
    asked.commit([plan for plan in solution.plans if plan.robot != robot])
    return asked.certify(robot, own[0] if own else None, now)[1]


def changed(draw: Draw, certificate: QueryCertificateDocument) -> QueryCertificateDocument:
    """The certificate with another bound or tick, with a label or layer lost, or with another label or potential."""
    layers, bound = [*certificate.layers], certificate.bound
    chosen = draw.between(0, len(layers) - 1)
    labels, potential = [*layers[chosen].labels], [*layers[chosen].potential]
    kind = draw.one_of(("bound", "now", "label lost", "label moved", "potential", "layer lost"))
    if kind == "bound":
        bound = draw.one_of([None, 0, draw.between(-1, 20), (bound or 0) + draw.between(1, 2), (bound or 1) - 1])
    elif kind == "now":
        return msgspec.structs.replace(certificate, now=draw.between(0, 12))
    elif kind == "label lost" and labels:
        del labels[draw.between(0, len(labels) - 1)]
    elif pairs := labels if kind == "label moved" and labels else potential:
        place = draw.between(0, len(pairs) - 1)
        pairs[place] = (pairs[place][0], pairs[place][1] + draw.one_of([-1, 1]))
    layers[chosen] = ServedLayer(tuple(labels), tuple(potential))
    if kind == "layer lost" and len(layers) > 1:
        del layers[chosen]
    return certificate_of(certificate.robot, certificate.now, bound, layers)


def compared(first: int, questions: Sequence[Question], answers: Sequence[KernelVerdict]) -> Verdicts:
    """The number of questions of each kind, and those on which the kernel differs."""
    block = Verdicts(len(questions))
    for number, (asked, answer) in enumerate(zip(questions, answers, strict=True), first):
        setattr(block, asked.kind, getattr(block, asked.kind) + 1)
        if not asked.agrees(answer):
            difference = {"number": number, "request": msgspec.json.decode(asked.request), "kernel": answer}
            block.differences.append(msgspec.to_builtins(difference))
    return block


VERDICTS = Questions(
    "kernel",
    "Ask the proved kernel and the checkers in Python for the same verdicts.",
    "verdicts",
    "The kernel and the checkers in Python",
    asked,
    Verdicts,
    {
        "verdicts": lambda block: block.verdicts,
        "sound solutions": lambda block: block.sound,
        "broken solutions": lambda block: block.broken,
        "certificates proved": lambda block: block.proved,
        "certificates refused": lambda block: block.refused,
    },
)
