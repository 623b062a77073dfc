"""The published JSON Schemas are the decoder's own, and agree with it on simple documents."""

import json
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from carp_spec import Refusal
from carp_spec.documents.instances import read_instance
from carp_spec.documents.schema import DOCUMENTS, document_schema, schema_file
from carp_spec.documents.solutions import read_solution

INSTANCE: dict[str, Any] = {
    "format": "carproof-instance/1",
    "graph": {
        "nodes": [{"id": "a"}, {"id": 2, "capacity": 2, "x": 0, "y": -1}],
        "edges": [{"source": "a", "target": 2}],
    },
    "after_goal": "park",
    "robots": [{"id": "r1", "start": "a", "goal": 2, "release": 3}],
}
SOLUTION: dict[str, Any] = {
    "format": "carproof-solution/1",
    "plans": [{"robot": "r1", "visits": [["a", 3, 4], [2, 4, None]]}],
    "order": ["r1"],
    "unplanned": [],
}


def accepted(name: str, document: dict[str, Any]) -> tuple[bool, bool]:
    schema = json.loads(schema_file(name).read_text())
    Draft202012Validator.check_schema(schema)
    read = {"instance": read_instance, "solution": read_solution}[name]
    try:
        read(json.dumps(document).encode())
    except Refusal:
        return (Draft202012Validator(schema).is_valid(document), False)
    return (Draft202012Validator(schema).is_valid(document), True)


@pytest.mark.parametrize("name", DOCUMENTS)
def test_the_published_schema_is_the_generated_one(name: str) -> None:
    assert schema_file(name).read_text() == document_schema(name), "`make generated` writes it again"


def test_a_document_may_name_its_schema() -> None:
    named = {**INSTANCE, "$schema": "instance.schema.json"}
    assert accepted("instance", named) == (True, True)
    assert read_instance(json.dumps(named).encode()) == read_instance(json.dumps(INSTANCE).encode())


def test_schema_and_decoder_accept_the_same_good_documents() -> None:
    assert accepted("instance", INSTANCE) == (True, True)
    assert accepted("solution", SOLUTION) == (True, True)


@pytest.mark.parametrize(
    "change",
    [
        {"format": "carproof-instance/2"},
        {"graph": {"nodes": []}},
        {"graph": {**INSTANCE["graph"], "multigraph": True}},
        {"graph": {"nodes": [{"id": True}], "edges": []}},
        {"graph": {"nodes": [{"id": "a", "capacity": 0}], "edges": []}, "robots": []},
        {"graph": {"nodes": [{"id": "a", "duration": 1.5}], "edges": []}, "robots": []},
        {"after_goal": "stay"},
        {"robots": [{"id": "r1", "start": "a", "goal": 2, "release": -1}]},
        {"robots": [{"id": "r1", "start": "a", "goal": 2, "speed": 1}]},
        {"robots": [{"id": "r1", "start": "a"}]},
        {"colour": "red"},
    ],
)
def test_schema_and_decoder_reject_the_same_bad_instances(change: dict[str, Any]) -> None:
    assert accepted("instance", {**INSTANCE, **change}) == (False, False)


@pytest.mark.parametrize(
    "change",
    [
        {"plans": [{"robot": "r1", "visits": [["a", 0]]}]},
        {"plans": [{"robot": "r1", "visits": [["a", None, 1]]}]},
        {"plans": [{"robot": None, "visits": []}]},
        {"order": [True]},
        {"unplanned": None},
    ],
)
def test_schema_and_decoder_reject_the_same_bad_solutions(change: dict[str, Any]) -> None:
    assert accepted("solution", {**SOLUTION, **change}) == (False, False)
