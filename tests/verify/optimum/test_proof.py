import json
import re
from collections.abc import Callable
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from shutil import copytree

import pytest
from hypothesis import given, settings
from tests.profiles import draws
from tests.spec.making import grid
from tests.verify.bound.examples import UNSOUND_DRAT
from tests.verify.optimum.tiny import TINY

from carp_optimum.optimum import optimum
from carp_optimum.sat.proving import write_proof
from carp_spec import (
    AfterGoal,
    Instance,
    Refusal,
    Resource,
    ResourceGraph,
    Robot,
    Solution,
    Stop,
    Verdict,
    Violation,
    judge,
)
from carp_spec.documents.instances import write_instance
from carp_verify.bound.rules import ContradictionError
from carp_verify.optimum.proof import FILES, ProofError, verify_proof
from carproof.testing.strategies import instances

SECONDS = 60


def crossing(after_goal: AfterGoal = "vanish") -> Instance:
    """Four robots that cross a 3 x 3 grid and turn each other round: delays are needed."""
    ends = (("0,1", "2,1"), ("2,1", "0,1"), ("1,0", "1,2"), ("1,2", "1,0"))
    robots = tuple(Robot(number, *each) for number, each in enumerate(ends))
    return Instance(grid(3, 3), robots, after_goal)


def prove(instance: Instance, directory: Path) -> int:
    best = optimum(instance, SECONDS)
    assert best.cost is not None
    write_proof(instance, best, directory, SECONDS)
    return best.cost


@pytest.fixture(name="made", scope="module")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("proof")
    prove(crossing(), folder)
    return folder


@pytest.fixture(name="proof")
def copied_proof(made: Path, tmp_path: Path) -> Path:
    """The proof, to be tampered with."""
    return Path(copytree(made, tmp_path / "proof"))


def with_digests(directory: Path) -> None:
    """Make the manifest's digests right again, as somebody who tampers would."""
    change_manifest(directory, sha256={name: sha256((directory / name).read_bytes()).hexdigest() for name in FILES})


def change_manifest(directory: Path, **changes: object) -> None:
    path = directory / "manifest.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def flip(text: str) -> str:
    """Flip the first literal of the last clause."""
    *lines, last = text.splitlines()
    first, *rest = last.split()
    return "\n".join([*lines, " ".join([str(-int(first)), *rest])]) + "\n"


def drop_last_line(text: str) -> str:
    return "".join(text.splitlines(keepends=True)[:-1])


def drop_clause(text: str) -> str:
    """Drop the last clause and count it off."""
    head, *lines = drop_last_line(text).splitlines()
    *words, count = head.split()
    return "\n".join([" ".join([*words, str(int(count) - 1)]), *lines]) + "\n"


@pytest.mark.parametrize("after_goal", ["vanish", "park"])
def test_a_proof_directory_proves_its_cost(after_goal: AfterGoal, tmp_path: Path) -> None:
    instance = crossing(after_goal)
    cost = prove(instance, tmp_path)
    assert cost > 8
    verified = verify_proof(tmp_path, instance)
    assert verified.cost == cost
    assert (verified.z3_reach, verified.z3_beat) == ("sat", "unsat")
    assert verified.solution is not None
    assert judge(instance, verified.solution).cost == cost


@settings(max_examples=draws(150))
@given(instances(TINY, least_robots=1))
def test_every_optimum_can_be_proved(tmp_path_factory: pytest.TempPathFactory, instance: Instance) -> None:
    best = optimum(instance, SECONDS)
    if best.cost is not None:
        directory = tmp_path_factory.mktemp("proof")
        write_proof(instance, best, directory, SECONDS)
        assert verify_proof(directory, instance).cost == best.cost


@pytest.mark.parametrize("name", ["manifest.json", *FILES])
def test_a_missing_file_is_refused(proof: Path, name: str) -> None:
    (proof / name).unlink()
    with pytest.raises(ProofError, match=f"^{name}: it cannot be read: No such file"):
        verify_proof(proof)


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_was_changed_has_another_digest(proof: Path, name: str) -> None:
    (proof / name).write_bytes((proof / name).read_bytes() + b" ")
    with pytest.raises(ProofError, match=f"^{name}: its SHA-256 digest"):
        verify_proof(proof)


NUMBERS = "it must be whole numbers"


@pytest.mark.parametrize(
    ("name", "change", "reason"),
    [
        ("beat.cnf", flip, r"line \d+ must be"),
        ("reach.cnf", flip, r"line \d+ must be"),
        ("beat.cnf", drop_clause, "line 1 must be"),
        ("reach.cnf", drop_clause, "line 1 must be"),
        ("beat.cnf", lambda text: text + "1 0\n", "it must have"),
        ("beat.cnf", drop_last_line, "it must have"),
        ("beat.cnf", lambda text: text[:-1], "it must have"),
        ("reach.cnf", lambda text: text.replace("\n", "\r\n"), "it must have"),
        ("variables.json", lambda text: text.replace("0,1", "1,0", 1), "line"),
        ("reach.model", lambda text: text.replace(" 0\n", "\n"), NUMBERS),
        ("reach.model", lambda text: text.replace(" 0\n", " 7\n"), NUMBERS),
        ("reach.model", lambda text: text.replace(" 0\n", "x 0\n"), NUMBERS),
        ("reach.model", lambda text: text.replace("1 ", "x ", 1), NUMBERS),
        ("reach.model", lambda text: "-" + text, NUMBERS),
        ("reach.model", lambda text: "9" * 5000 + text, NUMBERS),
        ("reach.model", lambda text: "1 -1 " + text.split(" ", 1)[1], "it must give each"),
        ("reach.model", lambda text: text.split(" ", 1)[1], "it must give each"),
        ("reach.model", lambda text: text.replace("-", ""), "it breaks clause"),
        ("beat.lrat", lambda _: "", "it does not show"),
        ("beat.lrat", drop_last_line, "it does not show"),
        ("beat.lrat", lambda _: "hello\n", ".* line 1 must be a clause with its hints"),
        ("beat.lrat", lambda _: "0\n", ".* line 1 has no hints"),
        ("beat.lrat", lambda _: UNSOUND_DRAT, ".* line 1 has no hints"),
        ("manifest.json", lambda text: text.replace("{", '{"cost":1,', 1), ".* has the name 'cost' 2 times"),
        ("manifest.json", lambda text: text[1:], "it must be a manifest"),
    ],
)
def test_tampering_is_refused_though_the_digests_are_right(
    proof: Path, name: str, change: Callable[[str], str], reason: str
) -> None:
    before = (proof / name).read_text()
    assert change(before) != before
    (proof / name).write_text(change(before))
    if name != "manifest.json":
        with_digests(proof)
    with pytest.raises(ProofError, match=f"^{re.escape(name)}: {reason}"):
        verify_proof(proof)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"format": "carproof-proof/9"}, "manifest.json: .* the format must be carproof-proof/2"),
        ({"format": "carproof-proof/1"}, "manifest.json: carproof-proof/1 has a refutation without hints"),
        ({"cost": 10**99}, "manifest.json: the cost must be .* at most all horizons above it"),
        ({"cost": 10**9, "horizons": [10**9] * 4}, "reach.cnf: for this instance"),
        ({"cost": 7}, "manifest.json: the cost must be at least that of the shortest paths"),
        ({"cost": 40}, "manifest.json: the cost must be .* at most all horizons above it"),
        ({"horizons": [1] * 2}, "manifest.json: it must have a horizon of each of 4 robots"),
        ({"horizons": [1] * 5}, "manifest.json: it must have a horizon of each of 4 robots"),
        ({"horizons": [99, 1, 1, 1]}, "manifest.json: a horizon must be between 0 and the cost"),
        ({"horizons": [9, -1, 1, 1]}, "manifest.json: a horizon must be between 0 and the cost"),
        ({"horizons": [3] * 4}, "reach.cnf: for this instance"),
        ({"order": [0, 1, 2, 2]}, "manifest.json: it must have a horizon of each of 4 robots"),
        ({"order": [0, 1, 2, 3, 3]}, "manifest.json: it must have a horizon of each of 4 robots"),
    ],
)
def test_a_manifest_that_does_not_fit_is_refused(proof: Path, changes: dict[str, object], reason: str) -> None:
    change_manifest(proof, **changes)
    with pytest.raises(ProofError, match=f"^{reason}"):
        verify_proof(proof)


@pytest.mark.parametrize(("limit", "size"), [("LARGEST_FILE", None), ("LARGEST_TABLE", 4 * 9)])
def test_a_proof_is_read_and_searched_up_to_the_limits_alone(
    proof: Path, limit: str, size: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    most = size or max((proof / name).stat().st_size for name in FILES)
    monkeypatch.setattr(f"carp_verify.optimum.proof.{limit}", most)
    assert verify_proof(proof).cost == 13
    monkeypatch.setattr(f"carp_verify.optimum.proof.{limit}", most - 1)
    with pytest.raises(ProofError, match=f"it has more than {most - 1} bytes|and a resource are {most}"):
        verify_proof(proof)


def test_each_stop_of_a_robot_counts_in_the_size_of_a_proof(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first, *others = crossing().robots
    prove(replace(crossing(), robots=(replace(first, stops=(Stop(first.start), *first.stops)), *others)), tmp_path)
    monkeypatch.setattr("carp_verify.optimum.proof.LARGEST_TABLE", 5 * 9 - 1)
    with pytest.raises(ProofError, match="a stop of a robot and a resource are 45"):
        verify_proof(tmp_path)


@pytest.mark.parametrize(
    ("verdict", "reason"),
    [
        (Verdict(13, 0, (Violation("plan/move", (0,), "0,0", 1, 2, "r"),)), r"its plans break a rule: \[plan/move\]"),
        (Verdict(13, 1, ()), "its plans must cost 13, and cost 13"),
        (Verdict(12, 0, ()), "its plans must cost 13, and cost 12"),
        (Verdict(14, 0, ()), "its plans must cost 13, and cost 14"),
    ],
)
def test_plans_in_the_model_are_judged(
    proof: Path, verdict: Verdict, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the clauses allow: the plans here are right, and the verdict is not."""
    monkeypatch.setattr("carp_verify.optimum.proof.judge", lambda *_: verdict)
    with pytest.raises(ProofError, match=f"^reach.model: {reason}"):
        verify_proof(proof)


def ask_instead(monkeypatch: pytest.MonkeyPatch, answer: Callable[[str], str]) -> None:
    """Let this answer in place of z3, which has a minute."""

    class StandIn:
        def set(self, option: str, value: int) -> None:
            self.limits = {option: value}

        def from_string(self, formula: str) -> None:
            self.formula = formula

        def check(self) -> str:
            return answer(self.formula) if self.limits == {"timeout": 60_000} else "unknown"

    monkeypatch.setattr("z3.Solver", StandIn)


@pytest.mark.parametrize(("name", "answer"), [("reach.cnf", "unsat"), ("beat.cnf", "sat")])
def test_a_formula_about_which_z3_finds_the_opposite_is_refused(
    proof: Path, name: str, answer: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = (proof / name).read_text()
    ask_instead(monkeypatch, lambda formula: answer if formula == content else "unknown")
    with pytest.raises(ProofError, match=f"^{name}: z3 finds it {answer}, against the evidence"):
        verify_proof(proof)


def test_z3_is_asked_about_the_bytes_that_were_compared_whatever_the_files_hold_by_then(
    proof: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, compared = [], [(proof / name).read_text() for name in ("reach.cnf", "beat.cnf")]

    def note(formula: str) -> str:
        asked.append(formula)
        return "unknown"

    def judged(instance: Instance, solution: Solution) -> Verdict:
        for name in ("reach.cnf", "beat.cnf"):
            (proof / name).write_text("p cnf 0 0\n")
        return judge(instance, solution)

    monkeypatch.setattr("carp_verify.optimum.proof.judge", judged)
    ask_instead(monkeypatch, note)
    assert not verify_proof(proof).is_decided
    assert asked == compared


@pytest.mark.parametrize("names", [FILES[:-1], FILES[1:], (*FILES, "more.json"), ()])
def test_digests_of_other_files_are_refused(proof: Path, names: tuple[str, ...]) -> None:
    digests = json.loads((proof / "manifest.json").read_text())["sha256"]
    change_manifest(proof, sha256={name: digests.get(name, "") for name in names})
    with pytest.raises(ProofError, match=r"^manifest\.json: it must have the digests of instance\.json, "):
        verify_proof(proof)


def test_a_worse_total_is_not_proved_to_be_least(tmp_path: Path) -> None:
    best = optimum(crossing(), SECONDS)
    assert best.cost is not None
    worse = replace(best, cost=best.cost + 1)
    with pytest.raises(ContradictionError, match="no plans cost less, and the formula of such plans has a model"):
        write_proof(crossing(), worse, tmp_path, SECONDS)


def test_an_instance_without_optimum_has_no_proof_of_one(proof: Path, tmp_path: Path) -> None:
    apart = Instance(ResourceGraph((Resource(0), Resource(1)), ()), (Robot("a", 0, 1),))
    undecided = replace(optimum(apart, SECONDS), decided=False)
    with pytest.raises(Refusal, match="only for an answer that the search has found"):
        write_proof(apart, undecided, tmp_path, SECONDS)
    (proof / "instance.json").write_bytes(write_instance(apart))
    with_digests(proof)
    with pytest.raises(ProofError, match="a robot has no way to its goal"):
        verify_proof(proof)
