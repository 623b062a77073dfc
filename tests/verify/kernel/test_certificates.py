"""The proved kernel on certificates: of queries, refutations and bounds."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws
from tests.verify.bound.examples import (
    Tamper,
    certificates,
    crossing,
    cut_certificate,
    deadline_certificate,
    priced,
    sight_certificate,
)
from tests.verify.bound.tampered import EACH_ONCE, NOT_PROVED, TAMPERED
from tests.verify.forging import changed
from tests.verify.kernel.program import Json, ask, encoded, refusal_of, require_bad_input, run, served
from tests.verify.optimum.test_refutation import REFUSED, REFUTED, SQUARE
from tests.verify.optimum.tiny import TINY
from tests.verify.query.examples import Question

from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, RobotId, Solution, has_ended
from carp_spec.documents.bounds import BoundDocument, read_bound
from carp_spec.documents.decoding import write
from carp_spec.documents.instances import instance_document
from carp_spec.documents.solutions import solution_document
from carp_verify.bound.verify import verify_bound
from carproof.testing.strategies import FleetUnderWay, fleets_under_way, instances

_kernel = pytest.fixture(scope="module", autouse=True)(served)


# ---- queries ----


def certified(instance: Instance, solution: Solution, robot: RobotId, now: int = 0) -> tuple[Plan | None, Json]:
    """The reference's plan for a robot beside the plans of the others, and its certificate."""
    plan, certificate = Question(instance, solution, robot, now).certified()
    return plan, msgspec.to_builtins(certificate)


def verify_query(instance: Instance, solution: Solution, certificate: Json) -> Json:
    return asked("verify-query", instance, solution, certificate=certificate)


def asked(op: str, instance: Instance, solution: Solution, **more: object) -> Json:
    documents = {"instance": instance_document(instance), "solution": solution_document(solution)}
    return ask(encoded(op=op, **documents, **more))


@given(st.data(), fleets_under_way())
def test_query_certificates_prove_the_least_arrival_and_no_later_one(data: st.DataObject, fleet: FleetUnderWay) -> None:
    """Of the robot to add, and of one under way."""
    under_way = [plan.robot for plan in fleet.solution.plans if not has_ended(plan, fleet.now)]
    for robot in (fleet.robot, *([data.draw(st.sampled_from(under_way))] if under_way else [])):
        _, certificate = certified(fleet.instance, fleet.solution, robot, fleet.now)
        verdict = verify_query(fleet.instance, fleet.solution, certificate)
        assert (verdict["verdict"], verdict["bound"]) == ("accepted", certificate["bound"])
        labels, wrong = certificate["labels"], []
        if certificate["bound"] is not None:
            wrong += [{"bound": certificate["bound"] + 1}, {"bound": None}]
        if labels:
            missing = data.draw(st.integers(0, len(labels) - 1))
            wrong.append({"labels": labels[:missing] + labels[missing + 1 :]})
        for change in wrong:
            assert verify_query(fleet.instance, fleet.solution, certificate | change)["verdict"] == "refused"


@given(instances())
def test_an_audit_accepts_plans_made_one_after_the_other_and_no_later_one(instance: Instance) -> None:
    plans: list[Plan] = []
    certificates = []
    for robot in instance.robot:
        plan, certificate = certified(instance, Solution.of(instance, plans), robot)
        if plan is not None:
            certificates.append(certificate)
            plans.append(plan)
    solution = Solution.of(instance, plans)
    assert asked("audit", instance, solution, certificates=certificates)["verdict"] == "accepted"
    if certificates:
        verdict = asked("audit", instance, solution, certificates=certificates[1:])
        assert (verdict["verdict"], verdict["rule"]) == ("refused", "query/optimal")


def test_an_audit_refuses_plans_that_break_the_law_and_names_the_rule() -> None:
    """Each is optimal by itself: the certificates hold, but the two robots exchange their resources."""
    graph = ResourceGraph((Resource("a", 2), Resource("b", 2)), (("a", "b"),))
    instance = Instance(graph, (Robot("r", "a", "b"), Robot("s", "b", "a")))
    alone = [certified(instance, Solution.of(instance, []), robot) for robot in instance.robot]
    certificates = [certificate for _, certificate in alone]
    solution = Solution.of(instance, [plan for plan, _ in alone if plan is not None])
    verdict = asked("audit", instance, solution, certificates=certificates)
    assert (verdict["verdict"], verdict["rule"]) == ("refused", "joint/exchange")


# ---- refutations ----

FORMULA = "c a comment\np cnf 2 4\n" + "".join(f"{one} {other} 0\n" for one, other in SQUARE)


def refute(folder: Path, formula: str, proof: str) -> tuple[int, Json, str]:
    (folder / "formula.cnf").write_text(formula)
    (folder / "proof.lrat").write_text(proof)
    return run("refute", folder / "formula.cnf", folder / "proof.lrat")


@pytest.mark.parametrize(("text", "reason"), REFUSED)
def test_what_python_refuses_is_refused_or_not_read(text: str, reason: str, tmp_path: Path) -> None:
    code = refute(tmp_path, FORMULA, text)[0]
    assert code == 1 or (code == 2 and "must be" in reason)


MALFORMED_FORMULAS = ("", "1 0\n", "p cnf 1 2\n1 0\n", "p cnf 1 1\n2 0\n", "p cnf 1 1\n1\n", "p cnf x 1\n")
MALFORMED_PROOFS = [f"{REFUTED}\n", f"c a comment\n{REFUTED}", "5 2 0 1 2 0 \n", "5 2 0  1 2 0\n", "05 2 0 1 2 0\n"]
MALFORMED_PROOFS += [f"5 {number} 0 1 0\n" for number in (10**18, 10**100, "x", "1.0", "0x1", "1_0", "-")]


SATISFIABLE = FORMULA.replace("4\n", "3\n", 1).replace("-1 -2 0\n", "")


@pytest.mark.parametrize(
    ("formula", "proof", "code"),
    [
        (FORMULA, REFUTED, 0),
        (SATISFIABLE, REFUTED, 1),
        *((each, REFUTED, 2) for each in MALFORMED_FORMULAS),
        *((FORMULA, each, 2) for each in MALFORMED_PROOFS),
    ],
)
def test_a_refutation_is_accepted_refused_or_bad_input(formula: str, proof: str, code: int, tmp_path: Path) -> None:
    assert refute(tmp_path, formula, proof)[0] == code


# ---- bounds ----


def decided(instance: Instance, document: Json) -> tuple[Json, str | None]:
    """The kernel's answer about a bound, and the rule by which `carp_verify` refuses it too."""
    answer = ask(encoded(op="verify-bound", instance=instance_document(instance), certificate=document))
    refusal = refusal_of(lambda: verify_bound(instance, read_bound(msgspec.json.encode(document))))
    if refusal is None:
        assert answer["verdict"] == "accepted"
    elif refusal.rule.startswith("bound/"):
        assert (answer["verdict"], answer["rule"]) == ("refused", refusal.rule)
    else:
        require_bad_input(answer, refusal, "certificate")
    return answer, None if refusal is None else refusal.rule


@settings(max_examples=draws(300))
@given(st.data(), instances(replace(TINY, groups=2), least_robots=1), st.integers(0, 2))
def test_bounds_are_accepted_and_refused_as_by_carp_verify(data: st.DataObject, instance: Instance, first: int) -> None:
    """Whatever is changed in them, but for the digest, which the kernel leaves to Python."""
    honest = json.loads(write(data.draw(certificates(instance))))
    variants = [each for each in changed(honest) if isinstance(each, dict)]
    for document in (honest, *(each for each in variants[first::3] if each.get("instance") == honest["instance"])):
        answer, rule = decided(instance, document)
        assert rule is not None or answer["bound"] == document["bound"]


@pytest.mark.parametrize(
    ("honest", "part"),
    [(cut_certificate, "cuts"), (deadline_certificate, "deadlines"), (sight_certificate, "deadlines")],
)
def test_cuts_deadlines_and_sights_are_accepted_and_refused_as_by_carp_verify(
    honest: Callable[[], BoundDocument], part: str
) -> None:
    """But for ticks so late that their formulas are large."""
    whole = json.loads(write(honest()))
    (only,) = whole[part]
    for name, value in only.items():
        for other in changed(value):
            if name == "price" or re.search(r"\d{4}", str(other)) is None:
                decided(crossing(), {**whole, part: [{**only, name: other}]})


def test_long_stays_and_late_releases_cost_no_time() -> None:
    """Ticks beyond the horizon are not gone through."""
    resources = (Resource("a", duration=10**60), Resource("b"))
    robots = (Robot("r", "a", "b", release=10**90), Robot("s", "a", "b"))
    instance = Instance(ResourceGraph(resources, (("a", "b"),)), robots)
    claims = (("r", 10**60), ("s", 10**60 + 3))
    certificate = priced(instance, bound=2 * 10**60, scale=1, horizon=10**6, resources=(("a", 5, 3),), robots=claims)
    assert decided(instance, msgspec.to_builtins(certificate))[1] is None


SAYS = {
    NOT_PROVED: "the refutation does not derive the empty clause",
    EACH_ONCE: EACH_ONCE,
    "robot r0 can be at its goal at 2, not at 1": "robot r0 can be at its goal at 2, not earlier",
    "and an order of them": "and an order of them",
}
"""What the kernel says where it has a sentence for what `carp_verify` says."""


@pytest.mark.parametrize(("honest", "tamper", "path", "reason"), TAMPERED)
def test_tampered_cuts_deadlines_and_sights_are_refused_as_by_carp_verify(
    honest: Callable[[], BoundDocument], tamper: Tamper, path: str, reason: str
) -> None:
    assert decided(crossing(), msgspec.to_builtins(honest()))[1] is None
    answer, rule = decided(crossing(), msgspec.to_builtins(tamper(honest())))
    assert rule == ("document/shape" if "path" in answer else f"bound/{'cut' if 'cuts' in path else 'deadline'}")
    assert SAYS.get(reason, "") in answer["message"]
