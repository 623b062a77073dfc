"""Draws texts that are nearly requests to the kernel: right ones, changed in a few bytes or words."""

import re
from collections.abc import Callable, Sequence

import msgspec

from carp_spec.permutations import shuffle
from carproof.testing.random_instances import Draw
from carproof.testing.vectors import vectors

OPS = ("check", "verify-bound", "verify-query", "audit")
MOST_CHANGES = 3
LONGEST_SLICE = 40
WORD = re.compile(rb'"(?:[^"\\]|\\.)*"|[^\s"{}\[\]:,]+|[{}\[\]:,]', re.DOTALL)
BYTES = (
    b"\x00\x09\x0c\x0d\x1f \"'*+,-./0123456789:;=?AENT[\\]_abdeflnrstux{}~"
    b"\x7f\x80\xa0\xbf\xc0\xc3\xe0\xed\xf0\xf4\xf5\xff"
)
WORDS = (
    *(b"0 -0 00 01 -1 - +1 1 2 3 1. .5 1.0 1e0 1E3 -1e-1 1e400 0x10 1_000 1n".split()),
    *(b"true false null True None NaN Infinity -Infinity nul undefined".split()),
    *(b"9223372036854775807 9223372036854775808 4611686018427387904 -4611686018427387905 1000000000".split()),
    *(b"1" + b"0" * zeros for zeros in (50, 98, 99, 100, 400)),
    *(b"-1" + b"0" * zeros for zeros in (98, 99, 100)),
    *(b"0" * digits for digits in (2, 100, 101)),
    *(rb'"" "a" "1" "-0" "\u0061" "\ud83d\ude00" "\ud800" "\ude00\ud83d" "\u00" "\uD83D" "\u0000" "\/" "\x41"'.split()),
    *(rb'"\'" "\b\f\n\r\t" "\q" "" "\\" "\" \\ \u0061'.split()),
    *('"\u00e9" "e\u0301" "\u2028" "\U0001f600" "\ufeff" \ufeff \u00a0'.encode().split(b" ")),
    *(b'"' + broken + b'"' for broken in (b"\x80", b"\xc0\xaf", b"\xe0\x80\x80", b"\xed\xa0\x80", b"\xf4\x90\x80\x80")),
    *(b'"' + control + b'"' for control in (b"\x00", b"\x1f", b"\x7f", b"\t")),
    *(b"[] {} [[]] [{}] [null] {} [,] {,}".split()),
    *(b"[" * deep + b"]" * deep for deep in (98, 99, 100, 101, 1100)),
    *(b'/**/ // # ; \' <a> `A (1,2) <"a":1>'.split()),
    b'{"a":1,"a":1}',
    b'{"a":1,"\\u0061":1}',
    b"",
    b" ",
)
"""Words that a reader may get wrong: numbers, texts, nesting, and what is no JSON."""


def vector_requests() -> Sequence[bytes]:
    """The requests of the test vectors that the kernel knows."""
    known = [vector.request for vector in vectors() if vector.op in OPS]
    return [msgspec.json.encode(each) for each in known]


def changed(draw: Draw, text: bytes) -> bytes:
    """The text after up to a few changes, on one line."""
    for _ in range(draw.between(0, MOST_CHANGES)):
        text = draw.one_of(CHANGES)(draw, text)
    return text.replace(b"\n", b" ")


def _other_byte(draw: Draw, text: bytes) -> bytes:
    place = draw.between(0, len(text))
    return text[:place] + bytes([draw.one_of(BYTES)]) + text[place + draw.between(0, 1) :]


def _flipped_bit(draw: Draw, text: bytes) -> bytes:
    place = draw.between(0, max(0, len(text) - 1))
    return text[:place] + bytes(byte ^ 1 << draw.between(0, 7) for byte in text[place : place + 1]) + text[place + 1 :]


def _moved_slice(draw: Draw, text: bytes) -> bytes:
    """Cut a slice, and put it somewhere else, or nowhere, or twice."""
    first = draw.between(0, len(text))
    end = first + draw.between(1, LONGEST_SLICE)
    rest = draw.one_of([text, text[:first] + text[end:]])
    place = draw.between(0, len(rest))
    return draw.one_of([rest, rest[:place] + text[first:end] + rest[place:]])


def _cut_short(draw: Draw, text: bytes) -> bytes:
    return text[: draw.between(0, len(text))]


def _other_word(draw: Draw, text: bytes) -> bytes:
    """Put another word in the place of one: of the list, or of the text."""
    words = WORD.findall(text) or [b""]
    place = draw.between(0, len(words) - 1)
    words[place] = draw.one_of(WORDS if draw.happens(2) else words)
    return b"".join(words)


def _other_number(draw: Draw, text: bytes) -> bytes:
    """Make a number a little larger or smaller, or larger by far."""
    words = WORD.findall(text)
    places = [place for place, word in enumerate(words) if word.isdigit()]
    if places:
        place = draw.one_of(places)
        more = draw.one_of([-2, -1, 1, 2, 10**9, 10**20, 10**50])
        words[place] = str(int(words[place]) + more).encode() if len(words[place]) < LONGEST_SLICE else b"0"
    return b"".join(words)


def _other_member(draw: Draw, text: bytes) -> bytes:
    """Name a member of an object twice, give it another name, leave it out, or add one."""
    words = WORD.findall(text)
    names = [place for place, word in enumerate(words[:-2]) if words[place + 1] == b":" and word[:1] == b'"']
    if not names:
        return text
    place = draw.one_of(names)
    name, value = words[place], words[place + 2]
    words[place : place + 1] = draw.one_of(
        [
            [name, b":", value if value[:1] not in b"[{" else b"null", b",", name],
            [b'"new"', b":", b"1", b",", name],
            [words[draw.one_of(names)]],
            [name[:1] + b"\\u%04x" % name[1] + name[2:]] if len(name) > 2 and name[1] != ord("\\") else [name],  # noqa: PLR2004 - quotes
        ]
    )
    return b"".join(words)


def _swapped_words(draw: Draw, text: bytes) -> bytes:
    words = WORD.findall(text) or [b""]
    one, other = draw.between(0, len(words) - 1), draw.between(0, len(words) - 1)
    words[one], words[other] = words[other], words[one]
    return b"".join(words)


def _shuffled_members(draw: Draw, text: bytes) -> bytes:
    """Write the members of the request in another order; a text that is no object stays."""
    try:
        members = msgspec.json.decode(text, type=dict[str, msgspec.Raw])
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return text
    return msgspec.json.encode(dict(shuffle([*members.items()], draw.stream)))


CHANGES: Sequence[Callable[[Draw, bytes], bytes]] = (
    _other_byte,
    _flipped_bit,
    _moved_slice,
    _cut_short,
    *(_other_word, _other_number, _other_member, _swapped_words) * 3,
    _shuffled_members,
)
