"""A campaign of random texts: the kernel and Python must read and refuse the same ones, and decide alike on the others.

A text is a request to the kernel, of a test vector or about a random fleet, changed in up to three places. Of each text
it is asked whether it is read, and if so, whether it is accepted. Sizes are no difference: each may have limits of its
own. A block of texts is put to one run of the kernel.
"""

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import msgspec

from carp_experiments.measuring.blocks import Questions
from carp_experiments.measuring.kernel_verdicts import certified, fleet_questions
from carp_experiments.measuring.texts import changed, vector_requests
from carp_spec import Instance, Plan, Refusal, Solution, judge
from carp_spec.documents.bounds import BoundDocument, read_bound
from carp_spec.documents.decoding import require_json
from carp_spec.documents.instances import digest, read_instance
from carp_spec.documents.query_certificates import QueryCertificateDocument, read_query_certificate
from carp_spec.documents.solutions import read_solution, solution_document
from carp_spec.limits import refuse_stops
from carp_spec.permutations import splitmix64
from carp_verify.bound.verify import verify_bound
from carp_verify.kernel import KernelVerdict, is_answer, replies, request, verdict_of
from carp_verify.query.verify import Traffic, require_certificate, verify_query
from carproof.testing.random_instances import SMALL, WITH_STOPS, Draw, draw_fleet, draw_instance

FLEETS = 4
LONGEST = 30
"""The seconds in which the kernel must answer a block."""
SIZES = {"bound/size", "query-certificate/size"}
ABSENT = msgspec.Raw()


class Texts(msgspec.Struct):
    """A row: how often which verdict was Python's, and the texts on which the kernel's is another."""

    texts: int
    verdicts: dict[str, int]
    differences: list[dict[str, Any]]


class Request(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A request to the kernel, its documents not read."""

    op: str
    instance: msgspec.Raw
    solution: msgspec.Raw = ABSENT
    certificate: msgspec.Raw = ABSENT
    certificates: msgspec.Raw = ABSENT


@dataclass(frozen=True, slots=True)
class Decided:
    """The verdict of Python on a text: figures if it is accepted, broken rules if it is refused."""

    verdict: Literal["accepted", "refused", "bad input"]
    figures: tuple[int | None, int | None, int | None] = (None, None, None)
    rules: Collection[str] = ()

    def agrees(self, answer: KernelVerdict | None) -> bool:
        """Whether the kernel says the same. A size is no difference: each may have limits of its own."""
        if answer is None:
            return False
        if answer.rule in SIZES or not SIZES.isdisjoint(self.rules):
            return True
        return (answer.verdict, answer.cost, answer.unplanned, answer.bound) == (self.verdict, *self.figures)


def decided(text: bytes) -> Decided:
    """Read a request as the kernel must, and decide it."""
    try:
        require_json(text)
        asked = msgspec.json.decode(text, type=Request)
        readers, decide = QUESTIONS[asked.op]
        if [name for name in DOCUMENTS if getattr(asked, name) is not ABSENT] != [*readers]:
            return Decided("bad input")
        instance = read_instance(bytes(asked.instance))
        if asked.op == "verify-bound":
            refuse_stops(instance)
        documents = [read(bytes(getattr(asked, name))) for name, read in readers.items()]
    except (Refusal, msgspec.DecodeError, KeyError):
        return Decided("bad input")
    return decide(instance, *documents)


def _certificates(data: bytes) -> list[QueryCertificateDocument]:
    return [read_query_certificate(bytes(each)) for each in msgspec.json.decode(data, type=list[msgspec.Raw])]


def _judged(instance: Instance, solution: Solution) -> Decided:
    verdict = judge(instance, solution)
    return Decided("accepted", (verdict.cost, verdict.unplanned, None)) if verdict.valid else Decided("refused")


def _proved(verify: Callable[[], int | None]) -> Decided:
    try:
        return Decided("accepted", (None, None, verify()))
    except Refusal as refusal:
        return Decided("refused", rules=(refusal.rule,))


def _bounded(instance: Instance, certificate: BoundDocument) -> Decided:
    """The kernel does not look at the digest of the instance."""
    own = msgspec.structs.replace(certificate, instance=digest(instance))
    return _proved(lambda: verify_bound(instance, own))


def _audited(instance: Instance, solution: Solution, certificates: Sequence[QueryCertificateDocument]) -> Decided:
    """Whether the plans are lawful together, and each, in their order, has a certificate of its arrival."""
    judged = _judged(instance, solution)
    plans = {plan.robot: plan for plan in solution.plans}
    traffic = Traffic(instance)
    for robot in solution.order if judged.verdict == "accepted" else ():
        if not any(_is_of(traffic, certificate, plans[robot]) for certificate in certificates):
            return Decided("refused")
        traffic.commit(plans[robot])
    return judged


def _is_of(traffic: Traffic, certificate: QueryCertificateDocument, plan: Plan) -> bool:
    """Whether the certificate shows that the plan's robot, if asked at tick 0, arrives no earlier."""
    if certificate.robot != plan.robot or (certificate.bound is not None and certificate.bound < plan.visits[-1].enter):
        return False
    return (
        _proved(lambda: require_certificate(traffic, msgspec.structs.replace(certificate, now=0))).verdict == "accepted"
    )


DOCUMENTS = ("solution", "certificate", "certificates")
QUESTIONS: Mapping[str, tuple[Mapping[str, Callable[[bytes], Any]], Callable[..., Decided]]] = {
    "check": ({"solution": read_solution}, _judged),
    "verify-query": (
        {"solution": read_solution, "certificate": read_query_certificate},
        lambda instance, *proof: _proved(lambda: verify_query(instance, *proof)),
    ),
    "verify-bound": ({"certificate": read_bound}, _bounded),
    "audit": ({"solution": read_solution, "certificates": _certificates}, _audited),
}
"""By op: the readers of its documents, and how it is decided."""


def compared(first: int, texts: Sequence[bytes]) -> Texts:
    """How often each verdict was given, and the texts on which the kernel differs."""
    found = [decided(text) for text in texts]
    block = Texts(len(texts), dict(Counter(each.verdict for each in found)), [])
    for number, (text, mine, kernel) in enumerate(zip(texts, found, answers(texts), strict=True), first):
        if not mine.agrees(kernel):
            difference = {"number": number, "text": text.decode("latin-1"), "python": mine, "kernel": kernel}
            block.differences.append(msgspec.to_builtins(difference))
    return block


def answers(texts: Sequence[bytes]) -> list[KernelVerdict | None]:
    """The kernel's answer to each text, none where it ends without one or thinks for too long."""
    found: list[KernelVerdict | None] = []
    while len(found) < len(texts):
        lines = replies([text + b"\n" for text in texts[len(found) :]], LONGEST)
        found += [verdict_of(line) if is_answer(line) else None for line in lines]
        if len(found) < len(texts):
            found.append(None)
    return found


def drawn_texts(seed: int, first: int, number: int) -> list[bytes]:
    """Texts from `first` on, each of a test vector or about a fleet of the block."""
    fleets = [each.request.rstrip() for fleet in range(FLEETS) for each in fleet_questions(seed, first + fleet)]
    audits = [audit_of(Draw(splitmix64(next(splitmix64(seed)) + first + fleet))) for fleet in range(FLEETS)]
    of_vectors = vector_requests()
    draws = (Draw(splitmix64(next(splitmix64(seed)) + number)) for number in range(first, first + number))
    return [changed(draw, draw.one_of(draw.one_of([fleets, audits, of_vectors, of_vectors]))) for draw in draws]


def audit_of(draw: Draw) -> bytes:
    """A request to audit a fleet, with a certificate for each plan."""
    instance = draw_instance(draw, draw.one_of([SMALL, WITH_STOPS]))
    solution = draw_fleet(draw, instance).solution
    plans = {plan.robot: plan for plan in solution.plans}
    before = [Solution.of(instance, [plans[each] for each in solution.order[:k]]) for k in range(len(solution.order))]
    certificates = [
        certified(instance, committed, robot, 0) for committed, robot in zip(before, solution.order, strict=True)
    ]
    return request("audit", instance, solution=solution_document(solution), certificates=certificates).rstrip()


TEXTS = Questions(
    "texts",
    "Let the proved kernel and Python read the same texts, nearly right ones, and decide on those that they can read.",
    "texts",
    "Texts read by the kernel and by Python",
    lambda case: compared(case.first, drawn_texts(case.seed, case.first, case.count)),
    Texts,
    {
        "texts": lambda block: block.texts,
        "accepted": lambda block: block.verdicts.get("accepted", 0),
        "refused": lambda block: block.verdicts.get("refused", 0),
        "bad input": lambda block: block.verdicts.get("bad input", 0),
    },
)
