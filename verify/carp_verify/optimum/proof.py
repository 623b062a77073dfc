"""A proof directory, for others to check: that the optimum of an instance is K, or that no plan set exists.

Of an optimum:

- `manifest.json`: the cost K, each robot's horizon and the order of adding delays (with the instance, these are all
  that the encoder needs; any values are sound), and the SHA-256 digest of every other file
- `instance.json`: the instance
- `reach.cnf`: the encoding's clauses for a total of at most K, no robot later than its horizon
- `reach.model`: a model of them, as the literals that hold, closed by 0
- `variables.json`: the node or the delay of a robot that each variable stands for, to read the plans in the model
- `beat.cnf`: the encoding's clauses for a total of at most K - 1, robots later than their horizons left free
- `beat.lrat`: a refutation of them with hints, LRAT without RAT steps

Where no plan set exists, the manifest names the obstacle (`carp_verify.optimum.unsolvable`), and the directory has the
instance. If the obstacle is the clauses, it also has `beat.cnf`, for any total, and `beat.lrat`.

`verify_proof` trusts none of them. It makes both formulas again from the instance and compares, evaluates the model,
lets carp_spec judge the plans, checks the refutation (`carp_verify.optimum.refutation`), and asks z3 about both
formulas too. It accepts formulas of at most `LARGEST_PROOF` clauses each, none larger than its file, and plain files
of at most `LARGEST_FILE` bytes.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from reprlib import repr as shown
from typing import Final, Literal

import msgspec

from carp_spec import Instance, Plan, Refusal, Solution, judge
from carp_spec.documents.decoding import decode, has_format
from carp_spec.documents.instances import read_instance, write_instance
from carp_spec.model import ResourceId, RobotId
from carp_spec.shapes import SHAPE
from carp_verify.optimum.clauses import dimacs
from carp_verify.optimum.encoding import Encoding, Evidence, beat_formula, reach_formula
from carp_verify.optimum.refutation import NotRefutedError, require_refutation
from carp_verify.optimum.rules import LARGEST_PROOF, LARGEST_TABLE
from carp_verify.optimum.unsolvable import Clauses, Obstacle, describe, why_no_obstacle
from carp_verify.plain_files import PlainFileError, read_plain_file

PROOF_FORMAT: Final = "carproof-proof/2"
OLD_FORMAT = "carproof-proof/1"
FILES = ("instance.json", "reach.cnf", "reach.model", "variables.json", "beat.cnf", "beat.lrat")
FILES_OF_CLAUSES = ("instance.json", "beat.cnf", "beat.lrat")
FILES_OF_OBSTACLE = ("instance.json",)
LONGEST_Z3_MS = 60_000
LARGEST_FILE = 1 << 28
_LITERAL = re.compile(b"-?[1-9][0-9]{0,17}")


class ProofError(Exception):
    """A proof directory that does not prove its claim: the file, and the reason."""

    def __init__(self, file: str, reason: str) -> None:
        super().__init__(file, reason)
        self.file = file
        self.reason = reason

    def __str__(self) -> str:
        """One sentence."""
        return f"{self.file}: {self.reason}"


class Manifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The claim of a proof directory of an optimum, and the data from which its formulas were made."""

    format: Literal["carproof-proof/2"]
    claim: Literal["optimum"]
    cost: int
    horizons: tuple[int, ...]
    order: tuple[int, ...]
    sha256: Mapping[str, str]


class UnsolvableManifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The claim of a proof directory that no plan set exists, with the obstacle."""

    format: Literal["carproof-proof/2"]
    claim: Literal["unsolvable"]
    obstacle: Obstacle
    sha256: Mapping[str, str]


class _Claim(msgspec.Struct, frozen=True):
    claim: Literal["optimum", "unsolvable"]


class RobotVariables(msgspec.Struct, frozen=True):
    """The variables of a robot: `late[k]` holds if its delay exceeds k; a node is a resource, a tick and a variable."""

    robot: RobotId
    late: tuple[int, ...]
    nodes: tuple[tuple[ResourceId, int, int], ...]


@dataclass(frozen=True, slots=True)
class Verified:
    """The proved claim: the least cost and a solution that has it, or why no plan set exists.

    The other fields are `None`, and so is z3's answer about a formula that is missing. z3 answers `unknown` about a
    formula that takes it too long.
    """

    cost: int | None
    solution: Solution | None
    obstacle: str | None
    z3_reach: str | None
    z3_beat: str | None

    @property
    def is_decided(self) -> bool:
        """Whether z3 has answered; if not, the claim rests on the refutation alone."""
        return "unknown" not in (self.z3_reach, self.z3_beat)


def variables(encoding: Encoding) -> bytes:
    """The file `variables.json` of an encoding."""
    robots = [
        RobotVariables(
            robot.robot.id,
            tuple(robot.late),
            tuple((robot.routes.resource(place), tick, variable) for (place, tick), variable in robot.node.items()),
        )
        for robot in encoding.robots
    ]
    return msgspec.json.format(msgspec.json.encode(robots)) + b"\n"


@dataclass(frozen=True, slots=True)
class ProofFiles:
    """A manifest, and the contents of all files by their names, those beside it with the digests that it gives."""

    manifest: Manifest | UnsolvableManifest
    contents: Mapping[str, bytes]


def read_proof(directory: Path) -> ProofFiles:
    """The files of a proof directory; raises `ProofError` where one is missing or has another digest."""
    content = _read_file(directory, "manifest.json")
    manifest = _manifest(content)
    return ProofFiles(manifest, {**_read_files(directory, manifest), "manifest.json": content})


def verify_proof(proof: Path | ProofFiles, instance: Instance | None = None) -> Verified:
    """Check a proof directory, and that it is about the instance, if one is given.

    Raises `ProofError` where it does not prove its claim, and `Refusal` for a malformed instance or no path.
    """
    if not isinstance(proof, Path | ProofFiles):
        raise Refusal("document", "$", SHAPE, f"it must be the pathlib.Path of a proof directory, not {shown(proof)}")
    asked = None if instance is None else write_instance(instance)
    read = proof if isinstance(proof, ProofFiles) else read_proof(proof)
    proved = read_instance(read.contents["instance.json"])
    if asked not in (None, write_instance(proved)):
        raise ProofError("instance.json", "it is another instance than the one given")
    size = sum(len(robot.stops) for robot in proved.robots) * len(proved.graph.resources)
    is_made = not isinstance(read.manifest, UnsolvableManifest) or isinstance(read.manifest.obstacle, Clauses)
    if is_made and size > LARGEST_TABLE:
        reason = f"its pairs of a stop of a robot and a resource are {size}, and at most {LARGEST_TABLE} are allowed"
        raise ProofError("instance.json", reason)
    if isinstance(read.manifest, UnsolvableManifest):
        return _verify_obstacle(proved, read.manifest.obstacle, read.contents)
    return _verify_optimum(proved, read.manifest, read.contents)


def _verify_obstacle(instance: Instance, obstacle: Obstacle, files: Mapping[str, bytes]) -> Verified:
    reason = why_no_obstacle(instance, obstacle)
    if reason is not None:
        raise ProofError("manifest.json", f"the obstacle is not there: {reason}")
    answer = None
    if isinstance(obstacle, Clauses):
        _require_beaten(instance, None, Evidence(obstacle.horizons, ()), files)
        answer = _ask_z3("beat.cnf", files, "sat")
    return Verified(None, None, describe(instance, obstacle), None, answer)


def _verify_optimum(instance: Instance, manifest: Manifest, files: Mapping[str, bytes]) -> Verified:
    evidence = _evidence(instance, manifest)
    reach = _checked(lambda most: reach_formula(instance, manifest.cost, evidence, most), "reach.cnf", files)
    _compare("variables.json", variables(reach).decode(), files)
    solution = _solution(instance, reach, manifest.cost, files["reach.model"])
    _require_beaten(instance, manifest.cost, evidence, files)
    answers = _ask_z3("reach.cnf", files, "unsat"), _ask_z3("beat.cnf", files, "sat")
    return Verified(manifest.cost, solution, None, *answers)


def _manifest(content: bytes) -> Manifest | UnsolvableManifest:
    if has_format(content, OLD_FORMAT):
        reason = f"{OLD_FORMAT} has a refutation without hints, which is not accepted; write the proof again"
        raise ProofError("manifest.json", reason)
    try:
        if decode(content, _Claim, PROOF_FORMAT).claim == "unsolvable":
            return decode(content, UnsolvableManifest, PROOF_FORMAT)
        return decode(content, Manifest, PROOF_FORMAT)
    except Refusal as refusal:
        raise ProofError("manifest.json", f"it must be a manifest: {refusal}") from refusal


def _read_files(directory: Path, manifest: Manifest | UnsolvableManifest) -> Mapping[str, bytes]:
    """The files beside the manifest, each with the digest that the manifest gives."""
    names: tuple[str, ...] = FILES
    if isinstance(manifest, UnsolvableManifest):
        names = FILES_OF_CLAUSES if isinstance(manifest.obstacle, Clauses) else FILES_OF_OBSTACLE
    if sorted(manifest.sha256) != sorted(names):
        raise ProofError("manifest.json", f"it must have the digests of {', '.join(names)}")
    files = {name: _read_file(directory, name) for name in names}
    for name in names:
        if sha256(files[name]).hexdigest() != manifest.sha256[name]:
            raise ProofError(name, "its SHA-256 digest is not the one in the manifest")
    return files


def _read_file(directory: Path, name: str) -> bytes:
    try:
        return read_plain_file(directory, name, LARGEST_FILE)
    except PlainFileError as error:
        raise ProofError(name, str(error)) from error


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


def _checked(make: Callable[[int], Encoding], name: str, files: Mapping[str, bytes]) -> Encoding:
    """A formula made again from the instance, which the file must hold; one larger than the file is not made."""
    most = min(LARGEST_PROOF, files[name].count(b"\n"))
    try:
        encoding = make(most)
    except Refusal as refusal:
        reason = (
            f"for this instance and these horizons it must have more than {most} clauses, which it has not or may not"
        )
        raise ProofError(name, reason) from refusal
    _compare(name, dimacs(encoding.formula), files)
    return encoding


def _compare(name: str, right: str, files: Mapping[str, bytes]) -> None:
    """Compare a file with the formula that the encoder makes of the instance."""
    lines, found = right.splitlines(), files[name].decode(errors="replace").splitlines()
    for number, (line, other) in enumerate(zip(lines, found, strict=False), start=1):
        if line != other:
            raise ProofError(name, f"line {number} must be {line!r} for this instance, and is {other!r}")
    if right.encode() != files[name]:
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
    solution = solution_of(encoding.plans([variable in true for variable in range(formula.variables + 1)]))
    verdict = judge(instance, solution)
    if verdict.violations:
        raise ProofError("reach.model", f"its plans break a rule: {verdict.violations[0]}")
    if verdict.unplanned or verdict.cost != cost:
        raise ProofError("reach.model", f"its plans must cost {cost}, and cost {verdict.cost}")
    return solution


def solution_of(plans: Sequence[Plan]) -> Solution:
    """A solution of the plans, in their order."""
    return Solution(tuple(plans), tuple(plan.robot for plan in plans))


def _require_beaten(instance: Instance, cost: int | None, evidence: Evidence, files: Mapping[str, bytes]) -> None:
    """Raise `ProofError` unless the files refute the formula of plans below the cost, or of any plans."""
    beat = _checked(lambda most: beat_formula(instance, cost, evidence, most), "beat.cnf", files)
    try:
        require_refutation(beat.formula.clauses, files["beat.lrat"].decode())
    except (NotRefutedError, UnicodeDecodeError) as error:
        raise ProofError("beat.lrat", f"it does not show that beat.cnf has no model: {error}") from error


def _ask_z3(name: str, files: Mapping[str, bytes], wrong: str) -> str:
    """z3's answer about a formula; raises `ProofError` if it is the wrong one."""
    import z3  # noqa: PLC0415 - slow to load

    solver = z3.Solver()
    solver.set("timeout", LONGEST_Z3_MS)
    solver.from_string(files[name].decode())
    answer = str(solver.check())
    if answer == wrong:
        raise ProofError(name, f"z3 finds it {wrong}, against the evidence")
    return answer
