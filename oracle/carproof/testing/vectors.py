"""Test vectors: for every rule, cases that keep it and cases that break it, as JSON for programs in any language.

Each file in the folder `vectors` of `carp_spec` lists the cases of one subject, a rule's id or an op. A case is a
question of the protocol with the right answer, and perhaps a claim, an answer to judge. Where no op reaches a rule, the
op is the rule's id and asks its predicate alone. A file is read when its first case is asked for.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

import msgspec

import carp_spec
from carp_spec.documents.vectors import Flag, Vector, VectorsDocument
from carproof.registry import RULES

__all__ = ["FOLDER", "Vector", "VectorsDocument", "subjects", "vector_file", "vectors", "vectors_document"]

FOLDER: Final = Path(carp_spec.__file__).with_name("vectors")
DIGESTS: Final = FOLDER / "digests.txt"


FLAGS: Final[Mapping[Flag, str]] = {
    "edge-case": "The least, the first, the last or none of something: where an off-by-one shows.",
    "known-bug-elsewhere": "Published planners have been wrong here; the comment says how.",
    "free-choice": "Another answer is as good; only a program that claims carproof's ties must give this one.",
}


def vector_file(subject: str) -> Path:
    """The file with the cases about a rule's id or an op."""
    return FOLDER / f"{subject.replace('/', '-')}.json"


def subjects() -> tuple[str, ...]:
    """The subjects of the cases: the ids of all rules, then ops."""
    return (*(rule.id for rule in RULES), "optimum", "verify-bound", "verify-query")


def vectors_document(subject: str) -> VectorsDocument:
    """The file about a subject; raises `msgspec.ValidationError` if the file does not have that shape."""
    return msgspec.json.decode(vector_file(subject).read_bytes(), type=VectorsDocument)


def vectors(subject: str | None = None) -> Iterator[Vector]:
    """The cases about a subject, or all; each file is read when its first case is asked for."""
    for each in subjects() if subject is None else (subject,):
        yield from vectors_document(each).cases
