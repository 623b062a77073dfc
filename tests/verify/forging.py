"""Forgeries: every way to change one thing in a document, or in the lines of a proof."""

from collections.abc import Iterator
from typing import Any

FAR = 10**99
STRANGERS: tuple[object, ...] = ("moon", -1, True, 1.5, None, [])


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
    yield from (stranger for stranger in STRANGERS if stranger != value)
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
