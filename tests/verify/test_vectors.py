"""The test vectors: what the files say is true, complete, and listed."""

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
import pytest
from jsonschema import Draft202012Validator
from tests.twin import find_plan_by_ticks
from tests.vectors import writing
from tests.vectors.judging import finding
from tests.vectors.writing import ChangedError, digests, file_text, list_text, listed

from carp_spec import plan_cost
from carp_spec.documents.schema import schema_file
from carp_spec.documents.vectors import Vector
from carp_verify.bound.rules import BOUND_RULES
from carp_verify.query.rules import QUERY_CERTIFICATE_RULES
from carproof.registry import RULES
from carproof.testing.vectors import DIGESTS, FLAGS, FOLDER, subjects, vector_file, vectors, vectors_document

BY_RULE = [rule.id for rule in RULES]
KNOWN = {*BY_RULE, *(rule.id for rule in (*BOUND_RULES, *QUERY_CERTIFICATE_RULES))}
ALL = [pytest.param(subject, vector, id=vector.id) for subject in subjects() for vector in vectors(subject)]
FIELD_BUGS = {
    "a stay one tick short": "plan-duration.a-tick-short",
    "a window one tick short": "window-fits.a-tick-short",
    "swaps ignored": "joint-exchange.swap",
    "parked robots missing from reservations": "query-sound.through-a-parked-robot",
    "a goal accepted without its constraints": "query-sound.goal-passed-later",
    "start equal to goal": "query-complete.start-is-goal-refused",
    "endless search where there is no plan": "query-complete.behind-a-parked-robot",
    "robots that never vanish": "plan-goal.never-vanishes",
    "windows of zero length": "window-free.touching-wrong",
    "conflicts after the shorter plan ends": "joint-capacity.after-the-last-arrival",
}


@pytest.mark.parametrize(("subject", "vector"), ALL)
def test_a_case_is_true(subject: str, vector: Vector) -> None:
    found = finding(subject, vector)
    assert (found.violated, found.answer) == (vector.violated, vector.answer)
    assert vector.expected == ("invalid" if vector.violated else "valid")


@pytest.mark.parametrize("vector", [pytest.param(each, id=each.id) for each in vectors() if each.op == "query"])
def test_the_cost_of_a_query_is_that_of_the_naive_twin_too(vector: Vector) -> None:
    instance, robot = vector.read_instance(), vector.input["robot"]
    plans = {plan.robot: plan for plan in vector.read_solution().plans}
    before = plans.pop(robot, None)
    plan = find_plan_by_ticks(instance, [*plans.values()], robot, vector.input["now"], before)
    assert vector.answer == {"cost": None if plan is None else plan_cost(instance, plan)}


@pytest.mark.parametrize("rule", BY_RULE)
def test_every_rule_has_three_cases_that_keep_it_and_three_that_break_it(rule: str) -> None:
    cases = list(vectors(rule))
    assert sum(not case.violated for case in cases) >= 3
    assert sum(rule in case.violated for case in cases) >= 3
    assert all(rule in case.violated for case in cases if case.violated), "a case stands with the rule that it breaks"


@pytest.mark.parametrize("bug", FIELD_BUGS)
def test_each_bug_known_from_the_field_is_a_flagged_case(bug: str) -> None:
    by_id = {vector.id: vector for vector in vectors()}
    assert "known-bug-elsewhere" in by_id[FIELD_BUGS[bug]].flags


@pytest.mark.parametrize("subject", subjects())
def test_a_file_obeys_its_schema_and_defines_its_flags(subject: str) -> None:
    document = json.loads(vector_file(subject).read_text())
    Draft202012Validator(json.loads(schema_file("vectors").read_text())).validate(document)
    assert document["subject"] == subject
    assert document["flags"] == FLAGS


def test_every_case_has_an_id_of_its_own_a_comment_and_rules_that_there_are() -> None:
    cases = list(vectors())
    assert len({case.id for case in cases}) == len(cases)
    assert all(
        case.id.startswith(f"{subject.replace('/', '-')}.") for subject in subjects() for case in vectors(subject)
    )
    assert all(case.comment for case in cases)
    assert all(set(case.violated) <= KNOWN for case in cases)


def test_every_rule_of_query_certificates_that_is_not_of_their_size_is_broken_by_a_case() -> None:
    broken = {rule for case in vectors("verify-query") for rule in case.violated}
    assert broken == {rule.id for rule in QUERY_CERTIFICATE_RULES} - {"query-certificate/size"}


def test_the_question_does_not_tell_the_answer() -> None:
    fields = {"op", "instance", "solution", "robot", "now", "planner", "certificate", "trace"}
    options = {"m", "sample", "seed", "baseline", "fallback", "attempts", "k", "paths"}
    asked = [case.request for case in vectors() if "/" not in case.op]
    assert all(set(request) <= fields | options for request in asked)


def test_every_file_is_laid_out() -> None:
    laid_out = {vector_file(subject).name: file_text(vectors_document(subject)) for subject in subjects()}
    there = {path.name: path.read_text() for path in FOLDER.glob("*.json")}
    assert there == laid_out, "`make generated` lays them out"


def test_every_case_is_listed_with_its_digest() -> None:
    assert listed(DIGESTS.read_text()) == digests(), "`make generated` lists new cases"


@pytest.mark.parametrize("before", [{"gone": "0"}, {"kept": "0"}])
def test_a_case_that_changed_or_is_gone_is_refused(before: Mapping[str, str]) -> None:
    with pytest.raises(ChangedError, match="give these a new id"):
        list_text({"kept": "1"}, before)
    assert list_text({"new": "2", "kept": "1"}, {"kept": "1"}) == "kept 1\nnew 2\n"


def test_only_flags_and_comment_may_be_reworded() -> None:
    case = next(vectors("plan/move"))
    document: dict[str, Any] = {name: getattr(case, name) for name in case.__struct_fields__}
    reworded = Vector(**{**document, "flags": ("free-choice",), "comment": "in other words"})
    assert writing.digest(reworded) == writing.digest(case)
    assert writing.digest(Vector(**{**document, "answer": {"cost": 9}})) != writing.digest(case)


def test_a_new_case_is_laid_out_and_listed_and_a_changed_one_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "vectors"
    shutil.copytree(FOLDER, folder)
    monkeypatch.setattr("carproof.testing.vectors.FOLDER", folder)
    monkeypatch.setattr(writing, "DIGESTS", folder / "digests.txt")
    document = vectors_document("window/fits")
    added = msgspec.structs.replace(document.cases[0], id="window-fits.added")
    path = vector_file("window/fits")
    path.write_bytes(msgspec.json.encode(msgspec.structs.replace(document, cases=(*document.cases, added))))
    writing.write_vectors()
    laid_out = path.read_text()
    assert laid_out.startswith(vector_text := (FOLDER / path.name).read_text().removesuffix("\n  ]\n}\n"))
    assert laid_out.removeprefix(vector_text).startswith(',\n  {\n    "id": "window-fits.added",\n')
    assert (folder / "digests.txt").read_text() == f"{DIGESTS.read_text()}window-fits.added {writing.digest(added)}\n"
    path.write_text(laid_out.replace('"expected": "valid"', '"expected": "invalid"', 1))
    with pytest.raises(ChangedError, match=document.cases[0].id):
        writing.write_vectors()
