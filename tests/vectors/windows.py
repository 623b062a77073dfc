"""Cases of `window/...`: the free time windows of one resource."""

from collections.abc import Mapping, Sequence

from tests.vectors.making import EDGE, KNOWN_BUG, Flags, case, predicate

from carp_spec.vectors import Fields, Vector


def _free(
    id: str, comment: str, occupations: Sequence[Sequence[int | None]], capacity: int, right: object, *claimed: object,
    flags: Flags = (),
) -> list[Vector]:  # fmt: skip
    input: Fields = {"occupations": occupations, "capacity": capacity}
    return predicate("window/free", id, comment, input, name="windows", right=right, claimed=claimed, flags=flags)


FREE: Sequence[Vector] = (
    *_free("never-occupied", "one window, from 0 for ever", [], 1, [[0, None]], [], [[1, None]], flags=EDGE),
    *_free("one-stay", "a window before it and one after it", [[2, 5]], 1, [[0, 2], [5, None]], [[0, 1], [6, None]],
           [[0, 2], [6, None]], [[0, 3], [5, None]]),
    *_free("from-the-first-tick", "no window before tick 0", [[0, 2]], 1, [[2, None]], [[0, 0], [2, None]],
           flags=KNOWN_BUG),
    *_free("touching", "stays [1,3) and [3,4) leave no window at 3", [[1, 3], [3, 4]], 1, [[0, 1], [4, None]],
           [[0, 1], [3, 3], [4, None]], flags=KNOWN_BUG),
    *_free("parked", "after a robot has parked there is no window", [[4, None]], 1, [[0, 4]], [[0, 4], [5, None]],
           flags=KNOWN_BUG),
    *_free("always-taken", "no window at all", [[0, None]], 1, [], [[0, None]], flags=EDGE),
    *_free("one-tick-gap", "a window of one tick", [[0, 3], [4, None]], 1, [[3, 4]], [], flags=EDGE),
    *_free("room-for-one-more", "one stay does not fill two places", [[1, 5]], 2, [[0, None]], [[0, 1], [5, None]]),
    *_free("full-where-stays-overlap", "only the ticks that two stays share are full", [[1, 5], [3, 8]], 2,
           [[0, 3], [5, None]], [[0, 1], [8, None]]),
    *_free("one-leaves-as-one-enters", "the count stays at two at tick 5: no window of zero length",
           [[1, 9], [2, 5], [5, 7]], 2, [[0, 2], [7, None]], [[0, 2], [5, 5], [7, None]], flags=KNOWN_BUG),
    *_free("not-merged", "windows are maximal: two that touch are one", [[2, 4]], 2, [[0, None]], [[0, 2], [2, None]],
           flags=EDGE),
)  # fmt: skip


def _fits(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, window: Sequence[int | None], stay: Sequence[int | None], duration: int, *, right: bool,
    flags: Flags = (),
) -> Vector:  # fmt: skip
    input = {"window": window, "enter": stay[0], "leave": stay[1], "duration": duration}
    return case(id, "window/fits", comment, input=input, violated=[] if right else ["window/fits"], flags=flags)


FITS: Sequence[Vector] = (
    _fits("whole-window", "the stay fills the window", [2, 5], [2, 5], 3, right=True, flags=EDGE),
    _fits("within", "room to spare", [2, 9], [4, 7], 2, right=True),
    _fits("last-entry", "the latest entry is the end less the duration", [0, 6], [4, 6], 2, right=True, flags=EDGE),
    _fits("for-ever", "a stay for ever fits a window without end", [3, None], [3, None], 1, right=True),
    _fits("one-tick", "the shortest stay in the shortest window", [3, 4], [3, 4], 1, right=True, flags=EDGE),
    _fits("a-tick-short", "the window is one tick shorter than the robot needs", [2, 4], [2, 4], 3, right=False,
          flags=KNOWN_BUG),
    _fits("too-late", "it would have to stay a tick beyond the end", [0, 6], [5, 7], 2, right=False, flags=EDGE),
    _fits("too-early", "the window opens a tick later", [3, 9], [2, 5], 2, right=False, flags=EDGE),
    _fits("no-time", "a stay of no ticks", [3, 9], [4, 4], 1, right=False, flags=KNOWN_BUG),
    _fits("for-ever-in-a-window-that-ends", "it cannot park where somebody comes later", [0, 50], [3, None], 1,
          right=False, flags=KNOWN_BUG),
    _fits("long-duration-in-an-endless-window", "a window without end does not shorten the stay", [0, None], [0, 2], 3,
          right=False),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {"window/free": FREE, "window/fits": FITS}
