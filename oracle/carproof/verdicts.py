"""Verdicts on certificates as documents, by the checkers in Python or by the proved kernel."""

from carp_spec import Instance, Refusal, Solution
from carp_spec.query_certificates import QueryCertificateDocument
from carp_verify.bounds import BoundDocument
from carp_verify.documents import solution_document
from carp_verify.kernel import UndecidedError, ask, request
from carp_verify.kernel import verify_bound as ask_about_bound
from carproof.audit import CHECKER
from carproof.results import VerifiedBoundDocument, VerifiedQueryDocument


def verify_query(
    instance: Instance, solution: Solution, certificate: QueryCertificateDocument, kernel: bool
) -> VerifiedQueryDocument:
    """Whether a query certificate proves its bound."""
    if kernel:
        question = request("verify-query", instance, solution=solution_document(solution), certificate=certificate)
        (answer,) = ask([question])
        if answer.accepted:
            return VerifiedQueryDocument(True, certificate.bound, None, None, None, answer.by)
        return VerifiedQueryDocument(False, None, answer.path, answer.rule, answer.message, answer.by)
    from carp_verify.verify_query import verify_query as verify  # noqa: PLC0415 - only for those who ask

    try:
        return VerifiedQueryDocument(True, verify(instance, solution, certificate), None, None, None, CHECKER)
    except Refusal as refusal:
        return VerifiedQueryDocument(False, None, refusal.path, refusal.rule, refusal.message, CHECKER)


def verify_bound(instance: Instance, certificate: BoundDocument, kernel: bool) -> VerifiedBoundDocument:
    """Whether a certificate proves its lower bound."""
    if kernel:
        return _bound_by_kernel(instance, certificate)
    from carp_verify.verify_bound import verify_bound as verify  # noqa: PLC0415 - only for those who ask

    try:
        return VerifiedBoundDocument(verify(instance, certificate), None, None, None, CHECKER)
    except Refusal as refusal:
        return VerifiedBoundDocument(None, refusal.path, refusal.rule, refusal.message, CHECKER)


def _bound_by_kernel(instance: Instance, certificate: BoundDocument) -> VerifiedBoundDocument:
    """The verdict of the kernel; it assumes that the formulas of cuts, which `carp_verify` makes, are right.

    Raises `UndecidedError` for a certificate with deadlines.
    """
    if certificate.deadlines:
        raise UndecidedError("the kernel has no theorem about deadlines: verify-bound without --kernel checks them")
    formulas = {}
    if certificate.cuts:
        from carp_verify.bound_cuts import formula_of  # noqa: PLC0415 - only cuts need the encoder
        from carp_verify.bound_rules import LARGEST_FORMULA, is_weight  # noqa: PLC0415
        from carp_verify.clauses import dimacs  # noqa: PLC0415
        from carp_verify.refutation import NotRefutedError  # noqa: PLC0415

        for number, cut in enumerate(certificate.cuts):
            try:
                formulas[number] = dimacs(formula_of(instance, cut, LARGEST_FORMULA))
            except NotRefutedError as error:
                return VerifiedBoundDocument(None, f"$.cuts[{number}]", is_weight.id, str(error), CHECKER)
    answer = ask_about_bound(instance, certificate, formulas)
    if answer.accepted:
        return VerifiedBoundDocument(certificate.bound, None, None, None, answer.by, answer.assumed)
    return VerifiedBoundDocument(None, answer.path, answer.rule, answer.message, answer.by)
