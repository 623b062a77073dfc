"""`python -m tests.vectors.writing` lays out the files of the test vectors, and lists the digests of new cases."""

from collections.abc import Mapping
from hashlib import sha256

import msgspec

from carp_spec.documents.vectors import Vector, VectorsDocument
from carproof.testing.vectors import DIGESTS, subjects, vector_file, vectors, vectors_document


class ChangedError(Exception):
    """A case that is on the list has changed or is gone."""


def file_text(document: VectorsDocument) -> str:
    """A file: each field of a case on its own line, so that a changed case shows as changed lines."""
    head = {"format": document.format, "subject": document.subject, "flags": document.flags}
    cases = ["  {\n" + _lines(msgspec.to_builtins(each), "    ") + "\n  }" for each in document.cases]
    return "{\n" + _lines(head, "  ") + ',\n  "cases": [\n' + ",\n".join(cases) + "\n  ]\n}\n"


def _lines(fields: Mapping[str, object], indent: str) -> str:
    return ",\n".join(f"{indent}{_text(name)}: {_text(value)}" for name, value in fields.items())


def _text(value: object) -> str:
    return msgspec.json.format(msgspec.json.encode(value), indent=0).decode()


def digest(vector: Vector) -> str:
    """A digest of all that must never change: everything but flags and comment."""
    fixed = msgspec.structs.replace(vector, flags=(), comment="")
    return sha256(msgspec.json.encode(fixed, order="sorted")).hexdigest()[:16]


def digests() -> Mapping[str, str]:
    """The digest of every case by its id."""
    return {each.id: digest(each) for each in vectors()}


def listed(text: str) -> Mapping[str, str]:
    """The list of digests, as its file holds it."""
    return dict(line.split() for line in text.splitlines())


def list_text(now: Mapping[str, str], before: Mapping[str, str]) -> str:
    """The list with the new cases at its end; raises `ChangedError` if a listed case is not what it was."""
    changed = [id for id, digest in before.items() if now.get(id) != digest]
    if changed:
        raise ChangedError(f"cases never change; give these a new id: {', '.join(changed)}")
    return "".join(f"{id} {digest}\n" for id, digest in {**before, **now}.items())


def write_vectors() -> None:
    """Lay out all files and list new cases, unless a case that was published has changed."""
    text = list_text(digests(), listed(DIGESTS.read_text()))
    for subject in subjects():
        vector_file(subject).write_text(file_text(vectors_document(subject)))
    DIGESTS.write_text(text)


if __name__ == "__main__":
    write_vectors()
