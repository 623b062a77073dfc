"""The theorems of the proved kernel, and the rules that they support.

`theorems.txt` lists them. `make kernel` has Coq check their proofs, and fails unless each rests on no axiom.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import files


@dataclass(frozen=True, slots=True)
class Theorem:
    """A theorem by its name in a Coq module of `verify/kernel`, its statement, and the rules that it supports."""

    module: str
    name: str
    statement: str
    rules: tuple[str, ...] = ()

    @property
    def file(self) -> str:
        """The file with its proof."""
        return f"verify/kernel/{self.module}.v"


def _listed() -> Iterator[Theorem]:
    """The theorems of the list, in its order."""
    text = files("carp_verify").joinpath("theorems.txt").read_text(encoding="utf-8")
    for module, name, statement, rules in re.findall(r"^(\w+)\.(\w+)\n +(.+)\n((?: +.+\n)*)", text, re.MULTILINE):
        yield Theorem(module, name, statement, tuple(rules.split()))


THEOREMS = tuple(_listed())
