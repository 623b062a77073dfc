"""`optimum`, `verify-proof`, `gap` and the op `optimum`."""

import json
from pathlib import Path

import pytest
from tests.oracle.running import HEAD_ON, Document, Outcome, Run, corridor, save

from carp_verify.optimum.encoding import beat_formula, reach_formula

UNSOLVABLE = corridor([{"id": "r1", "start": "a", "goal": "e"}, HEAD_ON])


@pytest.fixture(autouse=True)
def _unsolvable(folder: Path) -> None:
    del folder
    save(lane=UNSOLVABLE)


def document_of(carproof: Run, command: str) -> Document:
    document: Document = json.loads(carproof(f"{command} --json").stdout)
    return document


def test_that_robots_cannot_all_be_planned_is_found_and_with_a_proof_proved(carproof: Run) -> None:
    obstacle = "a search over all states of the robots together finds no plan set"
    for option, answer in (("", ["found,", "not", "proved"]), ("--proof proof", ["proved"])):
        outcome = carproof(f"optimum lane.json {option}")
        row, reason = outcome.stdout.splitlines()[-2:]
        assert (outcome.code, row.split()[4:-2]) == (1, answer)
        assert reason == f"the robots cannot all be planned: {obstacle}"
    outcome = carproof("verify proof --instance lane.json")
    assert (outcome.code, outcome.stdout) == (0, f"proved: the robots cannot all be planned: {obstacle}\n")
    proved = {"proved": True, "claim": "unsolvable", "obstacle": obstacle}
    assert document_of(carproof, "verify proof") == dict.fromkeys(("cost", "solution", "reason", "by")) | proved
    none = {"cost": None, "lower": 28, "decided": True, "solution": None}
    assert document_of(carproof, "optimum lane.json") == none


def test_an_undecided_search_says_so_and_gives_its_bound(carproof: Run) -> None:
    assert carproof("generate grid --map 10 --robots 150 -o hard.json").code == 0
    outcome = carproof("optimum hard.json --limit 1 --json")
    document = json.loads(outcome.stdout)
    assert (outcome.code, document["decided"]) == (3, False)
    assert document["lower"] > 1000


@pytest.mark.parametrize("proof", ["town.json/proof", "nowhere"])
def test_a_folder_that_cannot_be_written_is_refused_before_the_search(carproof: Run, folder: Path, proof: str) -> None:
    (folder / "nowhere").symlink_to("gone")
    outcome = carproof(f"optimum town.json --proof {proof} -o best.json")
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith(f"Error: {proof}: it cannot be written: ")
    assert not (folder / "best.json").exists()


def test_an_optimum_whose_proof_is_too_large_is_written_and_found(
    carproof: Run, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for formula in (beat_formula, reach_formula):
        monkeypatch.setattr(formula, "__defaults__", (3,))
    outcome = carproof("optimum town.json --proof proof -o best.json")
    assert outcome.code == 3
    assert "found, not proved" in outcome.stdout
    assert (folder / "best.json").exists()


def test_a_proof_about_which_z3_does_not_answer_is_undecided(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    assert carproof("optimum town.json --proof proof").code == 0
    monkeypatch.setattr("carp_verify.optimum.proof._ask_z3", lambda *_: "unknown")
    outcome = carproof("verify proof")
    assert outcome.code == 3
    assert outcome.stdout.splitlines()[-1] == "undecided: z3 did not answer in time about one of the formulas"
    document = document_of(carproof, "verify proof")
    assert (document["proved"], document["cost"]) == (False, 5)


def test_a_proof_that_does_not_hold_is_refused_with_its_reason(carproof: Run, folder: Path) -> None:
    carproof("optimum town.json --proof proof")
    (folder / "proof" / "beat.cnf").unlink()
    reason = "beat.cnf: it cannot be read: No such file or directory"
    assert carproof("verify proof") == Outcome(1, f"not proved: {reason}\n", "")
    document = document_of(carproof, "verify proof")
    assert (document["proved"], document["reason"]) == (False, reason)


def test_a_gap_without_optimum_says_why(carproof: Run) -> None:
    outcome = carproof("gap lane.json")
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1].startswith("the robots cannot all be planned: ")


def test_the_gap_as_a_document(carproof: Run) -> None:
    document = document_of(carproof, "gap town.json")
    assert [document[name] for name in ("optimum", "lower", "decided", "best_order")] == [5, 5, True, 5]
    assert document["planners"][0] == {"planner": "carp", "unplanned": 0, "total": 5}
