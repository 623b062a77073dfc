"""Proof directories of instances without plan sets: honest ones are accepted, forged ones are refused."""

import json
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import msgspec
import pytest
from tests.verify.forging import FAR, changed, changed_lines, verified_with
from tests.verify.optimum.tiny import case

from carp_optimum.optimum import optimum
from carp_optimum.sat.proving import write_proof
from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot
from carp_spec.documents.instances import write_instance
from carp_spec.model import Group, Stop
from carp_verify.optimum import joint_search, unsolvable
from carp_verify.optimum.clauses import dimacs
from carp_verify.optimum.encoding import Evidence, beat_formula
from carp_verify.optimum.joint_search import joint_states, least_total_cost
from carp_verify.optimum.proof import PROOF_FORMAT, ProofError, verify_proof
from carp_verify.optimum.unsolvable import Clauses, FullGoal, NoWay, Obstacle, States, why_no_obstacle

SECONDS = 60


def line(size: int, *robots: Robot, after_goal: AfterGoal = "vanish", directed: bool = False) -> Instance:
    edges = tuple((each, each + 1) for each in range(size - 1))
    return Instance(ResourceGraph(tuple(map(Resource, range(size))), edges, directed), robots, after_goal)


APART = line(3, Robot("a", 0, 2), Robot("b", 2, 0, release=5), directed=True)
FULL = line(3, Robot("a", 0, 1), Robot("b", 2, 1, release=2), after_goal="park")
BORN_TOGETHER = line(4, Robot("a", 0, 2), Robot("b", 0, 3))
HEAD_ON = line(6, Robot("a", 0, 5), Robot("b", 5, 0))
KINDS: dict[str, tuple[Instance, Obstacle]] = {
    "no-way": (APART, NoWay("b")),
    "full-goal": (FULL, FullGoal(1)),
    "clauses": (BORN_TOGETHER, Clauses((0, 0))),
    "states": (HEAD_ON, States()),
}
SOLVABLE = (
    line(3, Robot("a", 0, 2), Robot("b", 2, 0, release=5)),
    line(3, Robot("a", 0, 1), Robot("b", 2, 1, release=2)),
    line(4, Robot("a", 0, 2), Robot("b", 0, 3, release=1)),
    line(6, Robot("a", 0, 5), Robot("b", 5, 0, release=9)),
)


@pytest.fixture(name="kind", params=list(KINDS))
def every_kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(name="proof")
def written_proof(kind: str, tmp_path: Path) -> Path:
    instance, obstacle = KINDS[kind]
    best = optimum(instance, SECONDS)
    assert (best.decided, best.cost, best.obstacle) == (True, None, obstacle)
    write_proof(instance, best, tmp_path / "proof", SECONDS)
    return tmp_path / "proof"


def is_accepted(folder: Path, files: dict[str, bytes]) -> bool:
    return verified_with(folder, files) is not None


def test_an_honest_proof_is_accepted(kind: str, proof: Path) -> None:
    instance, _ = KINDS[kind]
    verified = verify_proof(proof, instance)
    assert (verified.cost, verified.solution, verified.z3_reach) == (None, None, None)
    assert verified.z3_beat == ("unsat" if kind == "clauses" else None)
    assert verified.is_decided
    assert verified.obstacle


def test_no_change_of_a_manifest_is_accepted(proof: Path) -> None:
    manifest = json.loads((proof / "manifest.json").read_text())
    variants = [each for each in changed(manifest) if isinstance(each, dict) and each != manifest]
    variants = [each for each in variants if has_other_claim(each, manifest)]
    assert len(variants) > 10
    assert [each for each in variants if is_accepted(proof, {"manifest.json": json.dumps(each).encode()})] == []


def has_other_claim(variant: dict[str, object], manifest: dict[str, object]) -> bool:
    """The digests are put right, so that a change of them alone is no forgery."""
    return {**variant, "sha256": None} != {**manifest, "sha256": None}


def test_another_instance_has_not_the_obstacle(proof: Path) -> None:
    for instance in SOLVABLE:
        assert least_total_cost(instance) is not None
        assert not is_accepted(proof, {"instance.json": write_instance(instance)})
    other = SOLVABLE[0]
    with pytest.raises(ProofError, match=r"^instance\.json: it is another instance than the one given"):
        verify_proof(proof, other)


def test_a_proof_of_an_optimum_is_not_read_as_one_of_an_obstacle(tmp_path: Path) -> None:
    write_proof(SOLVABLE[0], optimum(SOLVABLE[0], SECONDS), tmp_path, SECONDS)
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    for obstacle in every_obstacle(SOLVABLE[0]):
        for claim in ("optimum", "unsolvable"):
            forged = {**manifest, "claim": claim, "obstacle": msgspec.to_builtins(obstacle)}
            assert not is_accepted(tmp_path, {"manifest.json": json.dumps(forged).encode()})


def every_obstacle(instance: Instance) -> Iterator[Obstacle]:
    yield from (NoWay(robot.id) for robot in instance.robots)
    yield from (NoWay(stranger) for stranger in ("nobody", 0))
    yield from (FullGoal(resource.id) for resource in instance.graph.resources)
    yield FullGoal("nowhere")
    yield from (Clauses((horizon,) * len(instance.robots)) for horizon in range(4))
    yield from (Clauses(horizons) for horizons in ((), (0,), (-1, 0), (0, 0, 0)))
    yield States()


@pytest.mark.parametrize("instance", SOLVABLE, ids=KINDS)
def test_no_obstacle_is_accepted_where_there_are_plans(instance: Instance, tmp_path: Path) -> None:
    """The forger makes the clauses as the checker does, and takes the honest refutation of another instance."""
    write_proof(BORN_TOGETHER, optimum(BORN_TOGETHER, SECONDS), tmp_path, SECONDS)
    refutation = (tmp_path / "beat.lrat").read_text()
    count = 0
    for obstacle in every_obstacle(instance):
        files = {"instance.json": write_instance(instance)}
        if isinstance(obstacle, Clauses):
            files["beat.cnf"] = formula_of(instance, obstacle.horizons)
            files["beat.lrat"] = refutation.encode()
        manifest = {
            "format": PROOF_FORMAT,
            "claim": "unsolvable",
            "obstacle": msgspec.to_builtins(obstacle),
            "sha256": dict.fromkeys(files, ""),
        }
        files["manifest.json"] = json.dumps(manifest).encode()
        assert not is_accepted(tmp_path, files)
        count += 1
    assert count > 10


def formula_of(instance: Instance, horizons: Sequence[int]) -> bytes:
    if len(horizons) != len(instance.robots):
        return b"p cnf 0 0\n"
    return dimacs(beat_formula(instance, None, Evidence(tuple(horizons), ())).formula).encode()


@pytest.mark.parametrize("kind", ["clauses"], indirect=True)
def test_no_change_of_a_refutation_refutes_clauses_that_hold(proof: Path) -> None:
    instance = SOLVABLE[2]
    files = {"instance.json": write_instance(instance), "beat.cnf": formula_of(instance, (0, 0))}
    text = (proof / "beat.lrat").read_text()
    variants = [text, *islice(changed_lines(text), 300)]
    assert [each for each in variants if is_accepted(proof, {**files, "beat.lrat": each.encode()})] == []


@pytest.mark.parametrize("kind", ["clauses"], indirect=True)
def test_clauses_with_one_changed_or_dropped_are_refused(proof: Path) -> None:
    head, *lines = (proof / "beat.cnf").read_text().splitlines(keepends=True)
    for position in range(0, len(lines), 5):
        dropped = [head, *lines[:position], *lines[position + 1 :]]
        turned = [head, *lines[:position], f"-{lines[position]}".removeprefix("--"), *lines[position + 1 :]]
        for variant in (dropped, turned):
            assert not is_accepted(proof, {"beat.cnf": "".join(variant).encode()})


def test_every_obstacle_that_the_search_finds_can_be_proved(tmp_path: Path) -> None:
    found: list[type[Obstacle]] = []
    for number in range(120):
        instance, _ = case(number)
        best = optimum(instance, SECONDS)
        if best.obstacle is not None:
            write_proof(instance, best, tmp_path / str(number), SECONDS)
            assert verify_proof(tmp_path / str(number), instance).obstacle
            found.append(type(best.obstacle))
    assert set(found) == {NoWay, FullGoal, Clauses, States}


@pytest.mark.parametrize(
    ("instance", "obstacle"),
    [
        (line(2, Robot("a", 1, 1), directed=True), NoWay("a")),
        (line(2, Robot("a", 0, 1), after_goal="park"), FullGoal(1)),
        (APART, Clauses((0, 0))),  # a robot has no way, and so no clauses
    ],
)
def test_these_are_no_obstacles(instance: Instance, obstacle: Obstacle) -> None:
    assert why_no_obstacle(instance, obstacle) is not None


def test_more_joint_states_than_are_searched_are_refused_before_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    far = line(6, Robot("a", 0, 5, release=10**9), Robot("b", 5, 0, release=10**9))
    assert why_no_obstacle(far, States()) == "the joint states may be more than 2000000"
    monkeypatch.setattr(unsolvable, "FEW_STATES", 100)
    assert why_no_obstacle(HEAD_ON, States()) == "the joint states may be more than 100"


def test_joint_states_are_counted_up_to_the_limit_alone() -> None:
    many = tuple(Robot(number, 0, 1) for number in range(100_000))
    assert joint_states(line(2, *many), most=10) == (2 + 2 * 2) ** 2
    assert why_no_obstacle(line(2, *many), States()) == "the joint states may be more than 2000000"


def test_ways_over_more_stops_and_resources_than_the_limit_are_not_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    stops = tuple(Stop(resource) for resource in (3, 0, 3))
    back = line(4, Robot("a", 0, stops=stops), directed=True)
    monkeypatch.setattr(unsolvable, "LARGEST_TABLE", 12)
    assert why_no_obstacle(back, NoWay("a")) is None
    monkeypatch.setattr(unsolvable, "LARGEST_TABLE", 11)
    assert why_no_obstacle(back, NoWay("a")) == "its stops by the resources are 12, and at most 11 are allowed"


def test_a_search_that_outgrows_its_limit_is_no_obstacle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(least_total_cost, "__defaults__", (10, None))
    assert why_no_obstacle(HEAD_ON, States()) == (
        "the joint states that the search looks at must be at most 10, the limit, and would be more"
    )


def test_steps_to_joint_states_are_counted_before_they_are_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    # no more than two robots are ever in the group, but three may step into each of its places
    group = tuple(range(6))
    edges = tuple((one, other) for one in group for other in group if one != other)
    outside = tuple((away, one) for away in range(6, 9) for one in group)
    graph = ResourceGraph(tuple(map(Resource, range(10))), edges + outside, True, (Group("all", group, 2),))
    crowd = Instance(graph, tuple(Robot(number, number, 9) for number in range(6, 9)))
    monkeypatch.setattr(joint_search, "LARGEST_STEPS", 2 * 7**3 - 1)
    assert why_no_obstacle(crowd, States()) == (
        "the joint steps that the search looks at, by the most constraints of a resource, must be at most 685, the "
        "limit, and would be more"
    )
    monkeypatch.undo()
    assert why_no_obstacle(crowd, States()) is None


@pytest.mark.parametrize("kind", ["clauses"], indirect=True)
def test_far_horizons_are_refused_at_once(proof: Path) -> None:
    manifest = (proof / "manifest.json").read_text()
    (proof / "manifest.json").write_text(manifest.replace("[0,0]", f"[0,{FAR}]"))
    with pytest.raises(ProofError, match=r"^beat\.cnf: for this instance and these horizons it must have more"):
        verify_proof(proof)
