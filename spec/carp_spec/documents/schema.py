"""JSON Schemas, made from the classes that decode documents. `python -m carp_spec.documents.schema` writes them.

They are published in the folder `schemas` of `carp_spec`. A schema accepts more than the decoder: JSON Schema counts
1.0 as a whole number, which `document/shape` does not, and it cannot express the `instance/...` rules about ids.
"""

from collections.abc import Mapping
from inspect import cleandoc
from pathlib import Path
from typing import Any

import msgspec

import carp_spec
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.grants import GrantsDocument
from carp_spec.documents.instances import InstanceDocument, RobotDocument
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_spec.documents.solutions import EXACT_SOLUTION, EXACT_TRACE
from carp_spec.documents.vectors import VectorsDocument
from carp_spec.documents.verdicts import VerdictDocument

FOLDER = Path(carp_spec.__file__).with_name("schemas")
DRAFT = "https://json-schema.org/draft/2020-12/schema"
DOCUMENTS: Mapping[str, type[msgspec.Struct]] = {
    "instance": InstanceDocument,
    "solution": EXACT_SOLUTION,
    "verdict": VerdictDocument,
    "bound": BoundDocument,
    "query": QueryCertificateDocument,
    "trace": EXACT_TRACE,
    "grants": GrantsDocument,
    "vectors": VectorsDocument,
}


def schema_text(name: str, schema: Mapping[str, Any]) -> str:
    """A JSON Schema as its file holds it."""
    for each in schema["$defs"].values():
        if "description" in each:  # from Python 3.13 on they are without indentation anyway
            each["description"] = cleandoc(each["description"])
        if each.get("title") == RobotDocument.__name__:
            each["oneOf"] = [{"required": ["goal"]}, {"required": ["stops"]}]
    head = {"$schema": DRAFT, "$id": f"urn:carproof:{name}:1"}
    return msgspec.json.format(msgspec.json.encode({**head, **schema}, order="sorted"), indent=2).decode() + "\n"


def document_schema(name: str) -> str:
    """The schema of a document."""
    return schema_text(name, msgspec.json.schema(DOCUMENTS[name]))


def schema_file(name: str) -> Path:
    """The file in which the schema of that name is published."""
    return FOLDER / f"{name}.schema.json"


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name in DOCUMENTS:
        schema_file(name).write_text(document_schema(name))
