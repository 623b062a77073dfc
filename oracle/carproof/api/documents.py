"""Verdicts read from documents, and certificates written to them."""

import msgspec

from carp_spec import Refusal, Verdict, Violation
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.decoding import decode, write
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.documents.verdicts import VERDICT_FORMAT, VerdictDocument, ViolationDocument
from carp_spec.shapes import SHAPE, require_shape


def read_verdict(data: bytes) -> Verdict:
    """Read a verdict document; raises `Refusal` if it is malformed."""
    document = decode(data, VerdictDocument, VERDICT_FORMAT)
    if document.valid == bool(document.violations):
        raise Refusal("document", "$.valid", SHAPE, "it must be true if there are no violations, and else false")
    return Verdict(document.cost, document.unplanned, tuple(map(_violation, document.violations)))


def _violation(document: ViolationDocument) -> Violation:
    """The violation of a document, whose message ends with the reason in brackets if carproof wrote it."""
    rule, robots, resource, start, end, message = msgspec.structs.astuple(document)
    head = Violation(rule, robots, resource, start, end, "").message.removesuffix(")")
    is_ours = message.startswith(head) and message.endswith(")")
    reason = message.removeprefix(head).removesuffix(")") if is_ours else message
    return Violation(rule, robots, resource, start, end, reason)


def write_bound(certificate: BoundDocument) -> bytes:
    """Write the certificate of a lower bound."""
    require_shape(certificate, BoundDocument)
    return write(certificate)


def write_query_certificate(certificate: QueryCertificateDocument) -> bytes:
    """Write the certificate of a query."""
    require_shape(certificate, QueryCertificateDocument)
    return write(certificate)
