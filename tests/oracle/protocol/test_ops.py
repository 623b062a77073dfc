"""The table of ops: what is made of it, and that requests and results keep to the schema made of it."""

import json
from functools import cache

import msgspec
import pytest
from jsonschema import Draft202012Validator
from tests.oracle.running import REQUESTS, asked

from carp_spec.documents.schema import schema_file
from carproof.protocol.lines import Request
from carproof.protocol.ops import OPS
from carproof.protocol.ops.published import NAME, schema
from carproof.testing.vectors import vectors


@cache
def validator(definition: str | None = None) -> Draft202012Validator:
    published = json.loads(schema_file(NAME).read_text())
    if definition is not None:
        published = {"$ref": f"#/$defs/{definition}", "$defs": published["$defs"]}
    return Draft202012Validator(published)


def test_the_schema_is_made_of_the_table() -> None:
    Draft202012Validator.check_schema(json.loads(schema()))
    assert schema_file(NAME).read_text() == schema(), "`make generated` writes it"


def test_a_right_request_of_each_op_is_known() -> None:
    assert REQUESTS.keys() == OPS.keys()


@pytest.mark.parametrize("op", REQUESTS)
def test_requests_and_responses_keep_to_the_schema(op: str) -> None:
    request = {"id": 1, "op": op, **REQUESTS[op]}
    validator().validate(request)
    assert not validator().is_valid({**request, "colour": "red"})
    validator(f"{OPS[op].title}Response").validate(asked(op, **REQUESTS[op]))
    validator("Refused").validate(asked(op, **REQUESTS[op], colour="red"))


@pytest.mark.parametrize("op", REQUESTS)
def test_a_request_written_is_read_as_it_was(op: str) -> None:
    request = OPS[op].read(Request(json.dumps(REQUESTS[op]).encode()))
    again = OPS[op].read(Request(msgspec.json.encode(OPS[op].request_fields(request))))
    assert again == request


def test_every_vector_of_an_op_is_a_request() -> None:
    for vector in vectors():
        if "/" not in vector.op and "refused" not in vector.answer:
            request = {"id": vector.id, **vector.request}
            assert validator().is_valid(request), vector.id
            read = Request(msgspec.json.encode(request))
            OPS[read.op()].read(read)
