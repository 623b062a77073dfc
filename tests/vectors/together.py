"""Cases of `joint/...`: what plans must be together."""

from collections.abc import Mapping, Sequence

from tests.vectors.making import EDGE, KNOWN_BUG, check, graph, instance, parking, robot, row, solution

from carp_spec.vectors import Vector

FOLLOW = instance(row("abcd"), robot("r1", "a", "c"), robot("r2", "b", "d"))
CROSS = graph("ax xb cx xd")
CROSSING = instance(CROSS, robot("r1", "a", "b"), robot("r2", "c", "d"))
WIDE_CROSSING = instance(graph("ax xb cx xd", x={"capacity": 2}), robot("r1", "a", "b"), robot("r2", "c", "d"))
SHORT = parking(graph("ab bc xb"), robot("r1", "a", "b"), robot("r2", "x", "c"))
ROUND = graph("ab bc cd da")
RING = parking(ROUND, robot("r1", "a", "b"), robot("r2", "b", "c"), robot("r3", "c", "d"), robot("r4", "d", "a"))
SAME_GOAL = instance(row("abc"), robot("r1", "a", "b"), robot("r2", "c", "b"))
SAME_START = instance(graph("ab ac"), robot("r1", "a", "b"), robot("r2", "a", "c"))
SLOW = instance(graph("ax xb cx xd", x={"duration": 3}), robot("r1", "a", "b"), robot("r2", "c", "d"))
THREE = instance(
    graph("ax xb cx xd ex xf", x={"capacity": 2}), robot("r1", "a", "b"), robot("r2", "c", "d"), robot("r3", "e", "f")
)

CAPACITY: Sequence[Vector] = (
    check("following", "the one enters at the tick at which the other leaves", FOLLOW,
          solution(r1="a 0 1, b 1 2, c 2 3", r2="b 0 1, c 1 2, d 2 3"), cost=4, flags=EDGE),
    check("room-for-two", "a resource of capacity two holds two", WIDE_CROSSING,
          solution(r1="a 0 1, x 1 2, b 2 3", r2="c 0 1, x 1 2, d 2 3"), cost=4),
    check("vanished", "after it vanished, its goal is free", SAME_GOAL, solution(r1="a 0 1, b 1 2", r2="c 0 2, b 2 3"),
          cost=3, flags=KNOWN_BUG),
    check("not-yet-released", "before its release a robot takes no room",
          instance(row("abc"), robot("r1", "a", "c"), robot("r2", "b", "b", release=5)),
          solution(r1="a 0 1, b 1 2, c 2 3", r2="b 5 6"), cost=2),
    check("before-it-parks", "the goal is free until the robot parks there", SHORT,
          solution(r2="x 0 1, b 1 2, c 2 -", r1="a 0 2, b 2 -"), cost=4, flags=EDGE),
    check("one-tick-shared", "x is taken when the second robot enters", CROSSING,
          solution(r1="a 0 1, x 1 3, b 3 4", r2="c 0 2, x 2 3, d 3 4"), "joint/capacity", cost=6, flags=EDGE),
    check("through-a-parked-robot", "a robot that has arrived is still there", SHORT,
          solution(r1="a 0 1, b 1 -", r2="x 0 5, b 5 6, c 6 -"), "joint/capacity", cost=7, flags=KNOWN_BUG),
    check("after-the-last-arrival", "a checker that stops when the shorter plan ends sees no conflict", SHORT,
          solution(r1="a 0 1, b 1 -", r2="x 0 90, b 90 91, c 91 -"), "joint/capacity", cost=92, flags=KNOWN_BUG),
    check("same-start", "two robots cannot begin in one place at one tick", SAME_START,
          solution(r1="a 0 1, b 1 2", r2="a 0 1, c 1 2"), "joint/capacity", cost=2, flags=KNOWN_BUG),
    check("same-goal-parked", "nor end in one place for ever",
          parking(row("abc"), robot("r1", "a", "b"), robot("r2", "c", "b")),
          solution(r1="a 0 1, b 1 -", r2="c 0 1, b 1 -"), "joint/capacity", cost=2),
    check("in-the-goal-s-last-tick", "a robot that vanishes stays its duration at the goal first", SAME_GOAL,
          solution(r1="a 0 1, b 1 2", r2="c 0 1, b 1 2"), "joint/capacity", cost=2, flags=KNOWN_BUG),
    check("duration-forgotten", "x is taken for three ticks, not for one", SLOW,
          solution(r1="a 0 1, x 1 4, b 4 5", r2="c 0 2, x 2 5, d 5 6"), "joint/capacity", cost=9, flags=KNOWN_BUG),
    check("third-of-two", "two fit, and the third does not", THREE,
          solution(r1="a 0 1, x 1 2, b 2 3", r2="c 0 1, x 1 2, d 2 3", r3="e 0 1, x 1 2, f 2 3"), "joint/capacity",
          cost=6, flags=EDGE),
)  # fmt: skip

PASSING = instance(graph("ab", a={"capacity": 2}, b={"capacity": 2}), robot("r1", "a", "b"), robot("r2", "b", "a"))
HEAD_ON = instance(row("ab"), robot("r1", "a", "b"), robot("r2", "b", "a"))
LANE = instance(row("abcd"), robot("r1", "a", "d"), robot("r2", "d", "a"))
EXCHANGE: Sequence[Vector] = (
    check("rotation", "four robots turn in a ring at one tick: each follows another", RING,
          solution(r1="a 0 1, b 1 -", r2="b 0 1, c 1 -", r3="c 0 1, d 1 -", r4="d 0 1, a 1 -"), cost=4, flags=EDGE),
    check("one-after-the-other", "opposite moves at different ticks, where there is room for two", PASSING,
          solution(r1="a 0 1, b 1 2", r2="b 0 2, a 2 3"), cost=3, flags=EDGE),
    check("following", "the same move one tick later", FOLLOW,
          solution(r1="a 0 1, b 1 2, c 2 3", r2="b 0 1, c 1 2, d 2 3"), cost=4),
    check("three-in-a-ring", "the smallest ring that is no swap",
          instance(graph("ab bc ca"), robot("r1", "a", "b"), robot("r2", "b", "c"), robot("r3", "c", "a")),
          solution(r1="a 0 1, b 1 2", r2="b 0 1, c 1 2", r3="c 0 1, a 1 2"), cost=3, flags=EDGE),
    check("swap", "two robots change places; no resource ever holds both", HEAD_ON,
          solution(r1="a 0 1, b 1 2", r2="b 0 1, a 1 2"), "joint/exchange", cost=2, flags=KNOWN_BUG),
    check("swap-where-two-fit", "capacities do not make the edge wider", PASSING,
          solution(r1="a 0 1, b 1 2", r2="b 0 1, a 1 2"), "joint/exchange", cost=2, flags=KNOWN_BUG),
    check("swap-on-the-way", "in the middle of a lane", LANE,
          solution(r1="a 0 1, b 1 2, c 2 3, d 3 4", r2="d 0 1, c 1 2, b 2 3, a 3 4"), "joint/exchange", cost=6,
          flags=KNOWN_BUG),
    check("swap-of-slow-robots", "moves happen at the end of a stay, however long it was",
          instance(row("ab", a={"duration": 3}), robot("r1", "a", "b"), robot("r2", "b", "a")),
          solution(r1="a 0 3, b 3 4", r2="b 0 3, a 3 6"), "joint/exchange", cost=6),
    check("swap-with-a-directed-pair", "two directed edges are still one place to meet",
          instance(graph("ab ba", directed=True), robot("r1", "a", "b"), robot("r2", "b", "a")),
          solution(r1="a 0 1, b 1 2", r2="b 0 1, a 1 2"), "joint/exchange", cost=2),
    check("swap-after-following", "the one follows the other, which turns back at once",
          instance(row("abc"), robot("r1", "a", "c"), robot("r2", "b", "b")),
          solution(r1="a 0 1, b 1 2, c 2 3", r2="b 0 1, c 1 2, b 2 3"), "joint/exchange", cost=4),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {
    "joint/capacity": CAPACITY,
    "joint/exchange": EXCHANGE,
}
