"""A proof directory: that the optimum of an instance is K, for others to check.

- `manifest.json`: the cost K, each robot's horizon and the order of adding delays (all that the encoder needs
  beside the instance; any values are sound), and the SHA-256 digest of every other file
- `instance.json`: the instance
- `reach.cnf`: the encoding's clauses for a total of at most K, no robot later than its horizon
- `reach.model`: a model of them, as the literals that hold, closed by 0
- `variables.json`: which variable is which node and which delay of each robot: enough to read the plans in the model
- `beat.cnf`: the encoding's clauses for a total of at most K - 1, robots later than their horizons left free
- `beat.lrat`: a refutation of them with hints, LRAT without RAT steps

`verify_proof` believes none of them: it makes both formulas again from the instance and compares, evaluates the model,
has the plans judged by carp_spec, checks the refutation (`carp_verify.refutation`), and asks z3 for both formulas too.
It accepts formulas of at most `LARGEST_PROOF` clauses each and files of at most `LARGEST_FILE` bytes.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import msgspec

from carp_spec import Instance, Plan, Refusal, Solution, judge, read_instance, write_instance
from carp_spec.documents import decode, has_format
from carp_spec.model import ResourceId, RobotId
from carp_verify.clauses import Formula, dimacs
from carp_verify.encoding import Encoding
from carp_verify.hints import NoHintsError, refutation_with_hints
from carp_verify.optimum import Evidence, Optimum
from carp_verify.optimum_rules import is_provable
from carp_verify.refutation import NotRefutedError, require_refutation
from carp_verify.solver import Deadline, Solver

PROOF_FORMAT = "carproof-proof/2"
OLD_FORMAT = "carproof-proof/1"
FILES = ("instance.json", "reach.cnf", "reach.model", "variables.json", "beat.cnf", "beat.lrat")
LONGEST_Z3_MS = 60_000
LARGEST_PROOF = 5_000_000
LARGEST_FILE = 1 << 30
_LITERAL = re.compile(b"-?[1-9][0-9]{0,17}")


class ProofError(Exception):
    """A proof directory that does not prove what it claims: in which file, and why."""

    def __init__(self, file: str, reason: str) -> None:
        super().__init__(file, reason)
        self.file = file
        self.reason = reason

    def __str__(self) -> str:
        """One sentence."""
        return f"{self.file}: {self.reason}"


class Manifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a proof directory claims, and what its formulas were made from."""

    format: str
    cost: int
    horizons: tuple[int, ...]
    order: tuple[int, ...]
    sha256: Mapping[str, str]


class RobotVariables(msgspec.Struct, frozen=True):
    """The variables of a robot: `late[k]` holds if its delay exceeds k; a node is a resource, a tick and a variable."""

    robot: RobotId
    late: tuple[int, ...]
    nodes: tuple[tuple[ResourceId, int, int], ...]


@dataclass(frozen=True, slots=True)
class Verified:
    """What a proof directory proves, and what z3 answers about its formulas: `unknown` if they take it too long."""

    cost: int
    solution: Solution
    z3_reach: str
    z3_beat: str

    @property
    def is_decided(self) -> bool:
        """Whether z3 has answered; if not, the cost rests on the refutation alone."""
        return "unknown" not in (self.z3_reach, self.z3_beat)


def reach_formula(instance: Instance, cost: int, evidence: Evidence) -> Encoding:
    """The encoding of plans whose total is at most `cost`, each within its robot's horizon.

    Raises `Refusal` if it would have more clauses than a proof may.
    """
    encoding = _bounded(instance, cost + 1, evidence, LARGEST_PROOF)
    encoding.close()
    return encoding


def beat_formula(instance: Instance, cost: int, evidence: Evidence, most: int = LARGEST_PROOF) -> Encoding:
    """The relaxed encoding of plans whose total is less than `cost`; raises `Refusal` beyond `most` clauses."""
    return _bounded(instance, cost, evidence, most)


def _bounded(instance: Instance, bound: int, evidence: Evidence, most: int) -> Encoding:
    encoding = Encoding(instance, most=most)
    encoding.grow_to(evidence.horizons)
    encoding.forbid_all()
    encoding.bound_delays(bound - encoding.shortest, evidence.order)
    return encoding


def write_proof(instance: Instance, best: Optimum, directory: Path, limit: float) -> None:
    """Write the proof directory of a proved optimum; raises `TimeOver` if that takes more than `limit` seconds."""
    if best.cost is None or not is_provable(best.decided, best.cost):
        message = "there is a proof directory only for a proved optimum"
        raise Refusal("request", "$.proof", is_provable.id, message)
    deadline = Deadline(limit)
    reach = reach_formula(instance, best.cost, best.evidence)
    model = _model(reach.formula, deadline)
    beat = beat_formula(instance, best.cost, best.evidence)
    files = {
        "instance.json": write_instance(instance),
        "reach.cnf": dimacs(reach.formula).encode(),
        "reach.model": _model_text(model).encode(),
        "variables.json": _variables(reach),
        "beat.cnf": dimacs(beat.formula).encode(),
        "beat.lrat": refutation(beat.formula, deadline).encode(),
    }
    digests = {name: sha256(content).hexdigest() for name, content in files.items()}
    manifest = Manifest(PROOF_FORMAT, best.cost, best.evidence.horizons, best.evidence.order, digests)
    files["manifest.json"] = msgspec.json.encode(manifest) + b"\n"
    directory.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (directory / name).write_bytes(content)


def _model(formula: Formula, deadline: Deadline) -> Sequence[bool]:
    solver = Solver(formula, deadline.check)
    try:
        if not solver.satisfiable([]):
            message = "the formula of the optimum has no model; the optimum is not one"
            raise Refusal("request", "$.proof", is_provable.id, message)
        return solver.model()
    finally:
        solver.close()


def refutation(formula: Formula, deadline: Deadline) -> str:
    """A refutation of the formula, with hints; raises `TimeOver`, and `Refusal` if the formula has a model."""
    if () in formula.clauses:
        return refutation_with_hints(formula.clauses, (), deadline.check)
    solver = Solver(formula, deadline.check, with_proof=True)
    try:
        if solver.satisfiable([]):
            message = "the formula below the optimum has a model; the optimum is not one"
            raise Refusal("request", "$.proof", is_provable.id, message)
        return refutation_with_hints(formula.clauses, solver.proof(), deadline.check)
    except NoHintsError as error:
        message = f"the solver's refutation has a step that no hints can justify: {error}"
        raise Refusal("request", "$.proof", is_provable.id, message) from error
    finally:
        solver.close()


def _model_text(model: Sequence[bool]) -> str:
    literals = [variable if model[variable] else -variable for variable in range(1, len(model))]
    return " ".join(map(str, (*literals, 0))) + "\n"


def _variables(encoding: Encoding) -> bytes:
    robots = [
        RobotVariables(
            robot.robot.id,
            tuple(robot.late),
            tuple((resource, tick, variable) for (resource, tick), variable in robot.node.items()),
        )
        for robot in encoding.robots
    ]
    return msgspec.json.format(msgspec.json.encode(robots)) + b"\n"


def verify_proof(directory: Path, instance: Instance | None = None) -> Verified:
    """Check a proof directory, and that it is about the instance, if one is given.

    Raises `ProofError` where it does not prove its claim, and `Refusal` if its instance is malformed.
    """
    manifest, files = _read(directory)
    proved = read_instance(files["instance.json"])
    if instance is not None and write_instance(instance) != write_instance(proved):
        raise ProofError("instance.json", "it is another instance than the one given")
    evidence = _evidence(proved, manifest)
    reach, beat = _formulas(proved, manifest.cost, evidence)
    _compare("reach.cnf", dimacs(reach.formula), files)
    _compare("variables.json", _variables(reach).decode(), files)
    solution = _solution(proved, reach, manifest.cost, files["reach.model"])
    _compare("beat.cnf", dimacs(beat.formula), files)
    _require_refutation(beat.formula, files)
    answers = _ask_z3(files["reach.cnf"]), _ask_z3(files["beat.cnf"])
    for name, answer, wrong in zip(("reach.cnf", "beat.cnf"), answers, ("unsat", "sat"), strict=True):
        if answer == wrong:
            raise ProofError(name, f"z3 finds it {wrong}, against the evidence")
    return Verified(manifest.cost, solution, *answers)


def _read(directory: Path) -> tuple[Manifest, Mapping[str, bytes]]:
    """The manifest and the files, each with the digest that the manifest gives."""
    content = _read_file(directory, "manifest.json")
    if has_format(content, OLD_FORMAT):
        reason = f"{OLD_FORMAT} has a refutation without hints, which is not accepted; write the proof again"
        raise ProofError("manifest.json", reason)
    try:
        manifest = decode(content, Manifest, PROOF_FORMAT)
    except Refusal as refusal:
        raise ProofError("manifest.json", f"it must be a manifest: {refusal}") from refusal
    if sorted(manifest.sha256) != sorted(FILES):
        raise ProofError("manifest.json", f"it must have the digests of {', '.join(FILES)}")
    files = {name: _read_file(directory, name) for name in FILES}
    for name in FILES:
        if sha256(files[name]).hexdigest() != manifest.sha256[name]:
            raise ProofError(name, "its SHA-256 digest is not the one in the manifest")
    return manifest, files


def _read_file(directory: Path, name: str) -> bytes:
    path = directory / name
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ProofError(name, f"it has more than {LARGEST_FILE} bytes")
        return path.read_bytes()
    except OSError as error:
        raise ProofError(name, f"it cannot be read: {error.strerror}") from error


def _evidence(instance: Instance, manifest: Manifest) -> Evidence:
    """The evidence in the manifest, if it fits the instance."""
    robots = len(instance.robots)
    encoding = Encoding(instance)
    if encoding.wayless:
        raise ProofError("instance.json", "a robot has no way to its goal, so there is no optimum")
    if len(manifest.horizons) != robots or sorted(manifest.order) != list(range(robots)):
        raise ProofError("manifest.json", f"it must have a horizon of each of {robots} robots, and an order of them")
    if any(not 0 <= horizon <= manifest.cost for horizon in manifest.horizons):
        raise ProofError("manifest.json", "a horizon must be between 0 and the cost")
    if not encoding.shortest <= manifest.cost <= encoding.shortest + sum(manifest.horizons):
        reason = "the cost must be at least that of the shortest paths, and at most all horizons above it"
        raise ProofError("manifest.json", reason)
    return Evidence(manifest.horizons, manifest.order)


def _formulas(instance: Instance, cost: int, evidence: Evidence) -> tuple[Encoding, Encoding]:
    try:
        return reach_formula(instance, cost, evidence), beat_formula(instance, cost, evidence)
    except Refusal as refusal:
        raise ProofError("manifest.json", f"its horizons make formulas too large: {refusal.message}") from refusal


def _compare(name: str, right: str, files: Mapping[str, bytes]) -> None:
    """Hold a file against what the encoder makes of the instance."""
    lines, found = right.splitlines(), files[name].decode(errors="replace").splitlines()
    for number, (line, other) in enumerate(zip(lines, found, strict=False), start=1):
        if line != other:
            raise ProofError(name, f"line {number} must be {line!r} for this instance, and is {other!r}")
    if len(lines) != len(found) or right.encode() != files[name]:
        raise ProofError(name, f"it must have {len(lines)} lines for this instance, and has {len(found)}")


def _solution(instance: Instance, encoding: Encoding, cost: int, text: bytes) -> Solution:
    """The plans in the model, which must be one of the clauses, judged by carp_spec."""
    formula = encoding.formula
    words = text.split()
    if words[-1:] != [b"0"] or not all(map(_LITERAL.fullmatch, words[:-1])):
        raise ProofError("reach.model", "it must be whole numbers other than 0, of at most 18 digits, closed by 0")
    literals = [int(word) for word in words[:-1]]
    if sorted(map(abs, literals)) != list(range(1, formula.variables + 1)):
        raise ProofError("reach.model", f"it must give each of {formula.variables} variables one value")
    true = set(literals)
    for number, clause in enumerate(formula.clauses, start=1):
        if true.isdisjoint(clause):
            raise ProofError("reach.model", f"it breaks clause {number} of reach.cnf")
    plans = encoding.plans([variable in true for variable in range(formula.variables + 1)])
    solution = solution_of([plan for plan in plans if plan is not None])
    verdict = judge(instance, solution)
    if verdict.violations:
        raise ProofError("reach.model", f"its plans break a rule: {verdict.violations[0]}")
    if verdict.unplanned or verdict.cost != cost:
        raise ProofError("reach.model", f"its plans must cost {cost}, and cost {verdict.cost}")
    return solution


def solution_of(plans: Sequence[Plan]) -> Solution:
    """A solution of the plans, in their order."""
    return Solution(tuple(plans), tuple(plan.robot for plan in plans))


def _require_refutation(formula: Formula, files: Mapping[str, bytes]) -> None:
    try:
        require_refutation(formula.clauses, files["beat.lrat"].decode())
    except (NotRefutedError, UnicodeDecodeError) as error:
        raise ProofError("beat.lrat", f"it does not show that beat.cnf has no model: {error}") from error


def _ask_z3(formula: bytes) -> str:
    import z3  # noqa: PLC0415 - slow to load

    solver = z3.Solver()
    solver.set("timeout", LONGEST_Z3_MS)
    solver.from_string(formula.decode())
    return str(solver.check())
