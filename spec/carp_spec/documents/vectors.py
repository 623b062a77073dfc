"""The document of test vectors: `carproof-vectors/1`."""

from typing import Any, Literal, TypeAlias

import msgspec

from carp_spec.documents.instances import read_instance
from carp_spec.documents.solutions import read_solution
from carp_spec.model import Instance, Solution

Flag: TypeAlias = Literal["edge-case", "known-bug-elsewhere", "free-choice"]
Expected: TypeAlias = Literal["valid", "invalid"]
Fields: TypeAlias = dict[str, Any]


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
