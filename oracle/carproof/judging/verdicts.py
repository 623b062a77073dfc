"""Verdicts on certificates and proofs, by the checkers in Python or by the proved kernel."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from carp_spec import Instance, Refusal, Solution
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.instances import read_instance
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.documents.solutions import solution_document
from carp_spec.limits import refuse_stops
from carp_verify.bound.rules import ContradictionError, is_about
from carp_verify.bound.rules import size_fits as bound_size_fits
from carp_verify.kernel import KernelVerdict, UndecidedError, ask, find_program, is_answer, request
from carp_verify.kernel import verify_proof as ask_about_proof
from carp_verify.query.rules import size_fits as query_size_fits
from carproof.judging.audit import CHECKER
from carproof.judging.documents import VerifiedBoundDocument, VerifiedQueryDocument

if TYPE_CHECKING:
    from carp_verify.optimum.proof import ProofFiles, Verified

SIZES = {bound_size_fits.id, query_size_fits.id}


def verify_query(
    instance: Instance, solution: Solution, certificate: QueryCertificateDocument, kernel: bool
) -> VerifiedQueryDocument:
    """Whether a query certificate proves its bound; raises `ContradictionError` if the kernel decides otherwise."""
    plans = solution_document(solution)
    answer = ask([request("verify-query", instance, solution=plans, certificate=certificate)])[0] if kernel else None
    from carp_verify.query.verify import verify_query as verify  # noqa: PLC0415 - only for those who ask

    refusal, by = _decided(lambda: verify(instance, solution, certificate), certificate.bound, answer)
    if refusal is not None:
        return VerifiedQueryDocument(False, None, refusal.path, refusal.rule, refusal.message, by)
    return VerifiedQueryDocument(True, certificate.bound, None, None, None, by)


def verify_bound(instance: Instance, certificate: BoundDocument, kernel: bool) -> VerifiedBoundDocument:
    """Whether a certificate proves its lower bound; raises `ContradictionError` if the kernel decides otherwise."""
    answer = ask([request("verify-bound", instance, certificate=certificate)])[0] if kernel else None
    from carp_verify.bound.verify import verify_bound as verify  # noqa: PLC0415 - only for those who ask

    refusal, by = _decided(lambda: verify(instance, certificate), certificate.bound, answer)
    if refusal is not None:
        return VerifiedBoundDocument(None, refusal.path, refusal.rule, refusal.message, by)
    return VerifiedBoundDocument(certificate.bound, None, None, None, by)


def _decided(
    verify: Callable[[], int | None], bound: int | None, answer: KernelVerdict | None
) -> tuple[Refusal | None, str]:
    """Why a certificate is refused, if it is, and who decided: the kernel, if there is an answer of it.

    A refusal for a size is no contradiction: the kernel and the checkers in Python need not have the same limits. The
    kernel does not look at the instance that a certificate names.
    """
    refusal = None
    try:
        verify()
    except Refusal as found:
        refusal = found
    if answer is None or (refusal is not None and refusal.rule == is_about.id):
        return refusal, CHECKER
    refused = None
    if not answer.accepted:
        refused = Refusal("document", answer.path, answer.rule or is_answer.id, answer.message or "it is refused")
    elif answer.bound != bound:
        raise ContradictionError(f"{answer.by} proves {answer.bound}, and the certificate says {bound}")
    if (refused is None) != (refusal is None) and SIZES.isdisjoint(each.rule for each in (refused, refusal) if each):
        raise ContradictionError(f"{CHECKER} and {answer.by} differ: only one of them finds {refused or refusal}")
    return refused, answer.by


def verify_proof(folder: Path, instance: Instance | None, kernel: bool) -> "tuple[Verified, str | None]":
    """Verify a proof directory; also the name of the kernel that proves it too, which is asked where it is built.

    Raises `ProofError`, `ContradictionError` if the kernel decides otherwise, and if the kernel is demanded also
    `Refusal` if it is not there or knows no such claim, and `UndecidedError`.
    """
    from carp_verify.optimum.proof import read_proof  # noqa: PLC0415 - loads the encoder
    from carp_verify.optimum.proof import verify_proof as verify  # noqa: PLC0415

    proof = read_proof(folder)
    verified = verify(proof, instance)
    if not kernel and find_program() is None:
        return verified, None
    try:
        return verified, _proof_by_kernel(proof, verified)
    except (Refusal, UndecidedError):
        if kernel:
            raise
        return verified, None


def _proof_by_kernel(proof: "ProofFiles", verified: "Verified") -> str:
    """The kernel's name, if its formula of a smaller total is refuted and it finds the plans lawful."""
    refuse_stops(read_instance(proof.contents["instance.json"]))
    names = ("instance.json", "manifest.json", "beat.lrat")
    answer = ask_about_proof({name: proof.contents[name] for name in names if name in proof.contents})
    if (answer.accepted, answer.bound) != (True, verified.cost):
        raise ContradictionError(f"{CHECKER} and {answer.by} differ: {answer.message or answer.bound}")
    if verified.solution is not None:
        instance = read_instance(proof.contents["instance.json"])
        (judged,) = ask([request("check", instance, solution=solution_document(verified.solution))])
        if (judged.accepted, judged.cost, judged.unplanned) != (True, verified.cost, 0):
            raise ContradictionError(f"{CHECKER} and {judged.by} differ: {judged.message or judged.cost}")
    return answer.by
