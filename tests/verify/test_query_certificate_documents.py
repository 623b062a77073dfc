"""Query certificates are read strictly."""

import json

import pytest

from carp_spec import Refusal
from carp_spec.documents.decoding import write
from carp_spec.documents.query_certificates import QUERY_FORMAT, QueryCertificateDocument, read_query_certificate

CERTIFICATE = QueryCertificateDocument(QUERY_FORMAT, "r", 0, None, (("a", 0),), (("b", 0), ("a", 1)))


def test_a_certificate_written_is_read_again() -> None:
    assert read_query_certificate(write(CERTIFICATE)) == CERTIFICATE


@pytest.mark.parametrize(
    ("field", "value", "path", "rule"),
    [
        ("format", "carproof-query/2", "$.format", "document/format"),
        ("more", 1, "$", "document/shape"),
        ("robot", None, "$.robot", "document/shape"),
        ("now", True, "$.now", "document/shape"),
        ("now", -1, "$.now", "document/shape"),
        ("bound", 1.5, "$.bound", "document/shape"),
        ("labels", [["a"]], "$.labels[0]", "document/shape"),
        ("labels", [["a", None]], "$.labels[0][1]", "document/shape"),
        ("potential", {"a": 1}, "$.potential", "document/shape"),
    ],
)
def test_a_malformed_certificate_is_refused_with_path_and_rule(field: str, value: object, path: str, rule: str) -> None:
    document = {**json.loads(write(CERTIFICATE)), field: value}
    with pytest.raises(Refusal) as refused:
        read_query_certificate(json.dumps(document).encode())
    assert (refused.value.path, refused.value.rule) == (path, rule)
