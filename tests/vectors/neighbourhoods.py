"""Cases of `neighbourhood/...`: the decisions of the paper's Algorithm 1, one by one, and robots added by it."""

from collections.abc import Mapping, Sequence

from tests.vectors.making import EDGE, FREE, Flags, case, graph, instance, predicate, robot, row, solution, stays

from carp_spec.vectors import Fields, Vector

UNIT = 65536
TOWN = instance(graph("ab bc de"), robot("r1", "a", "c"), robot("r2", "d", "e"))
IDLE = solution(r1="a 0 5, b 5 6, c 6 7")


def _add(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, instance: Fields, committed: Fields, robot: str, *, cost: int, unplanned: int = 0,
    flags: Flags = (), **options: object,
) -> Vector:  # fmt: skip
    input = {"solution": committed, "robot": robot, **options}
    answer = {"cost": cost, "unplanned": unplanned}
    return case(id, "add", comment, instance=instance, input=input, answer=answer, flags=flags)


def _tried(id: str, comment: str, baseline: bool, rounds: int, right: bool, flags: Flags = ()) -> list[Vector]:
    input: Fields = {"baseline": baseline, "rounds": rounds}
    return predicate(
        "neighbourhood/baseline", id, comment, input, name="tried", right=right, claimed=[not right], flags=flags
    )


BASELINE: Sequence[Vector] = (
    *_tried("on", "by default it is the first candidate", baseline=True, rounds=3, right=True),
    *_tried("paper-mode", "the paper does not try it", baseline=False, rounds=3, right=False),
    *_tried("paper-mode-alone", "with no neighbour there is no other candidate", baseline=False, rounds=0, right=True,
            flags=EDGE),
    _add("kept-as-it-is", "a neighbourhood of the new robot alone leaves all plans unchanged", TOWN, IDLE, "r2",
         cost=7, m=1),
)  # fmt: skip


def _nearest(id: str, comment: str, distances: object, right: int, *claimed: int, flags: Flags = ()) -> list[Vector]:
    return predicate("neighbourhood/nearest", id, comment, {"distances": distances}, name="nearest", right=right,
                     claimed=claimed, flags=flags)  # fmt: skip


NEAREST: Sequence[Vector] = (
    *_nearest("least", "distances to one member", [[[3, 1]], [[1, 1]], [[2, 1]]], 1, 0),
    *_nearest("least-over-members", "near one member is near the neighbourhood", [[[5, 1], [5, 1]], [[9, 1], [2, 1]]],
              1, 0),
    *_nearest("tie", "a tie goes to the earlier in planning order", [[[4, 1]], [[2, 1]], [[2, 1]]], 1, 2, flags=EDGE),
    *_nearest("fractions", "1/3 is less than 333334/1000000, by less than a float of 32 bits tells",
              [[[333334, 1000000]], [[1, 3]]], 1, 0, flags=EDGE),
)  # fmt: skip


def _line(*robots: Fields) -> Fields:
    nodes = [{"id": id, "x": x, "y": 0} for x, id in enumerate("abcd")]
    return instance({"nodes": nodes, "edges": row("abcd")["edges"]}, *robots)


def _distance(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, instance: Fields, one: str, other: str, right: Sequence[int], *claimed: Sequence[int],
    flags: Flags = (),
) -> list[Vector]:  # fmt: skip
    input = {"one": {"robot": "r1", "visits": stays(one)}, "other": {"robot": "r2", "visits": stays(other)}}
    return predicate("neighbourhood/distance", id, comment, input, name="distance", right=right, claimed=claimed,
                     flags=flags, instance=instance)  # fmt: skip


DIAGONAL = instance(
    {"nodes": [{"id": "a", "x": 0, "y": 0}, {"id": "b", "x": 1, "y": 1}], "edges": []},
    robot("r1", "a", "a"), robot("r2", "b", "b"),
)  # fmt: skip
DISTANCE: Sequence[Vector] = (
    *_distance("standing", "one tick, one apart", _line(robot("r1", "a", "a"), robot("r2", "b", "b")), "a 0 1", "b 0 1",
               [UNIT, 1], [UNIT, 2], flags=EDGE),
    *_distance("coming-nearer", "3, 2 and 1 apart at the ticks 0, 1 and 2: both ends count",
               _line(robot("r1", "a", "c"), robot("r2", "d", "d")), "a 0 1, b 1 2, c 2 3", "d 0 1", [2 * UNIT, 1],
               [3 * UNIT, 1], [5 * UNIT, 2]),
    *_distance("diagonal", "the floor of 2^16 times the root of 2", DIAGONAL, "a 0 1", "b 0 1", [92681, 1], [92682, 1],
               [2 * UNIT, 1], flags=EDGE),
    *_distance("before-release", "at its start before its release: 1 apart at the ticks 0 to 2, then 2",
               _line(robot("r1", "a", "a"), robot("r2", "b", "c", release=2)), "a 0 1", "b 2 3, c 3 4",
               [5 * UNIT // 4, 1],
               [3 * UNIT, 2], [2 * UNIT, 1]),
    *_distance("same-place", "robots without positions all stand at (0, 0)",
               instance(row("ab"), robot("r1", "a", "a"), robot("r2", "b", "b")), "a 0 1", "b 0 1", [0, 1], [UNIT, 1]),
)  # fmt: skip


def _replan(
    id: str, comment: str, taken: int, planned: int, right: int, *claimed: int, flags: Flags = ()
) -> list[Vector]:
    input: Fields = {"taken": taken, "planned": planned}
    return predicate("neighbourhood/replan", id, comment, input, name="from", right=right, claimed=claimed, flags=flags)


REPLAN: Sequence[Vector] = (
    *_replan("from-the-one-taken", "those before it did not see it", 2, 5, 2, 0, 3),
    *_replan("from-the-first-without-plan", "the round before found no plan from there on", 4, 1, 1, 4),
    *_replan("all", "the first was taken", 0, 5, 0, 1, flags=EDGE),
    *_replan("none", "the last was taken: nobody is behind it", 5, 5, 5, 4, flags=EDGE),
)


def _orders(  # noqa: PLR0913 - the fields of a case
    id: str, comment: str, size: int, sample: int | None, seed: int, right: object, *claimed: object, flags: Flags = ()
) -> list[Vector]:
    input: Fields = {"size": size, "sample": sample, "seed": seed}
    return predicate(
        "neighbourhood/orders", id, comment, input, name="orders", right=right, claimed=claimed, flags=flags
    )


THREE = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]
ORDERS: Sequence[Vector] = (
    *_orders("all-of-two", "lexicographic", 2, None, 0, [[0, 1], [1, 0]], [[1, 0], [0, 1]]),
    *_orders("all-of-three", "six, lexicographic", 3, None, 0, THREE, THREE[:5], THREE[::-1]),
    *_orders("alone", "one order of one robot", 1, None, 0, [[0]], [], flags=EDGE),
    *_orders("sample-of-all", "no numbers are drawn where all orders fit the sample", 3, 6, 99, THREE, THREE[1:],
             flags=EDGE),
    *_orders("sample-of-four", "four distinct shuffles of 0, 1, 2, sorted; SplitMix64 of seed 7", 3, 4, 7,
             [[0, 2, 1], [1, 2, 0], [2, 0, 1], [2, 1, 0]], [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0]]),
)  # fmt: skip


def _best(id: str, comment: str, cost: int, best: int | None, right: bool, flags: Flags = ()) -> list[Vector]:
    input: Fields = {"cost": cost, "best": best}
    return predicate(
        "neighbourhood/best", id, comment, input, name="replaces", right=right, claimed=[not right], flags=flags
    )


BEST: Sequence[Vector] = (
    *_best("smaller", "a smaller total is better", 9, 10, right=True),
    *_best("equal", "of equal totals the first is kept", 10, 10, right=False, flags=EDGE),
    *_best("first", "anything is better than nothing", 10**9, None, right=True, flags=EDGE),
    *_best("larger", "a larger total is worse", 11, 10, right=False),
    _add("replanned", "r1 was to wait for nobody; planned anew with r2 it goes at once", TOWN, IDLE, "r2", cost=3,
         flags=FREE, m=2),
    _add("start-taken", "no order helps r2, whose start is r1's: everything stays as it was",
         instance(graph("ab ac"), robot("r1", "a", "b"), robot("r2", "a", "c")), solution(r1="a 0 3, b 3 4"), "r2",
         cost=3,
         unplanned=1, m=2),
)  # fmt: skip


def _update(id: str, comment: str, planned: str | None, right: str, *claimed: str, flags: Flags = ()) -> list[Vector]:
    def plan(text: str) -> Fields:
        return {"robot": "r1", "visits": stays(text)}

    input: Fields = {"before": plan("a 0 1, b 1 2"), "planned": None if planned is None else plan(planned)}
    return predicate("neighbourhood/update", id, comment, input, name="trajectory", right=plan(right),
                     claimed=[plan(each) for each in claimed], flags=flags)  # fmt: skip


UPDATE: Sequence[Vector] = (
    *_update("new-plan", "the new plan takes its place", "a 0 3, b 3 4", "a 0 3, b 3 4", "a 0 1, b 1 2"),
    *_update("no-plan", "a robot that found none keeps what it had", None, "a 0 1, b 1 2", "", flags=EDGE),
    *_update("same-plan", "planned anew, with the same result", "a 0 1, b 1 2", "a 0 1, b 1 2", "a 0 3, b 3 4"),
)

CASES: Mapping[str, Sequence[Vector]] = {
    "neighbourhood/baseline": BASELINE,
    "neighbourhood/nearest": NEAREST,
    "neighbourhood/distance": DISTANCE,
    "neighbourhood/replan": REPLAN,
    "neighbourhood/orders": ORDERS,
    "neighbourhood/best": BEST,
    "neighbourhood/update": UPDATE,
}
