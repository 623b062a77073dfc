"""Forgeries: every way to change one thing in a document, or in the lines of a proof."""

import json
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from carp_spec import Instance
from carp_verify.optimum.proof import ProofError, Verified, verify_proof

FAR = 10**99
STRANGERS: tuple[object, ...] = ("moon", -1, 0, True, False, 1.5, None, [], {})


def changed(document: Any) -> Iterator[Any]:  # noqa: ANN401 - any JSON value
    """The document with one value changed, dropped, repeated, moved or added, everywhere in it."""
    yield from replaced(document)
    if isinstance(document, dict):
        for name, value in document.items():
            yield {other: document[other] for other in document if other != name}
            for each in changed(value):
                yield {**document, name: each}
        yield {**document, "more": 1}
    if isinstance(document, list):
        for position, value in enumerate(document):
            before, after = document[:position], document[position + 1 :]
            yield [*before, *after]
            yield [*before, value, value, *after]
            yield [*after[:1], value, *before, *after[1:]]
            for each in changed(value):
                yield [*before, each, *after]


def replaced(value: Any) -> Iterator[Any]:  # noqa: ANN401 - any JSON value
    """Other values in place of one."""
    if isinstance(value, int) and not isinstance(value, bool):
        numbers = (0, value + 1, value - 1, -value, 2 * value, value // 2, value + 2**16, 10**9, FAR, -FAR)
        yield from (number for number in dict.fromkeys(numbers) if number != value)
        yield from (float(value), str(value))
    yield from (stranger for stranger in STRANGERS if stranger != value or type(stranger) is not type(value))
    if isinstance(value, str):
        yield value + " "


def changed_lines(text: str) -> Iterator[str]:
    """The lines with one dropped, repeated, moved, replaced by another, or with one of its numbers changed."""
    lines = text.splitlines()
    for position, line in enumerate(lines):
        before, after = lines[:position], lines[position + 1 :]
        variants = [[], [line, line], *([other] for other in lines if other != line)]
        variants += [[each] for each in changed_words(line)]
        for variant in (*variants, [*after[:1], line]):
            rest = after[1:] if len(variant) == 2 and variant[0] != line else after
            yield "".join(f"{each}\n" for each in (*before, *variant, *rest))
    yield text[: len(text) // 2]


def changed_words(line: str) -> Iterator[str]:
    """The line with one number dropped, negated, or replaced by a neighbour of it or by 0."""
    words = line.split()
    for position, word in enumerate(words):
        before, after = words[:position], words[position + 1 :]
        number = int(word)
        for variant in ((), (-number,), (number + 1,), (number - 1,), (0,), (number, number)):
            if variant != (number,):
                yield " ".join((*before, *map(str, variant), *after))


def verified_with(folder: Path, files: Mapping[str, bytes], instance: Instance | None = None) -> Verified | None:
    """What a proof directory proves with some files replaced, or added, and the digests of all right; or `None`."""
    contents = {**{path.name: path.read_bytes() for path in folder.iterdir()}, **files}
    manifest = json.loads(contents["manifest.json"])
    if isinstance(manifest.get("sha256"), dict):
        named = manifest["sha256"].keys() & contents.keys()
        manifest["sha256"] |= {name: sha256(contents[name]).hexdigest() for name in named}
    with TemporaryDirectory() as forged:
        for name, content in {**contents, "manifest.json": json.dumps(manifest).encode()}.items():
            (Path(forged) / name).write_bytes(content)
        try:
            return verify_proof(Path(forged), instance)
        except ProofError:
            return None
