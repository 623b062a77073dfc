"""Cases of `polish/...`: the decisions of a round that improves a solution, one by one.

Seeds tell what is chosen: the first numbers of SplitMix64 of seed 1 are 10451216379200822465, 13757245211066428519 and
17911839290282890590.
"""

from collections.abc import Mapping, Sequence

from tests.vectors.making import EDGE, Flags, graph, instance, predicate, stays

from carp_spec.vectors import Fields, Vector


def _drawn(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, things: str, count: int, seed: int, right: str, *claimed: str, flags: Flags = ()
) -> list[Vector]:
    input: Fields = {"things": [*things], "count": count, "seed": seed}
    return predicate("polish/draws", id, comment, input, name="drawn", right=[*right],
                     claimed=[[*each] for each in claimed], flags=flags)  # fmt: skip


def _kind(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, right: str | None, *claimed: str | None, turn: int, waiting: int, delay: int, seed: int = 1,
    flags: Flags = (),
) -> list[Vector]:  # fmt: skip
    input: Fields = {"turn": turn, "waiting": waiting, "delay": delay, "seed": seed}
    return predicate("polish/kind", id, comment, input, name="kind", right=right, claimed=claimed, flags=flags)


def _pivot(id: str, comment: str, weights: Sequence[int], seed: int, right: int, *claimed: int, flags: Flags = ()
           ) -> list[Vector]:  # fmt: skip
    input: Fields = {"weights": [*weights], "seed": seed}
    return predicate("polish/pivot", id, comment, input, name="pivot", right=right, claimed=claimed, flags=flags)


def _members(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, candidates: str, everyone: str, seed: int, right: str, *claimed: str, flags: Flags = ()
) -> list[Vector]:
    input: Fields = {"pivot": "p", "candidates": [*candidates], "everyone": [*everyone], "seed": seed}
    return predicate("polish/members", id, comment, input, name="members", right=[*right],
                     claimed=[[*each] for each in claimed], flags=flags)  # fmt: skip


ROW = instance(graph("ab bc cd de"))


def _way(id: str, comment: str, other: str, right: bool, plan: str = "a 0 1, b 1 3", flags: Flags = ()
         ) -> list[Vector]:  # fmt: skip
    input: Fields = {
        "plan": {"robot": "r1", "visits": stays(plan)},
        "other": {"robot": "r2", "visits": stays(other)},
    }
    return predicate("polish/way", id, comment, input, name="in_way", right=right, claimed=[not right], flags=flags,
                     instance=ROW)  # fmt: skip


def _contested(id: str, comment: str, other: str, right: int | None, *claimed: int | None, flags: Flags = ()
               ) -> list[Vector]:  # fmt: skip
    input: Fields = {"visit": ["b", 5, 7], "other": {"robot": "r2", "visits": stays(other)}}
    return predicate("polish/contested", id, comment, input, name="apart", right=right, claimed=claimed, flags=flags)


def _near(id: str, comment: str, distances: object, right: Sequence[int], *claimed: Sequence[int], flags: Flags = ()
          ) -> list[Vector]:  # fmt: skip
    return predicate("polish/near", id, comment, {"distances": distances}, name="order", right=right, claimed=claimed,
                     flags=flags)  # fmt: skip


def _order(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, members: str, repair: bool, seed: int, right: str, *claimed: str, flags: Flags = ()
) -> list[Vector]:
    input: Fields = {"members": [*members], "repair": repair, "seed": seed}
    return predicate("polish/order", id, comment, input, name="order", right=[*right],
                     claimed=[[*each] for each in claimed], flags=flags)  # fmt: skip


def _kept(id: str, comment: str, before: Sequence[int], after: Sequence[int], right: bool, flags: Flags = ()
          ) -> list[Vector]:  # fmt: skip
    input: Fields = {"before": before, "after": after}
    return predicate("polish/kept", id, comment, input, name="kept", right=right, claimed=[not right], flags=flags)


def _options(id: str, comment: str, right: bool, flags: Flags = (), **options: object) -> list[Vector]:
    input: Fields = {"iterations": None, "seconds": None, "seed": 0, **options}
    return predicate("polish/options", id, comment, input, name="right", right=right, claimed=[not right], flags=flags)


CASES: Mapping[str, Sequence[Vector]] = {
    "polish/draws": (
        *_drawn("one-of-five", "the first number mod 5 is 0", "abcde", 1, 1, "a", "e"),
        *_drawn("three-of-five", "each of those left, by a number mod 5, 4, 3", "abcde", 3, 1, "aec", "edc"),
        *_drawn("all", "the last is drawn too, of one", "abcd", 4, 7, "dbca", "abcd"),
        *_drawn("none", "nothing is drawn, and no number taken", "abc", 0, 1, "", "a", flags=EDGE),
    ),
    "polish/kind": (
        *_kind("repair-first", "the first round repairs", "repair", "delayed", None, turn=0, waiting=1, delay=5),
        *_kind("every-other", "the second round is for one that is delayed", "delayed", "repair",
               turn=1, waiting=1, delay=5),
        *_kind("repair-alone", "nobody is delayed: each round repairs", "repair", None, "near", turn=1, waiting=2,
               delay=0, flags=EDGE),
        *_kind("at-the-end", "nothing is left to do", None, "delayed", turn=4, waiting=0, delay=0, flags=EDGE),
        *_kind("delayed", "by the first number of seed 1", "delayed", "near", turn=0, waiting=0, delay=5),
        *_kind("contested", "by the first number of seed 4", "contested", "delayed", turn=0, waiting=0, delay=5,
               seed=4),
        *_kind("near", "by the first number of seed 17", "near", "delayed", turn=0, waiting=0, delay=5, seed=17),
    ),
    "polish/pivot": (
        *_pivot("alike", "one of four, by a number mod 4", [1, 1, 1, 1], 1, 1, 3),
        *_pivot("delays", "a robot that is late is chosen more often: a number mod 10", [0, 2, 7, 1], 1, 2, 3),
        *_pivot("never-without-weight", "a robot that is not delayed is never chosen", [0, 0, 3, 0], 5, 2, 0, 3,
                flags=EDGE),
    ),
    "polish/members": (
        *_members("first-of-many", "the first candidates", "abcdefghijk", "abcdefghijkp", 1, "pabcde", "pkjihg"),
        *_members("filled-up", "two candidates, and drawn others", "ab", "abcdefghijkp", 1, "pabjce", "pabcdef"),
        *_members("few", "no more than there are", "a", "ap", 1, "pa", "p", flags=EDGE),
        *_members("alone", "one robot", "", "p", 1, "p", "pp", flags=EDGE),
    ),
    "polish/way": (
        *_way("same-resource", "it stays in b while the plan does", "b 2 5", right=True),
        *_way("next-to-it", "c is next to b, where the plan is", "c 1 2", right=True),
        *_way("touching", "it comes to c in the tick at which the plan leaves b", "c 3 4", right=True, flags=EDGE),
        *_way("too-late", "one tick after that", "c 4 5", right=False, flags=EDGE),
        *_way("far-away", "d is next to no resource of the plan", "d 1 2", right=False),
        *_way("between-two-visits", "the span goes from the first visit to the last", "b 4 5", right=True,
              plan="a 0 1, b 1 2, c 2 9, d 9 10, c 10 11", flags=EDGE),
        *_way("for-ever", "a robot that is parked at a", "a 0 -", right=True, flags=EDGE),
    ),
    "polish/contested": (
        *_contested("earlier", "it is there at tick 3", "a 0 3, b 3 4", 2, 1, -2),
        *_contested("twice", "the nearer of two visits", "b 1 2, c 2 6, b 6 7", 1, 4),
        *_contested("never", "it never comes there", "a 0 9, c 9 10", None, 0, flags=EDGE),
        *_contested("at-once", "at the same tick, where there is room for several", "b 5 6", 0, None, flags=EDGE),
    ),
    "polish/near": (
        *_near("nearest-first", "by distance", [[3, 1], [1, 2], [2, 1]], [1, 2, 0], [0, 1, 2], [0, 2, 1]),
        *_near("tie", "a tie goes to the earlier", [[2, 1], [1, 1], [4, 2], [1, 1]], [1, 3, 0, 2], [3, 1, 0, 2],
               flags=EDGE),
        *_near("nobody", "there is no other robot", [], [], [0], flags=EDGE),
    ),
    "polish/order": (
        *_order("repair", "the robot without a plan comes first; no choice for it", "pabc", True, 2, "pcab", "abcp"),
        *_order("pivot-first", "a choice of 0: the pivot stays first", "pabc", False, 4, "pacb", "abcp"),
        *_order("all-shuffled", "a choice of 1", "pabc", False, 1, "bapc", "pabc"),
        *_order("alone", "the choice is made all the same", "p", False, 1, "p", "", flags=EDGE),
    ),
    "polish/kept": (
        *_kept("cheaper", "the total falls", [0, 100], [0, 99], right=True),
        *_kept("as-good", "a tie is kept: the next round begins elsewhere", [0, 100], [0, 100], right=True, flags=EDGE),
        *_kept("dearer", "the total grows", [0, 100], [0, 101], right=False, flags=EDGE),
        *_kept("repaired", "a robot more has a plan, whatever it costs", [1, 100], [0, 900], right=True),
        *_kept("given-up", "a robot less has a plan, whatever it saves", [0, 100], [1, 60], right=False),
    ),
    "polish/options": (
        *_options("default", "neither", right=True),
        *_options("iterations", "a number of rounds", right=True, iterations=500, seed=2**64 - 1),
        *_options("no-rounds", "none is a number of rounds too", right=True, iterations=0, flags=EDGE),
        *_options("half-a-second", "a time may be a fraction", right=True, seconds=0.5),
        *_options("both", "rounds and a time", right=False, iterations=5, seconds=5),
        *_options("no-time", "no time is none", right=False, seconds=0, flags=EDGE),
        *_options("flag", "true is no number", right=False, iterations=True, flags=EDGE),
        *_options("large-seed", "a seed has 64 bits", right=False, seed=2**64, flags=EDGE),
    ),
}  # fmt: skip
