"""Test vectors: for every rule, cases that keep it and cases that break it, as JSON for programs in any language.

Each file in the folder `vectors` of `carp_spec` lists the cases of one subject, a rule's id or an op. A case is a
question of the protocol with the right answer, and perhaps a claim, an answer to judge. Where no op reaches a rule, the
op is the rule's id and asks its predicate alone. A file is read when its first case is asked for.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

import msgspec

import carp_spec
from carp_spec.model import Instance, Solution
from carp_verify.documents import read_instance, read_solution
from carproof.registry import RULES

FOLDER: Final = Path(carp_spec.__file__).with_name("vectors")
DIGESTS: Final = FOLDER / "digests.txt"

Flag: TypeAlias = Literal["edge-case", "known-bug-elsewhere", "free-choice"]
Expected: TypeAlias = Literal["valid", "invalid"]
Fields: TypeAlias = dict[str, Any]

FLAGS: Final[Mapping[Flag, str]] = {
    "edge-case": "The least, the first, the last or none of something: where an off-by-one shows.",
    "known-bug-elsewhere": "Published planners have been wrong here; the comment says how.",
    "free-choice": "Another answer is as good; only a program that claims carproof's ties must give this one.",
}


class Vector(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A case: a question with its right answer, and whether the judged document keeps the rules.

    `instance` is an instance document, which may be malformed, or null. `answer` has, for `check`, `plan` and `add`,
    the `cost` and the number of robots `unplanned`, or `refused`, the path to blame; for `query`, the `cost`, null
    where there is no plan; for `optimum`, the least `cost`; for `verify-bound`, the `bound` that the `certificate`
    proves, or `refused`; for `verify-query`, the earliest `arrival`, null too; for a rule's id, what its claims have.
    """

    id: str
    op: str
    instance: Any
    input: Fields
    claim: Fields | None
    expected: Expected
    violated: tuple[str, ...]
    answer: Fields
    flags: tuple[Flag, ...]
    comment: str

    @property
    def request(self) -> Fields:
        """The fields of the request that asks the question; it shows nothing of the answer."""
        instance = {} if self.instance is None else {"instance": self.instance}
        return {"op": self.op, **instance, **self.input}

    def read_instance(self) -> Instance:
        """The instance; raises `Refusal` if its document is malformed."""
        return read_instance(msgspec.json.encode(self.instance))

    def read_solution(self) -> Solution:
        """The solution among the inputs; raises `Refusal` if its document is malformed."""
        return read_solution(msgspec.json.encode(self.input["solution"]))


class VectorsDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All cases about one subject, and what the flags mean."""

    format: Literal["carproof-vectors/1"]
    subject: str
    flags: dict[Flag, str]
    cases: tuple[Vector, ...]


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
