"""The ops that judge: solutions, and certificates."""

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
from carproof.layouts.settings import footprint as footprint_of
from carproof.layouts.settings import step_of_cells
from carproof.requests import deadline, inside, inside_documents, sound_within


def check(
    instance: Instance, solution: Solution, footprint: str | None = None, cells: str | None = None
) -> VerdictDocument:
    """Judge a solution, with a footprint like 900x600mm also by it, and list the first 100 violations of each rule."""
    size = None if footprint is None else footprint_of(footprint)
    step = None if cells is None else step_of_cells(cells)
    with inside("$.instance"):
        verdict = judged(instance, solution, footprint=size, cells=step)
    return verdict_document(verdict)


def verify_bound(instance: Instance, certificate: BoundDocument, kernel: bool = False) -> VerifiedBoundDocument:
    """Check the certificate of a lower bound. With `kernel` the proved kernel decides."""
    return bound_verdict(instance, certificate, kernel)


def verify_query(
    instance: Instance, solution: Solution, certificate: QueryCertificateDocument, kernel: bool = False
) -> VerifiedQueryDocument:
    """Check the certificate of a query. It is about the plans of a solution; `kernel` lets the proved kernel decide."""
    return query_verdict(instance, solution, certificate, kernel)


def audit(
    instance: Instance, solution: Solution, kernel: bool = False, seconds: float | None = None, *, engine: Engine
) -> AuditDocument:
    """Certify that no robot can arrive earlier beside the plans before its own in planning order.

    With `kernel` the proved kernel decides. Plans that are not looked at in `seconds` are undecided.
    """
    until = deadline(seconds)
    sound = sound_within(instance, solution)
    with inside_documents():
        found = audit_in_order(instance, sound, engine, goes_on=lambda: perf_counter() < until)
    if kernel:
        ask_kernel(instance, found)
    return audit_document(found, sound)
