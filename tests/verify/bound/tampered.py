"""Bounds of the crossing with a cut, deadlines or sights that are tampered with, and how carp_verify refuses each."""

from collections.abc import Callable, Sequence
from typing import Any

import msgspec
from tests.verify.bound.examples import (
    UNSOUND_DRAT,
    Tamper,
    completed,
    crossing,
    cut_certificate,
    deadline_certificate,
    sight_certificate,
)

from carp_spec.documents.bounds import BoundDocument


def cut(**fields: object) -> Tamper:
    """Change the only cut."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        return msgspec.structs.replace(certificate, cuts=(msgspec.structs.replace(certificate.cuts[0], **fields),))

    return tamper


def deadlines(**fields: object) -> Tamper:
    """Change the only deadlines, and put the claims right if that makes whole ones."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        changed: Any = msgspec.structs.replace(certificate.deadlines[0], **fields)
        tampered = msgspec.structs.replace(certificate, deadlines=(changed,))
        is_whole = len(changed.seen) != 1 and len(changed.ticks) == len(changed.robots)
        has_whole_claims = is_whole and type(changed.price) is not float
        return completed(crossing(), tampered) if has_whole_claims else tampered

    return tamper


def sight(tick: object = 1, places: object = ("middle",), other: object = ("middle",)) -> Tamper:
    return deadlines(seen=((tick, places), (1, other)))


def twice(first: int) -> Tamper:
    """See r0 at a tick, and again at tick 1."""
    names = ("r0", "r2", "r0")
    return deadlines(robots=names, ticks=(0, 0, 0), seen=tuple((tick, ("middle",)) for tick in (first, 1, 1)))


NOT_PROVED = "its proof does not hold: line"
EACH_ONCE = "must name robots of the instance, each once, or again where it is seen later"
CUTS: Sequence[tuple[Tamper, str, str]] = (
    (cut(multiplier=-1), ".multiplier", "must be a whole number of at least 0, and is -1"),
    (cut(multiplier=(1 << 16) + 1), ".multiplier", "must add up to 65536 at most"),
    (cut(robots=("r0", "r0")), ".robots", "must name robots of the instance once, also 'r0'"),
    (cut(robots=("r0", "moon")), ".robots", "also 'moon'"),
    (cut(robots=("r1",)), "", "it must have a horizon of each of 1 robots"),
    (cut(robots=("r1", "r2")), "", NOT_PROVED),
    (cut(robots=("r0", "r1")), "", NOT_PROVED),
    (cut(robots=(), horizons=(), order=()), ".robots", "it must name at least one robot"),
    (cut(least=8), "", NOT_PROVED),
    (cut(least=99), "", NOT_PROVED),
    (cut(least=-1), "", "a horizon must be between 0 and the least total"),
    (cut(horizons=(0, 0)), "", NOT_PROVED),
    (cut(horizons=(1,)), "", "it must have a horizon of each of 2 robots"),
    (cut(horizons=(1, 1, 1)), "", "it must have a horizon of each of 2 robots"),
    (cut(horizons=(-1, 1)), "", "a horizon must be between 0 and the least total"),
    (cut(horizons=(8, 1)), "", "a horizon must be between 0 and the least total"),
    (cut(order=(0, 0)), "", "and an order of them"),
    (cut(order=(0, 1, 1)), "", "and an order of them"),
    (cut(order=(1, 2)), "", "and an order of them"),
    (cut(order=(0, 10**40)), "", "and an order of them"),
    (cut(refutation=""), "", "it does not end with the empty clause"),
    (cut(refutation="hello"), "", "line 1 must be a clause with its hints"),
    (cut(refutation=UNSOUND_DRAT), "", "line 1 has no hints: refutations without hints"),
)
DEADLINES: Sequence[tuple[Tamper, str, str]] = (
    (deadlines(price=-1), ".price", "must be a whole number of at least 0, and is -1"),
    (deadlines(robots=("r0", "r0")), ".robots", EACH_ONCE),
    (deadlines(robots=("r0", "moon")), ".robots", EACH_ONCE),
    (deadlines(robots=(), ticks=()), ".robots", EACH_ONCE),
    (deadlines(robots=("r1",), ticks=(2,)), "", NOT_PROVED),
    (deadlines(ticks=(2, 3)), "", NOT_PROVED),
    (deadlines(ticks=(2,)), "", "it must have a deadline of each of 2 robots"),
    (deadlines(ticks=(2, 2, 2)), "", "it must have a deadline of each of 2 robots"),
    (deadlines(ticks=(1, 2)), "", "robot r0 can be at its goal at 2, not at 1"),
    (deadlines(refutation=""), "", "it does not end with the empty clause"),
    (deadlines(refutation="hello"), "", "line 1 must be a clause with its hints"),
)
SIGHTS: Sequence[tuple[Tamper, str, str]] = (
    (sight(tick=2), "", NOT_PROVED),  # r0 can wait while r2 passes
    (sight(tick=0), "", NOT_PROVED),
    (sight(places=("middle", "north")), "", NOT_PROVED),
    (sight(other=("middle", "south")), "", NOT_PROVED),
    (deadlines(robots=("r0", "r1"), refutation="1 0 1 0\n"), "", NOT_PROVED),
    (sight(tick=-1), "", "robot r0 must have whole ticks of at least 0, not 0 and -1"),
    (deadlines(ticks=(0, -1)), "", "robot r2 must have whole ticks of at least 0, not -1 and 1"),
    (sight(places=("moon",)), "", "the places of robot r0 must be resources"),
    (deadlines(seen=((1, ("middle",)),)), "", "it must see each of 2 robots"),
    (deadlines(seen=((1, ("middle",)),) * 3), "", "it must see each of 2 robots"),
    (twice(first=1), "", "robot r0 must be seen again later than at 1, not at 1"),
    (twice(first=2), "", "robot r0 must be seen again later than at 2, not at 1"),
    (deadlines(refutation=""), "", "it does not end with the empty clause"),
)
NOT_WHOLE: Sequence[tuple[Callable[[], BoundDocument], Tamper, str]] = (
    (cut_certificate, cut(multiplier=1.5), "$.cuts[0].multiplier"),
    (cut_certificate, cut(least=True), "$.cuts[0].least"),
    (cut_certificate, cut(horizons=(1, 1.0)), "$.cuts[0].horizons[1]"),
    (deadline_certificate, deadlines(price=True), "$.deadlines[0].price"),
    (deadline_certificate, deadlines(ticks=(2.0, 2)), "$.deadlines[0].ticks[0]"),
    (sight_certificate, sight(tick=True), "$.deadlines[0].seen[0][0]"),
)
TAMPERED: Sequence[tuple[Callable[[], BoundDocument], Tamper, str, str]] = tuple(
    (honest, tamper, f"{part}{path}", reason)
    for honest, part, rows in (
        (cut_certificate, "$.cuts[0]", CUTS),
        (deadline_certificate, "$.deadlines[0]", DEADLINES),
        (sight_certificate, "$.deadlines[0]", SIGHTS),
    )
    for tamper, path, reason in rows
)
"""An honest bound, a change of it, and where and why it is refused then."""
