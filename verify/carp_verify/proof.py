"""A proof directory: that the optimum of an instance is K, for others to check.

- `manifest.json`: the cost K, each robot's horizon and the order of adding delays (all that the encoder needs
  beside the instance; any values are sound), and the SHA-256 digest of every other file
- `instance.json`: the instance
- `reach.cnf`: the encoding's clauses for a total of at most K, no robot later than its horizon
- `reach.model`: a model of them, as the literals that hold, closed by 0
- `variables.json`: which variable is which node and which delay of each robot: enough to read the plans in the model
- `beat.cnf`: the encoding's clauses for a total of at most K - 1, robots later than their horizons left free
- `beat.drat`: a DRAT proof that they have no model

`verify_proof` believes none of them: it makes both formulas anew from the instance and compares, evaluates the
model, has the plans judged by carp_spec, replays the DRAT proof with dratify, and asks z3 for both formulas too.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import msgspec

from carp_spec import Instance, Plan, Refusal, Solution, judge, read_instance, write_instance
from carp_spec.model import ResourceId, RobotId
from carp_verify.clauses import Formula, dimacs
from carp_verify.encoding import Encoding
from carp_verify.optimum import Evidence, Optimum
from carp_verify.optimum_rules import is_provable
from carp_verify.solver import Deadline, Solver

PROOF_FORMAT = "carproof-proof/1"
FILES = ("instance.json", "reach.cnf", "reach.model", "variables.json", "beat.cnf", "beat.drat")
LONGEST_Z3_MS = 60_000


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
    """What a proof directory proves, and what z3 says of its formulas (`unknown` if they take it too long)."""

    cost: int
    solution: Solution
    z3_reach: str
    z3_beat: str


def reach_formula(instance: Instance, cost: int, evidence: Evidence) -> Encoding:
    """The encoding of plans whose total is at most `cost`, each within its robot's horizon."""
    encoding = _bounded(instance, cost + 1, evidence)
    encoding.close()
    return encoding


def beat_formula(instance: Instance, cost: int, evidence: Evidence) -> Encoding:
    """The relaxed encoding of plans whose total is less than `cost`."""
    return _bounded(instance, cost, evidence)


def _bounded(instance: Instance, bound: int, evidence: Evidence) -> Encoding:
    encoding = Encoding(instance)
    encoding.grow_to(evidence.horizons)
    encoding.forbid_all()
    encoding.bound_delays(bound - encoding.shortest, evidence.order)
    return encoding


def write_proof(instance: Instance, best: Optimum, directory: Path, limit: float) -> None:
    """Write the proof directory of a proved optimum; raises `TimeOver` if that takes more than `limit` seconds."""
    if best.cost is None or not is_provable(best.proved, best.cost):
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
        "beat.drat": refutation(beat.formula, deadline).encode(),
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
    """The DRAT proof that the formula has no model; raises `TimeOver`, and `Refusal` if it has one."""
    if () in formula.clauses:
        return "0\n"
    solver = Solver(formula, deadline.check, with_proof=True)
    try:
        if solver.satisfiable([]):
            message = "the formula below the optimum has a model; the optimum is not one"
            raise Refusal("request", "$.proof", is_provable.id, message)
        return solver.proof()
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
    reach = reach_formula(proved, manifest.cost, evidence)
    _compare("reach.cnf", dimacs(reach.formula), files)
    _compare("variables.json", _variables(reach).decode(), files)
    solution = _solution(proved, reach, manifest.cost, files["reach.model"])
    beat = beat_formula(proved, manifest.cost, evidence)
    _compare("beat.cnf", dimacs(beat.formula), files)
    _replay(files)
    answers = _ask_z3(directory / "reach.cnf"), _ask_z3(directory / "beat.cnf")
    for name, answer, wrong in zip(("reach.cnf", "beat.cnf"), answers, ("unsat", "sat"), strict=True):
        if answer == wrong:
            raise ProofError(name, f"z3 finds it {wrong}, against the evidence")
    return Verified(manifest.cost, solution, *answers)


def _read(directory: Path) -> tuple[Manifest, Mapping[str, bytes]]:
    """The manifest and the files, each with the digest that the manifest gives."""
    content = _read_file(directory, "manifest.json")
    try:
        manifest = msgspec.json.decode(content, type=Manifest)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ProofError("manifest.json", f"it must be a manifest: {error}") from error
    if manifest.format != PROOF_FORMAT:
        raise ProofError("manifest.json", f"the format must be {PROOF_FORMAT}")
    if sorted(manifest.sha256) != sorted(FILES):
        raise ProofError("manifest.json", f"it must have the digests of {', '.join(FILES)}")
    files = {name: _read_file(directory, name) for name in FILES}
    for name in FILES:
        if sha256(files[name]).hexdigest() != manifest.sha256[name]:
            raise ProofError(name, "its SHA-256 digest is not the one in the manifest")
    return manifest, files


def _read_file(directory: Path, name: str) -> bytes:
    try:
        return (directory / name).read_bytes()
    except OSError as error:
        raise ProofError(name, f"it cannot be read: {error.strerror}") from error


def _evidence(instance: Instance, manifest: Manifest) -> Evidence:
    """The evidence in the manifest, if it fits the instance."""
    robots = len(instance.robots)
    if Encoding(instance).wayless:
        raise ProofError("instance.json", "a robot has no way to its goal, so there is no optimum")
    if len(manifest.horizons) != robots or sorted(manifest.order) != list(range(robots)):
        raise ProofError("manifest.json", f"it must have a horizon of each of {robots} robots, and an order of them")
    if any(not 0 <= horizon <= manifest.cost for horizon in manifest.horizons):
        raise ProofError("manifest.json", "a horizon must be between 0 and the cost")
    return Evidence(manifest.horizons, manifest.order)


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
    if words[-1:] != [b"0"] or not all(word.lstrip(b"-").isdigit() for word in words):
        raise ProofError("reach.model", "it must be whole numbers closed by 0")
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


def _replay(files: Mapping[str, bytes]) -> None:
    """Replay the DRAT proof by a checker that is not ours and not the solver's."""
    from dratify import check_proof, parse_dimacs  # noqa: PLC0415 - slow to load

    try:
        result = check_proof(parse_dimacs(files["beat.cnf"].decode()), files["beat.drat"].decode())
    except (ValueError, UnicodeDecodeError) as error:
        raise ProofError("beat.drat", f"it must be a DRAT proof: {error}") from error
    if not result.ok:
        raise ProofError("beat.drat", f"it does not prove that beat.cnf has no model: {result}")


def _ask_z3(formula: Path) -> str:
    import z3  # noqa: PLC0415 - slow to load

    solver = z3.Solver()
    solver.set("timeout", LONGEST_Z3_MS)
    solver.from_file(str(formula))
    return str(solver.check())
