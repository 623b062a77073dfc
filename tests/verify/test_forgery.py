"""Forgeries of every kind of certificate: a claim that is accepted is true, and harmless variants are accepted.

A forger knows the checkers: after a change, whatever a checker computes itself is put right again, so that the one
thing that is wrong is not hidden behind a sum or a digest that does not agree.
"""

import json
from collections import Counter
from collections.abc import Iterator
from functools import cache
from itertools import islice
from pathlib import Path

import msgspec
import pytest
from tests.verify.bound.examples import completed, crossing, cut_certificate
from tests.verify.forging import FAR, changed, changed_lines, verified_with
from tests.verify.optimum.test_proof import crossing as four_crossing
from tests.verify.query.examples import QUESTIONS, fleets

from carp_optimum.bound import lower_bound
from carp_optimum.optimum import optimum
from carp_optimum.sat.proving import write_proof
from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.documents.bounds import BoundDocument, CutDocument, read_bound
from carp_spec.documents.decoding import write
from carp_spec.documents.instances import digest
from carp_spec.documents.query_certificates import ServedLayer, certificate_of, read_query_certificate
from carp_verify.bound.cuts import formula_of
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.clauses import dimacs
from carp_verify.optimum.encoding import Evidence, beat_formula, reach_formula
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.optimum.refutation import NotRefutedError, read_steps, require_refutation

LONG = 60


def lane(after_goal: str, *robots: Robot, capacity: int = 1, directed: bool = False) -> Instance:
    """Three cells in a row and one beside the second."""
    cells = tuple(Resource(cell, capacity if cell == "b" else 1, 1 + (cell == "c")) for cell in "abcd")
    graph = ResourceGraph(cells, (("a", "b"), ("b", "c"), ("b", "d")), directed)
    return Instance(graph, robots, "park" if after_goal == "park" else "vanish")


INSTANCES = {
    "crossing": crossing(),
    "head-on": lane("vanish", Robot("r", "a", "c"), Robot("s", "c", "a")),
    "park": lane("park", Robot("r", "a", "b"), Robot("s", "d", "c", release=1)),
    "room for two": lane("park", Robot("r", "a", "c", pace=2), Robot("s", "d", "a"), capacity=2),
    "one way": lane("vanish", Robot("r", "a", "c"), Robot("s", "a", "d", release=1), directed=True),
}


@cache
def least(name: str) -> int:
    """The optimum, by the search over all states."""
    total = least_total_cost(INSTANCES[name])
    assert total is not None
    return total


def accepted(instance: Instance, data: bytes) -> int | None:
    """The bound that is accepted, or `None`."""
    try:
        return verify_bound(instance, read_bound(data))
    except Refusal:
        return None


def put_right(instance: Instance, data: bytes) -> bytes:
    """The document with the digest, the robots' least costs and the bound that the checker would compute."""
    try:
        return write(completed(instance, msgspec.structs.replace(read_bound(data), instance=digest(instance))))
    except (Refusal, ArithmeticError, TypeError, ValueError, LookupError, MemoryError):
        return data


def certificates(name: str) -> Iterator[BoundDocument]:
    yield lower_bound(INSTANCES[name], steps=20)
    if name == "crossing":
        yield cut_certificate()


@pytest.mark.parametrize("name", INSTANCES)
def test_no_change_of_a_bound_makes_it_prove_too_much(name: str) -> None:
    instance = INSTANCES[name]
    outcomes: Counter[bool] = Counter()
    for certificate in certificates(name):
        for document in changed(json.loads(write(certificate))):
            forged = json.dumps(document).encode()
            for data in (forged, put_right(instance, forged)):
                bound = accepted(instance, data)
                assert bound is None or bound <= least(name), data
                outcomes[bound is not None] += 1
    assert outcomes[False] > 200
    assert outcomes[True] > 0


def test_no_bound_of_one_instance_proves_too_much_of_another() -> None:
    for name, other in ((name, other) for name in INSTANCES for other in INSTANCES):
        for certificate in certificates(name):
            moved = msgspec.structs.replace(certificate, instance=digest(INSTANCES[other]))
            bound = accepted(INSTANCES[other], write(moved))
            assert bound is None or bound <= least(other)


def test_no_bound_above_the_optimum_is_accepted_however_it_is_spread_over_robots_and_cuts() -> None:
    certificate = cut_certificate()
    (cut,) = certificate.cuts
    scale = certificate.scale
    for more in (1, 2, 10**6):
        for position, (robot, claimed) in enumerate(certificate.robots):
            robots = list(certificate.robots)
            robots[position] = robot, (claimed or 0) + (least("crossing") - certificate.bound + more) * scale
            forged = msgspec.structs.replace(certificate, robots=tuple(robots), bound=least("crossing") + more)
            assert accepted(crossing(), write(forged)) is None
        for multiplier in (scale, scale + 1, 2 * scale):
            dear = msgspec.structs.replace(cut, least=cut.least + more, multiplier=multiplier)
            forged = msgspec.structs.replace(certificate, cuts=(dear,))
            assert accepted(crossing(), put_right(crossing(), write(forged))) is None


def test_no_change_of_a_refutation_refutes_a_cut_that_does_not_hold() -> None:
    """The formula of a total that the group reaches, with every change of the refutation of a smaller total."""
    (cut,) = cut_certificate().cuts
    false_cut: CutDocument = msgspec.structs.replace(cut, least=cut.least + 1)
    clauses = formula_of(crossing(), false_cut, 10**6).clauses
    count = 0
    for text in (cut.refutation, *changed_lines(cut.refutation)):
        with pytest.raises(NotRefutedError):
            require_refutation(clauses, text)
        count += 1
    assert count > 400


def test_harmless_variants_of_a_refutation_are_accepted() -> None:
    (cut,) = cut_certificate().cuts
    clauses = formula_of(crossing(), cut, 10**6).clauses
    steps = read_steps(cut.refutation)
    first = len(clauses) + 1

    def moved(number: int, more: int) -> int:
        return number + more if number >= first else number

    for more in (0, 1, 10**9):
        lines = [
            (step.number + more, *(step.clause or ()), 0, *(moved(hint, more) for hint in step.hints), 0)
            for step in steps
        ]
        unused = (first, *clauses[0], 0, 1, 0)
        for variant in (lines, [unused, *lines] if more else lines):
            require_refutation(clauses, "".join(" ".join(map(str, line)) + "\n" for line in variant))
    forgetting = f"{first} d {10**9} 0\n"
    require_refutation(clauses, forgetting + cut.refutation)


def test_harmless_variants_of_a_bound_are_accepted() -> None:
    certificate = cut_certificate()
    (cut,) = certificate.cuts
    halves = (msgspec.structs.replace(cut, multiplier=cut.multiplier // 2),) * 2
    for changes in (
        {"resources": certificate.resources[::-1]},
        {"exchanges": certificate.exchanges[::-1]},
        {"horizon": certificate.horizon + 1},
        {"horizon": FAR},
        {"cuts": halves},
    ):
        variant = msgspec.structs.replace(certificate, **changes)
        assert accepted(crossing(), put_right(crossing(), write(variant))) == certificate.bound


@pytest.mark.parametrize("name", QUESTIONS)
def test_no_change_of_a_query_certificate_makes_it_prove_too_much(name: str) -> None:
    question = QUESTIONS[name]
    honest = question.certified()[1]
    outcomes: Counter[bool] = Counter()
    for document in changed(json.loads(write(honest))):
        try:
            forged = read_query_certificate(json.dumps(document).encode())
        except Refusal:
            continue
        accepted = question.rule_broken(forged) is None
        assert not accepted or question.is_true(forged), document
        outcomes[accepted] += 1
    assert outcomes[False] > 2
    assert outcomes[True] > 5


def test_no_query_certificate_proves_too_much_beside_other_plans_or_of_another_robot() -> None:
    for question in QUESTIONS.values():
        for other in (each for every in QUESTIONS.values() for each in fleets(every)):
            certificate = other.certified()[1]
            assert question.rule_broken(certificate) is not None or question.is_true(certificate)


def test_no_later_bound_is_accepted_with_the_labels_of_the_search_for_it() -> None:
    """A forger labels every window from its first tick on."""
    for question in QUESTIONS.values():
        plan, honest = question.certified()
        if plan is None:
            continue
        labels = {(each, tick) for each in question.instance.graph.index for tick in range(20)}
        for bound in (plan.visits[-1].enter + 1, FAR, None):
            for those in (None, (*labels,), ()):
                layers = [each if those is None else ServedLayer(those, each.potential) for each in honest.layers]
                forged = certificate_of(honest.robot, honest.now, bound, layers)
                assert question.rule_broken(forged) is not None


@cache
def proved_optimum() -> int:
    best = optimum(four_crossing(), LONG)
    assert best.cost is not None
    return best.cost


@pytest.fixture(name="proof", scope="module")
def written_proof(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("proof")
    write_proof(four_crossing(), optimum(four_crossing(), LONG), folder, LONG)
    return folder


def is_proved(folder: Path, files: dict[str, bytes]) -> int | None:
    """The cost that is accepted with some files replaced, or `None`."""
    verified = verified_with(folder, files, four_crossing())
    return None if verified is None else verified.cost


def test_no_change_of_a_manifest_proves_another_cost(proof: Path) -> None:
    manifest = json.loads((proof / "manifest.json").read_text())
    claims = {name: manifest[name] for name in ("format", "cost", "horizons", "order")}
    count = 0
    for claim in (each for each in changed(claims) if isinstance(each, dict)):
        cost = is_proved(proof, {"manifest.json": json.dumps({"sha256": manifest["sha256"], **claim}).encode()})
        assert cost is None or cost == proved_optimum()
        count += 1
    assert count > 100


@pytest.mark.parametrize("more", [-2, -1, 1, 2])
def test_no_files_prove_another_cost(proof: Path, more: int) -> None:
    """The forger makes both formulas of a false cost, as the checker does, with the honest refutation."""
    manifest = json.loads((proof / "manifest.json").read_text())
    evidence = Evidence(tuple(manifest["horizons"]), tuple(manifest["order"]))
    false = proved_optimum() + more
    reach, beat = (formula(four_crossing(), false, evidence) for formula in (reach_formula, beat_formula))
    files = {
        "manifest.json": json.dumps({**manifest, "cost": false}).encode(),
        "reach.cnf": dimacs(reach.formula).encode(),
        "beat.cnf": dimacs(beat.formula).encode(),
    }
    honest = (proof / "reach.model").read_text().split()[:-1]
    assert is_proved(proof, files) is None
    for position in range(0, reach.formula.variables, 9):
        model = [str(-int(each)) if number == position else each for number, each in enumerate(honest)]
        model += [str(number) for number in range(len(honest) + 1, reach.formula.variables + 1)]
        model_file = " ".join([*model[: reach.formula.variables], "0"]).encode() + b"\n"
        assert is_proved(proof, {**files, "reach.model": model_file}) is None


def test_no_change_of_a_refutation_refutes_the_optimum(proof: Path) -> None:
    manifest = json.loads((proof / "manifest.json").read_text())
    evidence = Evidence(tuple(manifest["horizons"]), tuple(manifest["order"]))
    reachable = beat_formula(four_crossing(), proved_optimum() + 1, evidence).formula.clauses
    text = (proof / "beat.lrat").read_text()
    for variant in (text, *islice(changed_lines(text), 0, None, 7)):
        with pytest.raises(NotRefutedError):
            require_refutation(reachable, variant)
