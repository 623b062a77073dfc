"""`optimum`, `verify-proof`, `gap` and the op `optimum`."""

import json
from math import inf
from pathlib import Path

import pytest
from tests.oracle.running import HEAD_ON, TWO, TWO_PLANNED, Document, Run, corridor

from carp_optimum.gap import Gap, PlannerGap
from carp_optimum.optimum import Optimum
from carp_spec import Carp
from carp_verify.encoding import Evidence
from carproof import optimum_table
from carproof.gap_family import Cell
from carproof.generate import Range

UNSOLVABLE = corridor([{"id": "r1", "start": "a", "goal": "e"}, HEAD_ON])


@pytest.fixture
def town(tmp_path: Path) -> Path:
    path = tmp_path / "town.json"
    path.write_text(json.dumps(TWO))
    return path


def written(path: Path, document: Document) -> Path:
    path.write_text(json.dumps(document))
    return path


def hard(carproof: Run, path: Path) -> Path:
    """An instance that nobody decides in a second."""
    assert carproof("generate", "grid", "--map", 10, "--robots", 150, "-o", path).code == 0
    return path


def test_the_optimum_is_shown_and_its_plans_are_written(carproof: Run, town: Path, tmp_path: Path) -> None:
    output = tmp_path / "best.json"
    outcome = carproof("optimum", town, "-o", output)
    assert (outcome.code, outcome.stderr) == (0, "")
    assert outcome.stdout.splitlines()[-1].split()[:7] == ["2", "5", "5", "5", "found,", "not", "proved"]
    assert json.loads(output.read_text()) == TWO_PLANNED
    assert carproof("check", town, output).code == 0


def test_the_optimum_as_a_document(carproof: Run, town: Path) -> None:
    outcome = carproof("optimum", town, "--json")
    assert json.loads(outcome.stdout) == {"cost": 5, "lower": 5, "proved": True, "solution": TWO_PLANNED}


def test_that_robots_cannot_all_be_planned_is_found_and_with_a_proof_proved(carproof: Run, tmp_path: Path) -> None:
    path, folder = written(tmp_path / "lane.json", UNSOLVABLE), tmp_path / "proof"
    obstacle = "a search over all states of the robots together finds no plan set"
    for options, answer in (((), ["found,", "not", "proved"]), (("--proof", folder), ["proved"])):
        outcome = carproof("optimum", path, *options)
        row, reason = outcome.stdout.splitlines()[-2:]
        assert (outcome.code, row.split()[4:-2]) == (1, answer)
        assert reason == f"the robots cannot all be planned: {obstacle}"
    outcome = carproof("verify-proof", folder, "--instance", path)
    assert (outcome.code, outcome.stdout) == (0, f"proved: the robots cannot all be planned: {obstacle}\n")
    document = json.loads(carproof("verify-proof", folder, "--json").stdout)
    assert document == dict.fromkeys(("cost", "solution", "reason")) | {
        "proved": True,
        "claim": "unsolvable",
        "obstacle": obstacle,
    }
    document = json.loads(carproof("optimum", path, "--json").stdout)
    assert document == {"cost": None, "lower": 28, "proved": True, "solution": None}


def test_an_undecided_search_says_so_and_gives_its_bound(carproof: Run, tmp_path: Path) -> None:
    outcome = carproof("optimum", hard(carproof, tmp_path / "hard.json"), "--limit", 1, "--json")
    document = json.loads(outcome.stdout)
    assert (outcome.code, document["proved"]) == (3, False)
    assert document["lower"] > 1000


def test_an_undecided_search_tells_its_bound_and_whether_it_has_plans(carproof: Run, tmp_path: Path) -> None:
    path = tmp_path / "crowd.json"
    for robots, size, map, known in (
        (48, 8, 20, "no plans of all robots found yet"),
        (18, 6, 0, "and the best found "),
    ):
        options = ["--width", size, "--height", size, "--robots", robots, "--map", map, "--seed", 2]
        options += ["--after-goal", "park"] if size == 8 else []
        assert carproof("generate", "grid", *options, "-o", path).code == 0
        outcome = carproof("optimum", path, "--limit", 2)
        assert outcome.code == 3
        last = outcome.stdout.splitlines()[-1]
        assert last.startswith("undecided after 2 s: plans of all robots cost at least ")
        assert known in last


def test_a_proof_is_written_and_checked(carproof: Run, town: Path, tmp_path: Path) -> None:
    folder = tmp_path / "proof"
    outcome = carproof("optimum", town, "--proof", folder)
    assert (outcome.code, outcome.stdout.splitlines()[-1].split()[3:5]) == (0, ["5", "proved"])
    document = json.loads(carproof("optimum", town, "--proof", folder, "--json").stdout)
    assert (document["proved"], document["checked"]) == (True, True)
    outcome = carproof("verify-proof", folder, "--instance", town)
    assert (outcome.code, outcome.stderr) == (0, "")
    assert outcome.stdout.splitlines()[-1].split() == ["5", "2", "checked", "sat", "unsat"]
    document = json.loads(carproof("verify-proof", folder, "--json").stdout)
    proved = {"proved": True, "claim": "optimum", "cost": 5, "solution": TWO_PLANNED}
    assert document == proved | {"obstacle": None, "reason": None}


def test_a_proof_about_which_z3_does_not_answer_is_undecided(
    carproof: Run, town: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert carproof("optimum", town, "--proof", tmp_path / "proof").code == 0
    monkeypatch.setattr("carp_verify.proof._ask_z3", lambda *_: "unknown")
    outcome = carproof("verify-proof", tmp_path / "proof")
    assert outcome.code == 3
    assert outcome.stdout.splitlines()[-1] == "undecided: z3 did not answer in time about one of the formulas"
    document = json.loads(carproof("verify-proof", tmp_path / "proof", "--json").stdout)
    assert (document["proved"], document["cost"]) == (False, 5)


def test_a_proof_that_does_not_hold_is_refused_with_its_reason(carproof: Run, town: Path, tmp_path: Path) -> None:
    folder = tmp_path / "proof"
    carproof("optimum", town, "--proof", folder)
    (folder / "beat.cnf").unlink()
    outcome = carproof("verify-proof", folder)
    assert outcome.code == 1
    assert outcome.stdout == "not proved: beat.cnf: it cannot be read: No such file or directory\n"
    document = json.loads(carproof("verify-proof", folder, "--json").stdout)
    assert (document["proved"], document["reason"]) == (False, outcome.stdout[len("not proved: ") : -1])


def test_the_gap_of_every_planner_is_shown(carproof: Run, town: Path) -> None:
    outcome = carproof("gap", town)
    assert (outcome.code, outcome.stderr) == (0, "")
    rows = [row.split() for row in outcome.stdout.splitlines()[2:]]
    assert rows[0][:3] == ["optimum", "0", "5"]
    assert [row[0] for row in rows[1:]] == [
        "best",
        "carp",
        "shuffled",
        "longest-first",
        "greedy",
        "fixed-paths",
        "neighbourhood",
    ]
    assert rows[2] == ["carp", "0", "5", *["+0", "(0.0", "%)"] * 3]


def test_the_gap_as_a_document(carproof: Run, town: Path) -> None:
    document = json.loads(carproof("gap", town, "--json").stdout)
    assert {name: document[name] for name in ("optimum", "lower", "proved", "best_order")} == {
        "optimum": 5,
        "lower": 5,
        "proved": True,
        "best_order": 5,
    }
    assert document["planners"][0] == {"planner": "carp", "unplanned": 0, "total": 5}


def test_a_gap_without_optimum_says_why(carproof: Run, tmp_path: Path) -> None:
    outcome = carproof("gap", written(tmp_path / "lane.json", UNSOLVABLE))
    assert outcome.code == 1
    assert outcome.stdout.splitlines()[-1].startswith("the robots cannot all be planned: ")


def test_the_gaps_of_a_family_are_shown_with_intervals(carproof: Run) -> None:
    outcome = carproof("gap", "--size", "3..4", "--map", 0, "--map", 20, "--count", 4)
    assert outcome.stderr == ""
    lines = outcome.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    rows = [row.split() for row in lines[2:-1]]
    assert [row[:5] for row in rows if row[1] == "x"] == [
        [size, "x", size, map, size] for size in ("3", "4") for map in ("0", "20")
    ]
    assert [row[0] for row in rows[1:8]] == [
        "best",
        "carp",
        "shuffled",
        "longest-first",
        "greedy",
        "fixed-paths",
        "neighbourhood",
    ]
    assert "±" in lines[4]


def test_the_gaps_of_a_family_as_a_document_are_those_of_its_instances(carproof: Run, tmp_path: Path) -> None:
    options = ["--robots", 4, "--after-goal", "park"]
    family = carproof("gap", "--size", 3, "--map", 10, *options, "--count", 2, "--seed", 5, "--json")
    (cell,) = json.loads(family.stdout)["cells"]
    assert (cell["size"], cell["map"], cell["robots"]) == (3, 10, 4)
    of_instances = []
    for seed in (5, 6):
        path = tmp_path / f"{seed}.json"
        grid = ["--width", 3, "--height", 3, "--map", 10, "--map-seed", seed, "--seed", seed]
        carproof("generate", "grid", *grid, *options, "-o", path)
        of_instances.append({"seed": seed, "gap": json.loads(carproof("gap", path, "--json").stdout)})
    assert cell["instances"] == of_instances
    optima = [each["gap"]["optimum"] for each in of_instances]
    assert cell["decided"] == len(optima) - optima.count(None)
    assert family.code == (1 if None in optima else 0)


def small_gap(optimum: int | None, best_order: int | None, *totals: int | None) -> Gap:
    """A gap with as many planners as totals; `None` is a planner that left a robot unplanned."""
    best = Optimum(8, optimum, optimum or 9, optimum is not None, None, Evidence((), ()))
    planners = (PlannerGap(Carp(), total or 0, int(total is None)) for total in totals)
    return Gap(best, best_order, tuple(planners))


def test_means_of_a_family_leave_out_what_is_not_known() -> None:
    gaps = (small_gap(10, 11, 12), small_gap(10, None, 11), small_gap(10, 10, None), small_gap(None, 9, 9))
    cell = Cell(3, 0, 2, range(4), gaps)
    assert (cell.delay.instances, str(cell.delay)) == (3, "25.0 ± 0.0")
    assert (cell.price_of_an_order.instances, str(cell.price_of_an_order)) == (2, "5.0 ± 9.8")
    assert (cell.above_optimum(0).instances, str(cell.above_optimum(0))) == (2, "15.0 ± 9.8")
    assert (cell.price_of_the_search(0).instances, str(cell.price_of_the_search(0))) == (1, "10.0 ± 0.0")
    assert str(Cell(3, 0, 2, range(0), ()).delay) == "-"


def test_a_row_of_the_optimum_table_counts_what_is_undecided_as_over_the_limit() -> None:
    family = optimum_table.Family(3, 20, 2, "park", Range(1, 3))
    head = ("3 x 3, full grid, durations 1..3", "2", "park")
    assert optimum_table.row(family, [2, inf, 0.25]) == (*head, "2/3", "2.00", "over 30")
    assert optimum_table.row(family, [2, 0.25]) == (*head, "2/2", "1.12", "2.00")


def test_the_table_of_times_fits_the_page_that_holds_it() -> None:
    page = (Path(__file__).parents[2] / "docs" / "results" / "gaps.md").read_text()
    times = optimum_table.optimum_table([optimum_table.Family(3, 5, 2, "vanish", instances=2)])
    assert times.partition("| 3 x 3")[0] in page
    assert times.splitlines()[-1].startswith("| 3 x 3, map 5 | 2 | vanish | 2/2 | 0.")
