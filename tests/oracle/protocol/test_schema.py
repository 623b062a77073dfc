"""The published JSON Schemas are the decoder's own, and agree with it on the documents of all vectors."""

import json
from collections.abc import Iterator
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from carp_spec.documents.schema import DOCUMENTS, document_schema, schema_file
from carproof import Refusal, read_instance, read_solution
from carproof.testing.vectors import vectors

SHAPE = {
    "document/shape",
    "document/format",
    *(f"instance/{name}" for name in ("capacity", "duration", "release", "pace")),
}
"""What a schema can say of a document."""


def documents() -> Iterator[tuple[str, Any]]:
    """The instances and solutions of vectors; a schema takes 1.0 for a whole number."""
    for case in vectors():
        given = {"instance": case.instance, "solution": case.input.get("solution")}
        for name, document in given.items():
            if isinstance(document, dict) and "1.0" not in json.dumps(document):
                yield name, document


def broken_rule(name: str, document: object) -> str | None:
    """The rule by which the decoder refuses the document."""
    read = {"instance": read_instance, "solution": read_solution}[name]
    try:
        read(json.dumps(document).encode())
    except Refusal as refusal:
        return refusal.rule
    return None


@pytest.mark.parametrize("name", DOCUMENTS)
def test_the_published_schema_is_the_generated_one(name: str) -> None:
    assert schema_file(name).read_text() == document_schema(name), "`make generated` writes it again"


@pytest.mark.parametrize("name", ["instance", "solution"])
def test_schema_and_decoder_agree_on_all_vectors(name: str) -> None:
    schema = json.loads(schema_file(name).read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    found = [(document, broken_rule(kind, document)) for kind, document in documents() if kind == name]
    assert len({rule for _, rule in found}) > 1
    for document, rule in found:
        if rule is None or rule in SHAPE:
            assert validator.is_valid({**document, "$schema": "a.schema.json"}) is (rule is None), document
