"""The kernel makes the formula of a total itself, as the encoder in Python does, and each clause has a reason."""

import json
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from tests.spec.making import line
from tests.verify.bound.examples import cut_of, priced
from tests.verify.kernel.program import Json, check_bound, program, run, served
from tests.verify.optimum.models import has_model
from tests.verify.optimum.test_proof import change_manifest, crossing, drop_last_line, prove
from tests.verify.optimum.test_unsolvable import BORN_TOGETHER
from tests.verify.optimum.tiny import case

from carp_optimum.deadline import Deadline
from carp_optimum.optimum import optimum
from carp_optimum.sat.proving import refutation, write_proof
from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot
from carp_spec.documents.bounds import BoundDocument, DeadlinesDocument
from carp_spec.documents.instances import read_instance, write_instance
from carp_spec.permutations import shuffle
from carp_verify.bound.cuts import formula_of_deadlines, group_of
from carp_verify.bound.rules import LARGEST_FORMULA
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.clauses import Clause, dimacs
from carp_verify.optimum.encoding import Encoding, Evidence, beat_formula
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.proof import PROOF_FORMAT
from carp_verify.optimum.refutation import read_steps
from carp_verify.optimum.unsolvable import Clauses

_kernel = pytest.fixture(scope="module")(served)

SECONDS = 60
CASES = 400
BLOCK = 100


def verdict(folder: Path) -> Json:
    """The kernel's answer about a proof directory."""
    return run("verify-proof", folder)[1]


def kernel_formula(folder: Path) -> str:
    """The formula that the kernel makes of a proof directory's claim."""
    return subprocess.run([program(), "formula", folder], capture_output=True, text=True, check=True).stdout


def claim(folder: Path, instance: Instance, cost: int | None, evidence: Evidence, lrat: str = "") -> None:
    """Write what the kernel reads of a proof directory."""
    claimed: Mapping[str, object] = {"claim": "optimum", "cost": cost, "order": evidence.order}
    if cost is None:
        claimed = {"claim": "unsolvable", "obstacle": {"kind": "clauses", "horizons": evidence.horizons}}
    else:
        claimed = {**claimed, "horizons": evidence.horizons}
    (folder / "instance.json").write_bytes(write_instance(instance))
    (folder / "manifest.json").write_text(json.dumps({"format": PROOF_FORMAT, "sha256": {}, **claimed}))
    (folder / "beat.lrat").write_text(lrat)


def faults(folder: Path, number: int) -> Sequence[str]:
    """The faults of the kernel's formulas of one tiny instance, in words; Python's are those of test_tiny_optima.py."""
    instance, draw = case(number)
    chance = draw.stream
    encoding = Encoding(instance)
    if encoding.wayless:
        return []
    found = []
    robots = range(len(instance.robots))
    least = least_total_cost(instance)
    bound = (encoding.shortest if least is None else least) + next(chance) % 3
    reach = bound - encoding.shortest
    drawn_horizons = tuple(next(chance) % 6 for _ in robots)
    far_horizons = tuple(reach for _ in robots)
    for cost, horizons in ((bound, drawn_horizons), (None, drawn_horizons), (bound, far_horizons)):
        evidence = Evidence(horizons, shuffle(robots, chance) if cost is not None else ())
        claim(folder, instance, cost, evidence)
        if kernel_formula(folder) != dimacs(beat_formula(instance, cost, evidence).formula):
            found.append(f"the formulas of {cost} with {evidence} differ")
        if verdict(folder)["verdict"] != "refused":
            found.append(f"a clause of {cost} with {evidence} has no reason, or nothing refutes it")
    return found


@pytest.mark.parametrize("first", range(0, CASES, BLOCK))
def test_formulas_are_those_of_the_encoder(tmp_path: Path, first: int) -> None:
    found = {number: faults(tmp_path, number) for number in range(first, first + BLOCK)}
    assert {number: reported for number, reported in found.items() if reported} == {}


CORNERS: Mapping[str, Instance] = {
    "vanish": crossing("vanish"),
    "park": crossing("park"),
    "releases and paces": replace(
        crossing(),
        robots=tuple(replace(robot, release=k, pace=1 + k % 2) for k, robot in enumerate(crossing().robots)),
    ),
    "capacity 2 and durations": Instance(
        ResourceGraph((Resource(0, 1, 3), Resource(1, 2, 2), Resource(2), Resource(3)), ((0, 1), (1, 2), (1, 3))),
        (Robot("a", 2, 0), Robot("b", 3, 2), Robot("c", 0, 3), Robot("d", 1, 1)),
    ),
    "a full resource": Instance(
        ResourceGraph((Resource(0, 3), Resource(1, 2, 4), Resource(2, 3)), ((0, 1), (1, 2))),
        tuple(Robot(number, 0, 2) for number in range(3)),
    ),
}


def idle_hints(clauses: Sequence[Clause], text: str) -> list[tuple[int, int]]:
    """The steps with hints that make no new literal true, which other checkers of LRAT refuse."""
    known = dict(enumerate(clauses, start=1))
    idle = []
    for step in read_steps(text):
        true = {-literal for literal in step.clause or ()}
        for hint in step.hints if step.clause is not None else ():
            open_literals = [literal for literal in known[hint] if -literal not in true]
            idle += [(step.number, hint) for literal in open_literals if literal in true]
            true.update(open_literals)
        known[step.number] = step.clause or ()
    return idle


@pytest.mark.parametrize("name", CORNERS)
def test_a_proof_directory_is_accepted_and_every_hint_makes_a_literal_true(name: str, tmp_path: Path) -> None:
    cost = prove(CORNERS[name], tmp_path)
    assert verdict(tmp_path) == {"kernel": "1", "verdict": "accepted", "bound": cost}
    lines = (tmp_path / "beat.cnf").read_text().splitlines()[1:]
    clauses = [tuple(map(int, line.split()[:-1])) for line in lines]
    assert idle_hints(clauses, (tmp_path / "beat.lrat").read_text()) == []


def test_that_no_plans_exist_is_accepted(tmp_path: Path) -> None:
    best = optimum(BORN_TOGETHER, SECONDS)
    assert best.obstacle == Clauses((0, 0))
    write_proof(BORN_TOGETHER, best, tmp_path, SECONDS)
    assert verdict(tmp_path) == {"kernel": "1", "verdict": "accepted", "bound": None}
    (tmp_path / "beat.lrat").write_text("")
    assert verdict(tmp_path)["verdict"] == "refused"


def raise_cost(folder: Path) -> None:
    """Claim a tick more than the least."""
    manifest = json.loads((folder / "manifest.json").read_text())
    change_manifest(folder, cost=manifest["cost"] + 1)


def free_the_crossing(folder: Path) -> None:
    """Put the proof beside an instance on which fewer robots meet."""
    instance = read_instance((folder / "instance.json").read_bytes())
    robots = tuple(replace(robot, start="2,2") if robot.id == 0 else robot for robot in instance.robots)
    (folder / "instance.json").write_bytes(write_instance(replace(instance, robots=robots)))


def cut_refutation(folder: Path) -> None:
    text = (folder / "beat.lrat").read_text()
    (folder / "beat.lrat").write_text(drop_last_line(text))


def shorten_horizons(folder: Path) -> None:
    change_manifest(folder, horizons=[0] * 4)


@pytest.mark.parametrize("tamper", [raise_cost, free_the_crossing, cut_refutation, shorten_horizons])
def test_a_proof_of_something_else_is_refused(tamper: Callable[[Path], None], tmp_path: Path) -> None:
    prove(crossing(), tmp_path)
    tamper(tmp_path)
    answer = verdict(tmp_path)
    assert (answer["verdict"], answer["rule"]) == ("refused", "refutation")


def test_the_formula_on_file_does_not_matter(tmp_path: Path) -> None:
    prove(crossing(), tmp_path)
    (tmp_path / "beat.cnf").write_text("p cnf 1 1\n0\n")
    assert verdict(tmp_path)["verdict"] == "accepted"
    (tmp_path / "beat.lrat").write_text("2 0 1 0\n")
    assert verdict(tmp_path)["verdict"] == "refused"


def test_no_total_is_proved_of_a_robot_without_a_way(tmp_path: Path) -> None:
    claim(tmp_path, Instance(line("ab", directed=True), (Robot("a", "b", "a"),)), 3, Evidence((0,), (0,)), "2 0 1 0\n")
    answer = verdict(tmp_path)
    assert (answer["verdict"], answer["rule"]) == ("refused", "proof/way")
    assert answer["message"] == "no way leads to the goal of robot a"


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"horizons": [1, 1, 1]}, "$.horizons"),
        ({"horizons": [1, 1, 1, -1]}, "$.horizons[3]"),
        ({"horizons": [1, 1, 1, True]}, "$.horizons[3]"),
        ({"order": [0, 1, 2, 2]}, "$.order"),
        ({"order": [0, 1, 2, 3, 4]}, "$.order"),
        ({"cost": -1}, "$.cost"),
        ({"cost": "13"}, "$.cost"),
        ({"claim": "cheap"}, "$.claim"),
        ({"format": "carproof-proof/1"}, "$.format"),
        ({"more": 1}, "$"),
        ({"sha256": 1}, "$.sha256"),
    ],
)
def test_a_manifest_that_makes_no_formula_is_bad_input(change: Mapping[str, object], path: str, tmp_path: Path) -> None:
    claim(tmp_path, crossing(), 13, Evidence((2, 2, 2, 2), (0, 1, 2, 3)))
    change_manifest(tmp_path, **change)
    answer = verdict(tmp_path)
    assert (answer["verdict"], answer["path"]) == ("bad input", path)


def test_an_obstacle_without_a_formula_is_bad_input(tmp_path: Path) -> None:
    instance = crossing()
    claim(tmp_path, instance, 13, Evidence((2, 2, 2, 2), (0, 1, 2, 3)))
    obstacle = {"claim": "unsolvable", "obstacle": {"kind": "no-way", "robot": 0}, "sha256": {}, "format": PROOF_FORMAT}
    (tmp_path / "manifest.json").write_text(json.dumps(obstacle))
    answer = verdict(tmp_path)
    assert (answer["verdict"], answer["path"], answer["rule"]) == ("bad input", "$.obstacle.kind", "limit/obstacle")


@pytest.mark.parametrize("after_goal", ["vanish", "park"])
def test_a_large_duration_or_capacity_is_no_obstacle(after_goal: AfterGoal, tmp_path: Path) -> None:
    graph = ResourceGraph((Resource(0, 10**30), Resource(1, 1, 10**15), Resource(2, 10**30)), ((0, 1), (1, 2)))
    instance = Instance(graph, (Robot("a", 0, 2), Robot("b", 0, 2, release=10**15 - 1)), after_goal)
    least, evidence = 2 * (10**15 + 1) + 1, Evidence((1, 1), (0, 1))
    lrat = refutation(beat_formula(instance, least, evidence).formula, Deadline(SECONDS))
    claim(tmp_path, instance, least, evidence, lrat)
    assert verdict(tmp_path) == {"kernel": "1", "verdict": "accepted", "bound": least}


@pytest.mark.usefixtures("_kernel")
@pytest.mark.parametrize("first", range(0, 120, 40))
def test_cuts_of_some_robots_in_any_order_are_accepted(first: int) -> None:
    accepted = 0
    for number in range(first, first + 40):
        instance, draw = case(number)
        chosen = shuffle(list(instance.robot), draw.stream)[: draw.between(2, 3)]
        least = None if Encoding(instance).wayless else least_total_cost(group_of(instance, chosen))
        if least is not None:
            shortest = {each.robot.id: each.shortest or 0 for each in Encoding(instance).robots}
            claims = tuple((id, 0 if id in chosen else cost) for id, cost in shortest.items())
            bound = least + sum(cost for _, cost in claims)
            cut = cut_of(instance, chosen, least)
            document = priced(instance, bound=bound, scale=1, horizon=0, cuts=(cut,), robots=claims)
            assert verify_bound(instance, document) == bound
            assert check_bound(instance, document) == {"kernel": "1", "verdict": "accepted", "bound": bound}
            accepted += 1
    assert accepted > 10


def late_bound(instance: Instance, deadlines: DeadlinesDocument) -> BoundDocument:
    """The bound that one robot more than each on its own is late, by deadlines whose price is a tick."""
    shortest = {each.robot.id: each.shortest or 0 for each in Encoding(instance).robots}
    claims = tuple((id, cost + (id in deadlines.robots)) for id, cost in shortest.items())
    bound = 1 + sum(shortest.values())
    return priced(instance, bound=bound, scale=1, horizon=0, robots=claims, deadlines=(deadlines,))


@pytest.mark.usefixtures("_kernel")
@pytest.mark.parametrize("first", range(0, 120, 40))
def test_deadlines_of_some_robots_in_any_order_are_accepted_if_refuted(first: int) -> None:
    decided = {"accepted": 0, "refused": 0}
    for number in range(first, first + 40):
        instance, draw = case(number)
        chosen = tuple(shuffle(list(instance.robot), draw.stream)[: draw.between(2, 3)])
        encoding = Encoding(group_of(instance, chosen))
        late = draw.between(0, 2)
        if not Encoding(instance).wayless:
            refuted = "2 0 1 0\n"  # the first clause is empty: of no formula here
            for ticks in (
                tuple(robot.earliest for robot in encoding.robots),
                tuple(robot.earliest + draw.between(0, late) for robot in encoding.robots),
            ):
                unproved = DeadlinesDocument(chosen, ticks, 1, refuted)
                formula = formula_of_deadlines(instance, unproved, LARGEST_FORMULA)
                is_kept = has_model(formula)
                if not is_kept:
                    refuted = refutation(formula, Deadline(SECONDS))
                document = late_bound(instance, msgspec.structs.replace(unproved, refutation=refuted))
                answer = check_bound(instance, document)
                assert answer["verdict"] == ("refused" if is_kept else "accepted")
                decided[answer["verdict"]] += 1
                if is_kept:
                    assert answer["rule"] == "bound/deadline"
                else:
                    assert verify_bound(instance, document) == answer["bound"] == document.bound
    assert min(decided.values()) > 5, decided
