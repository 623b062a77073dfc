"""Writes proof directories, which `carp_verify.optimum.proof` describes and checks."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from hashlib import sha256
from pathlib import Path

import msgspec

from carp_optimum.deadline import LOOKS, Deadline, TimeOver, clock_of
from carp_optimum.sat.core_guided import Optimum
from carp_optimum.sat.lrat_hints import NoHintsError, refutation_with_hints
from carp_optimum.sat.solver import Solver
from carp_spec import Instance, Refusal
from carp_spec.documents.instances import write_instance
from carp_spec.inputs.options import require_limits
from carp_spec.inputs.values import require_instance
from carp_verify.bound.rules import ContradictionError
from carp_verify.optimum.clauses import Formula, dimacs
from carp_verify.optimum.encoding import Evidence, beat_formula, reach_formula
from carp_verify.optimum.proof import PROOF_FORMAT, Manifest, UnsolvableManifest, variables
from carp_verify.optimum.rules import is_provable
from carp_verify.optimum.unsolvable import Clauses


def write_proof(instance: Instance, best: Optimum, directory: Path | str, limit: float) -> None:
    """Write the proof directory of an answer; raises `TimeOver` if that takes more than `limit` seconds."""
    require_instance(instance)
    require_limits(limit=limit)
    if not is_provable(best.decided):
        message = "there is a proof directory only for an answer that the search has found"
        raise Refusal("request", "$.proof", is_provable.id, message)
    deadline = Deadline(limit)
    files = {"instance.json": write_instance(instance)}
    if best.cost is not None:
        reach = reach_formula(instance, best.cost, best.evidence)
        files["reach.cnf"] = dimacs(reach.formula).encode()
        files["reach.model"] = _model_text(_model(reach.formula, deadline)).encode()
        files["variables.json"] = variables(reach)
        files |= _beaten(beat_formula(instance, best.cost, best.evidence).formula, deadline)
    elif isinstance(best.obstacle, Clauses):
        evidence = Evidence(best.obstacle.horizons, ())
        files |= _beaten(beat_formula(instance, None, evidence).formula, deadline)
    manifest = _manifest_of(best, {name: sha256(content).hexdigest() for name, content in files.items()})
    files["manifest.json"] = msgspec.json.encode(manifest) + b"\n"
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


def _beaten(formula: Formula, deadline: Deadline) -> Mapping[str, bytes]:
    return {"beat.cnf": dimacs(formula).encode(), "beat.lrat": refutation(formula, deadline).encode()}


def _manifest_of(best: Optimum, digests: Mapping[str, str]) -> Manifest | UnsolvableManifest:
    if best.obstacle is not None:
        return UnsolvableManifest(PROOF_FORMAT, "unsolvable", best.obstacle, digests)
    assert best.cost is not None  # noqa: S101 - an answer without a cost has an obstacle
    return Manifest(PROOF_FORMAT, "optimum", best.cost, best.evidence.horizons, best.evidence.order, digests)


def _model(formula: Formula, deadline: Deadline) -> Sequence[bool]:
    with closing(Solver(formula, deadline.check)) as solver:
        if not solver.satisfiable([]):
            raise ContradictionError("the search has found an optimum whose formula has no model")
        return solver.model()


def refutation(formula: Formula, deadline: Deadline) -> str:
    """A refutation of the formula, with hints.

    Raises `TimeOver`, `ContradictionError` if the formula has a model, and `Refusal` if a step has no hints.
    """
    if () in formula.clauses:
        return refutation_with_hints(formula.clauses, (), deadline.check)
    with closing(Solver(formula, deadline.check, with_proof=True)) as solver:
        if solver.satisfiable([]):
            raise ContradictionError(
                "the search has found that no plans cost less, and the formula of such plans has a model"
            )
        try:
            return refutation_with_hints(formula.clauses, solver.proof(), deadline.check)
        except NoHintsError as error:
            message = f"the solver's refutation has a step that no hints can justify: {error}"
            raise Refusal("request", "$.proof", is_provable.id, message) from error


def short_refutation(make: Callable[[], Formula], check: Callable[[], None], longest: int) -> str:
    """A refutation of the formula made, of at most so many characters; nothing if it is not soon found, or too large.

    `check` is called now and then, and may raise `TimeOver`.
    """
    try:
        lines = refutation(make(), Deadline(LOOKS, clock_of(check)))
    except (TimeOver, Refusal):
        check()
        return ""
    return lines if len(lines) <= longest else ""


def _model_text(model: Sequence[bool]) -> str:
    literals = [variable if model[variable] else -variable for variable in range(1, len(model))]
    return " ".join(map(str, (*literals, 0))) + "\n"
