"""The ops that judge: solutions, and certificates."""

from dataclasses import dataclass
from time import perf_counter

from carp_spec import Instance, Solution
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.documents.verdicts import VerdictDocument, verdict_document
from carproof.api.judging import check as judged
from carproof.engines import Engine
from carproof.judging.audit import ask_kernel, audit_in_order
from carproof.judging.documents import AuditDocument, VerifiedBoundDocument, VerifiedQueryDocument, audit_document
from carproof.judging.verdicts import verify_bound as bound_verdict
from carproof.judging.verdicts import verify_query as query_verdict
from carproof.layouts.settings import footprint, step_of_cells
from carproof.requests import deadline, inside, sound_within


@dataclass(frozen=True, slots=True)
class CheckRequest:
    """A solution to judge; the size of vehicles that must keep apart, and the step of the positions of cells."""

    instance: Instance
    solution: Solution
    footprint: str | None = None
    cells: str | None = None


def check(request: CheckRequest, engine: Engine) -> VerdictDocument:
    """Judge a solution, with a footprint like 900x600mm also by it, and list the first 100 violations of each rule."""
    del engine
    size = None if request.footprint is None else footprint(request.footprint)
    cells = None if request.cells is None else step_of_cells(request.cells)
    with inside("$.instance"):
        verdict = judged(request.instance, request.solution, footprint=size, cells=cells)
    return verdict_document(verdict)


@dataclass(frozen=True, slots=True)
class VerifyBoundRequest:
    """The certificate of a lower bound, and whether the proved kernel is to decide."""

    instance: Instance
    certificate: BoundDocument
    kernel: bool = False


def verify_bound(request: VerifyBoundRequest, engine: Engine) -> VerifiedBoundDocument:
    """Check the certificate of a lower bound."""
    del engine
    return bound_verdict(request.instance, request.certificate, request.kernel)


@dataclass(frozen=True, slots=True)
class VerifyQueryRequest:
    """The certificate of a query beside the plans of a solution, and whether the proved kernel is to decide."""

    instance: Instance
    solution: Solution
    certificate: QueryCertificateDocument
    kernel: bool = False


def verify_query(request: VerifyQueryRequest, engine: Engine) -> VerifiedQueryDocument:
    """Check the certificate of a query."""
    del engine
    return query_verdict(request.instance, request.solution, request.certificate, request.kernel)


@dataclass(frozen=True, slots=True)
class AuditRequest:
    """A solution, whether the proved kernel is to decide, and the time to look at plans."""

    instance: Instance
    solution: Solution
    kernel: bool = False
    seconds: float | None = None


def audit(request: AuditRequest, engine: Engine) -> AuditDocument:
    """Certify that no robot can arrive earlier beside the plans before its own in planning order."""
    until = deadline(request.seconds)
    sound = sound_within(request.instance, request.solution)
    with inside("$.instance"):
        found = audit_in_order(request.instance, sound, engine, goes_on=lambda: perf_counter() < until)
    if request.kernel:
        ask_kernel(request.instance, found)
    return audit_document(found, sound)
