"""Verdicts on certificates and proofs, by the checkers in Python or by the proved kernel."""

from pathlib import Path
from typing import TYPE_CHECKING

from carp_spec import Instance, Refusal, Solution
from carp_spec.query_certificates import QueryCertificateDocument
from carp_verify.bound_rules import ContradictionError
from carp_verify.bounds import BoundDocument
from carp_verify.documents import read_instance, solution_document
from carp_verify.kernel import UndecidedError, ask, find_program, request
from carp_verify.kernel import verify_proof as ask_about_proof
from carproof.audit import CHECKER
from carproof.results import VerifiedBoundDocument, VerifiedQueryDocument

if TYPE_CHECKING:
    from carp_verify.proof import ProofFiles, Verified


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
        (answer,) = ask([request("verify-bound", instance, certificate=certificate)])
        if answer.accepted:
            return VerifiedBoundDocument(certificate.bound, None, None, None, answer.by)
        return VerifiedBoundDocument(None, answer.path, answer.rule, answer.message, answer.by)
    from carp_verify.verify_bound import verify_bound as verify  # noqa: PLC0415 - only for those who ask

    try:
        return VerifiedBoundDocument(verify(instance, certificate), None, None, None, CHECKER)
    except Refusal as refusal:
        return VerifiedBoundDocument(None, refusal.path, refusal.rule, refusal.message, CHECKER)


def verify_proof(folder: Path, instance: Instance | None, kernel: bool) -> "tuple[Verified, str | None]":
    """Verify a proof directory; also the name of the kernel that proves it too, which is asked where it is built.

    Raises `ProofError`, `ContradictionError` if the kernel decides otherwise, and if the kernel is demanded also
    `Refusal` if it is not there or knows no such claim, and `UndecidedError`.
    """
    from carp_verify.proof import read_proof  # noqa: PLC0415 - loads the encoder
    from carp_verify.proof import verify_proof as verify  # noqa: PLC0415

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
