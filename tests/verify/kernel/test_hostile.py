"""The kernel's program answers documents of hostile sizes soon and in little memory, and opens plain files alone."""

import json
import os
import resource
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import msgspec
import pytest
from tests.spec.making import line
from tests.verify.bound.examples import crossing, cut_certificate, priced
from tests.verify.kernel.program import Json, program, run
from tests.verify.kernel.test_optimum import claim

from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot
from carp_spec.documents.bounds import BoundDocument, DeadlinesDocument
from carp_spec.documents.decoding import write
from carp_spec.documents.instances import instance_document, read_instance, write_instance
from carp_spec.documents.query_certificates import read_query_certificate
from carp_spec.documents.solutions import read_solution
from carp_verify.optimum.encoding import Evidence
from carp_verify.query.rules import LARGEST_CHECK
from carp_verify.query.verify import verify_query

SECONDS = 60
BYTES = 1 << 29


def _within_limits() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))


def limited(*arguments: str | Path, text: str = "") -> Json:
    """The kernel's answer, for which it has little time and memory."""
    done = subprocess.run(
        [program(), *map(str, arguments)],
        input=text,
        capture_output=True,
        text=True,
        check=False,
        timeout=5 * SECONDS,
        preexec_fn=_within_limits,
    )
    assert done.stdout, (done.returncode, done.stderr)
    return json.loads(done.stdout.splitlines()[0])


def answered(folder: Path, instance: Instance, document: BoundDocument) -> tuple[str, str | None]:
    """The verdict about a bound, and the rule."""
    (folder / "instance.json").write_bytes(write(instance_document(instance)))
    (folder / "bound.json").write_bytes(write(document))
    answer = limited("verify-bound", folder / "instance.json", folder / "bound.json")
    return answer["verdict"], answer.get("rule")


LANE = Instance(line("ab"), (Robot("r", "a", "b"),))
FORK = Instance(
    ResourceGraph(tuple(map(Resource, "abcx")), (("a", "b"), ("b", "c"), ("b", "x"))),
    (Robot("r", "a", "c"), Robot("s", "c", "a")),
)
PARKING = replace(FORK, after_goal="park")


def bound_of(instance: Instance, **fields: object) -> BoundDocument:
    """A bound without prices, with a claim for one robot."""
    return msgspec.structs.replace(priced(instance, bound=1, scale=1, horizon=10**60, robots=(("r", 1),)), **fields)


def both(claim: int) -> dict[str, object]:
    """The same claim for both robots of the fork."""
    return {"robots": (("r", claim), ("s", claim))}


def late(tick: int, price: int = 0) -> dict[str, object]:
    """A deadline of one robot."""
    return {"deadlines": (DeadlinesDocument(("r",), (tick,), price, ""),)}


def seen_late(tick: int) -> dict[str, object]:
    """Deadlines of both robots of the fork, one of which is seen at the tick."""
    seen = ((0, ("a",)), (tick, ("c",)))
    return {"deadlines": (DeadlinesDocument(("r", "s"), (0, 0), 10**6, "2 0 1 0\n", seen=seen),)}


HOSTILE: Mapping[str, tuple[Instance, dict[str, object], str]] = {
    "a price beyond any table": (LANE, {"resources": (("a", 10**50, 5),), "robots": (("r", 10**50),)}, "bound/size"),
    "a search before a late_deadline": (LANE, {"robots": (("r", 10**9),), **late(10**50, 10**60)}, "bound/size"),
    **{f"a formula until 10^{most}": (LANE, late(10**most), "bound/size") for most in (7, 9, 40)},
    # Nor is a cost looked for: a claim that far above the least cost would take long to refute.
    **{f"seen at 10^{most}": (FORK, {**both(10**6 + 2), **seen_late(10**most)}, "bound/size") for most in (6, 50)},
    "far above the least": (FORK, {"resources": (("a", 10**6, 5),), **both(10**6)}, "bound/robots"),
    "and above parking": (PARKING, {"resources": (("a", 10**6, 5),), **both(10**6)}, "bound/robots"),
}


@pytest.mark.parametrize("what", HOSTILE)
def test_a_bound_that_would_take_long_is_refused_soon(what: str, tmp_path: Path) -> None:
    instance, fields, rule = HOSTILE[what]
    assert answered(tmp_path, instance, bound_of(instance, **fields)) == ("refused", rule)


def test_a_robot_that_may_wait_for_ever_is_not_followed(tmp_path: Path) -> None:
    """Its ticks count in a cut alone, so that each of its ways costs the same."""
    honest = cut_certificate()
    (cut,) = honest.cuts
    robots = tuple((robot, 10**9 if robot in cut.robots else 0) for robot in crossing().robot)
    whole = msgspec.structs.replace(cut, multiplier=honest.scale)
    certificate = msgspec.structs.replace(honest, cuts=(whole,), robots=robots)
    assert answered(tmp_path, crossing(), certificate)[0] == "refused"


def test_a_formula_of_too_late_cuts_is_not_made(tmp_path: Path) -> None:
    (cut,) = cut_certificate().cuts
    late = msgspec.structs.replace(cut, least=10**9, multiplier=0, horizons=tuple(10**9 for _ in cut.horizons))
    robots = tuple((robot, 0) for robot in crossing().robot)
    certificate = bound_of(crossing(), bound=0, cuts=(late,), robots=robots)
    assert answered(tmp_path, crossing(), certificate) == ("refused", "bound/size")


@pytest.mark.parametrize("duration", [10**6, 10**50])
def test_a_robot_that_is_seen_in_a_long_stay_is_refused_or_undecided(duration: int, tmp_path: Path) -> None:
    instance = replace(LANE, graph=line("ab", a=duration))
    deadlines = DeadlinesDocument(("r",), (duration,), 0, "2 0 1 0\n", seen=((5, ("a",)),))
    document = bound_of(instance, bound=duration, robots=(("r", duration),), deadlines=(deadlines,))
    assert answered(tmp_path, instance, document)[0] in ("refused", "undecided")


def test_long_stays_under_late_prices_are_undecided(tmp_path: Path) -> None:
    instance = replace(LANE, graph=line("ab", a=10**7, b=10**7), after_goal="park")
    document = bound_of(instance, resources=(("b", 19_999_999, 1),), robots=(("r", 10**7 + 100),))
    assert answered(tmp_path, instance, document)[0] in ("refused", "undecided")


def test_a_refutation_whose_hints_look_at_too_much_is_refused(tmp_path: Path) -> None:
    literals, hints = 20_000, 5_000
    clause = " ".join(map(str, range(1, literals + 1)))
    (tmp_path / "formula.cnf").write_text(f"p cnf {literals} 1\n{clause} 0\n")
    (tmp_path / "proof.lrat").write_text(f"2 {clause} 0 {'1 ' * hints}0\n" * 3)
    answer = limited("refute", tmp_path / "formula.cnf", tmp_path / "proof.lrat")
    assert (answer["verdict"], answer["rule"]) == ("refused", "refutation")
    assert "literals" in answer["message"]


@pytest.mark.parametrize("horizon", [10**7, 10**18])
def test_a_proof_with_large_horizons_is_undecided(horizon: int, tmp_path: Path) -> None:
    instance = replace(LANE, robots=(Robot("r", "a", "b"), Robot("s", "b", "a")))
    claim(tmp_path, instance, 10**30, Evidence((horizon, horizon), (0, 1)))
    code, answer, _ = run("verify-proof", tmp_path)
    assert (code, answer["verdict"]) == (3, "undecided")


def query(labels: int, stays: int) -> str:
    """A request with a query beside one plan that goes to and fro, and labels that are all in one window."""
    robots = (Robot("r", "b", "b"), Robot("s", "a", "b" if stays % 2 == 0 else "a"))
    instance = Instance(ResourceGraph((Resource("a", 2), Resource("b", 2)), (("a", "b"),)), robots)
    visits = [("ab"[number % 2], number, number + 1) for number in range(stays)]
    solution = {
        "format": "carproof-solution/1",
        "plans": [{"robot": "s", "visits": visits}] if visits else [],
        "order": ["s"] if visits else [],
        "unplanned": ["r"] if visits else ["r", "s"],
    }
    certificate = {
        "format": "carproof-query/1",
        "robot": "r",
        "now": 0,
        "bound": 10**9,
        "labels": [("ab"[number % 2], number) for number in range(labels)],
        "potential": [("a", 1), ("b", 0)],
    }
    documents = {"instance": instance_document(instance), "solution": solution, "certificate": certificate}
    return msgspec.json.encode({"op": "verify-query", **documents}).decode() + "\n"


@pytest.mark.parametrize(("labels", "stays"), [(300_000, 0), (4, 300_000), (20_000, 20_000)])
def test_a_query_with_many_labels_or_stays_is_answered(labels: int, stays: int) -> None:
    assert limited("serve", text=query(labels, stays))["verdict"] in ("undecided", "refused")
    asked = json.loads(query(labels, stays))
    audit = {"op": "audit", "certificates": [asked.pop("certificate")]}
    assert limited("serve", text=json.dumps(asked | audit) + "\n")["verdict"] in ("undecided", "refused")


@pytest.mark.parametrize("beyond", [False, True])
def test_the_limit_of_a_query_is_that_of_carp_verify(beyond: bool) -> None:
    """A robot comes or leaves at 4,000 ticks in the first resource, and at 4,001, with tick 0, in the other.

    The labels count those of their own resource once more, and two resources with two moves are looked at first.
    """
    labels = (LARGEST_CHECK - 4) // (1 + 4_000 + 4_000 + 4_001) + beyond
    request = json.loads(query(labels, 4_000))
    documents = [json.dumps(request[name]).encode() for name in ("instance", "solution", "certificate")]
    instance, solution = read_instance(documents[0]), read_solution(documents[1])
    with pytest.raises(Refusal) as refusal:
        verify_query(instance, solution, read_query_certificate(documents[2]))
    rules = {refusal.value.rule, limited("serve", text=query(labels, 4_000)).get("rule")}
    assert ("query-certificate/size" in rules, len(rules)) == ((True, 1) if beyond else (False, len(rules)))


# ---- files ----


TO_DEVICE = partial(Path.symlink_to, target="/dev/zero")


def link(path: Path) -> None:
    other = path.parent.parent / f"outside-{path.name}"
    other.write_text("2 0 1 0\n" if path.suffix == ".lrat" else "{}")
    path.symlink_to(other)


@pytest.mark.parametrize("name", ["instance.json", "manifest.json", "beat.lrat"])
@pytest.mark.parametrize("make", [os.mkfifo, Path.mkdir, TO_DEVICE, link])
def test_only_plain_files_of_a_proof_directory_are_opened(
    make: Callable[[Path], object], name: str, tmp_path: Path
) -> None:
    folder = tmp_path / "proof"
    folder.mkdir()
    claim(folder, LANE, 1, Evidence((0,), (0,)), "2 0 1 0\n")
    (folder / name).unlink()
    make(folder / name)
    answer = limited("verify-proof", folder)
    assert (answer["verdict"], answer["rule"]) == ("bad input", "document/json")
    assert "plain file" in answer["message"]


@pytest.mark.parametrize("make", [os.mkfifo, Path.mkdir, TO_DEVICE])
def test_only_plain_files_are_opened(make: Callable[[Path], object], tmp_path: Path) -> None:
    make(tmp_path / "instance.json")
    answer = limited("check", tmp_path / "instance.json", tmp_path / "instance.json")
    assert (answer["verdict"], answer["rule"]) == ("bad input", "document/json")


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "instance.json").open("wb") as file:
        file.truncate((1 << 28) + 1)
    answer = limited("check", tmp_path / "instance.json", tmp_path / "instance.json")
    assert "268435456 bytes" in answer["message"]


def test_an_instance_may_be_read_by_a_link(tmp_path: Path) -> None:
    (tmp_path / "instance.json").write_bytes(write_instance(LANE))
    (tmp_path / "link.json").symlink_to(tmp_path / "instance.json")
    solution: Mapping[str, object] = {"format": "carproof-solution/1", "plans": [], "order": [], "unplanned": ["r"]}
    (tmp_path / "solution.json").write_text(json.dumps(solution))
    assert limited("check", tmp_path / "link.json", tmp_path / "solution.json")["verdict"] == "accepted"


def test_an_answer_that_cannot_be_written_is_not_given(tmp_path: Path) -> None:
    (tmp_path / "instance.json").write_bytes(write_instance(LANE))
    command = f"{program()} check {tmp_path}/instance.json {tmp_path}/instance.json >&-"
    done = subprocess.run(["/bin/sh", "-c", command], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_a_line_that_is_too_long_is_refused_and_the_next_one_answered() -> None:
    command = f"ulimit -v 2000000; (head -c 270000000 /dev/zero; echo; echo x) | {program()} serve"
    done = subprocess.run(["/bin/sh", "-c", command], capture_output=True, text=True, check=False)
    first, second = map(json.loads, done.stdout.splitlines())
    assert "bytes" in first["message"]
    assert (first["rule"], second["rule"]) == ("document/json", "document/json")


def test_serving_ends_well_with_its_input() -> None:
    assert subprocess.run([program(), "serve"], stdin=subprocess.DEVNULL, check=False).returncode == 0


def test_no_formula_is_shown_where_none_is_made(tmp_path: Path) -> None:
    claim(tmp_path, Instance(line("ab", directed=True), (Robot("r", "b", "a"),)), 1, Evidence((0,), (0,)))
    code, answer, _ = run("formula", tmp_path)
    assert (code, answer["verdict"], answer["rule"]) == (1, "refused", "proof/way")
