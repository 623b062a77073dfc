"""Cases of `query/...` and `fleet/history`: one robot's plan against committed plans. The robot is the first, r1.

The cost is what a right program must find; the claims are plans, or the claim that there is none, to judge.
"""

from collections.abc import Mapping, Sequence

from tests.vectors.making import (
    EDGE,
    FREE,
    KNOWN_BUG,
    graph,
    instance,
    parking,
    predicate,
    query,
    robot,
    row,
    solution,
)

from carp_spec.vectors import Vector

R1 = robot("r1", "a", "c")
ROW = instance(row("abcd"), R1, robot("r2", "b", "d"))
AHEAD = solution(r2="b 0 1, c 1 2, d 2 3")
SWAP = instance(graph("ab", a={"capacity": 2}, b={"capacity": 2}), robot("r1", "a", "b"), robot("r2", "b", "a"))
OTHER_WAY = solution(r2="b 0 1, a 1 2")
SIDE = parking(graph("ab bc bx"), robot("r1", "a", "c"), robot("r2", "b", "b"))
CROSS = instance(graph("ax xb cx xd"), robot("r1", "a", "b"), robot("r2", "c", "d"))
ACROSS = solution(r2="c 0 1, x 1 2, d 2 3")
SLOW_CROSS = instance(graph("ax xb cx xd", x={"duration": 3}), robot("r1", "a", "b"), robot("r2", "c", "d", release=1))
SLOW_ACROSS = solution(r2="c 1 3, x 3 6, d 6 7")
PASSED = parking(graph("ab bc dc ce"), R1, robot("r2", "d", "e", release=4))
PASSES = solution(r2="d 4 5, c 5 6, e 6 -")
HOME = parking(graph("ab ac ax"), robot("r1", "a", "a"), robot("r2", "c", "b"))
THROUGH_HOME = solution(r2="c 0 2, a 2 3, b 3 -")
ALONE = instance(row("abc"), R1)
NOBODY = solution()

SOUND: Sequence[Vector] = (
    query("follows", "it enters each resource as the other leaves it", ROW, AHEAD, "a 0 1, b 1 2, c 2 3", cost=2,
          flags=EDGE),
    query("lets-pass", "both stand in one place of capacity two and leave it by turns", SWAP, OTHER_WAY, "a 0 2, b 2 3",
          cost=2, flags=KNOWN_BUG),
    query("start-is-goal", "a plan of one visit", instance(row("ab"), robot("r1", "a", "a")), NOBODY, "a 0 1", cost=0,
          flags=KNOWN_BUG),
    query("released-late", "it starts at its release, not at now",
          instance(row("abc"), robot("r1", "a", "c", release=7)),
          NOBODY, "a 7 8, b 8 9, c 9 10", cost=2),
    query("swaps", "opposite moves at tick 1", SWAP, OTHER_WAY, "a 0 1, b 1 2", "joint/exchange", "query/sound", cost=2,
          flags=KNOWN_BUG),
    query("through-a-parked-robot", "r2 never leaves b, and c lies behind it", SIDE, solution(r2="b 0 -"),
          "a 0 1, b 1 2, c 2 -", "joint/capacity", "query/sound", cost=None, flags=KNOWN_BUG),
    query("goal-passed-later", "c is free when r1 arrives, and r2 needs it later: r1 cannot park there yet", PASSED,
          PASSES,
          "a 0 1, b 1 2, c 2 -", "joint/capacity", "query/sound", cost=6, flags=KNOWN_BUG),
    query("a-tick-short", "x is free for two ticks, and it needs three", SLOW_CROSS, SLOW_ACROSS,
          "a 0 1, x 1 3, b 3 4", "plan/duration", "query/sound", cost=9, flags=KNOWN_BUG),
    query("leaves-before-it-could", "it stays its duration at the start too",
          instance(row("abc", a={"duration": 2}), R1), NOBODY, "a 0 1, b 1 2, c 2 3", "plan/duration", "query/sound",
          cost=3),
    query("start-is-goal-unparked", "at its goal, and in the way: it cannot stay for ever", HOME, THROUGH_HOME,
          "a 0 -", "joint/capacity", "query/sound", cost=3, flags=KNOWN_BUG),
    query("appears-at-now", "it stood at its start before, where r2 went through: there is no plan",
          instance(graph("ab bc da ae"), R1, robot("r2", "d", "e")), solution(r2="d 0 1, a 1 2, e 2 3"),
          "a 6 7, b 7 8, c 8 9", "plan/start", "query/sound", now=6, cost=None, flags=KNOWN_BUG),
)  # fmt: skip
THREE_WAYS = instance(
    graph("ax xb cx xd ex xf", x={"capacity": 2}), robot("r1", "a", "b"), robot("r2", "c", "d"), robot("r3", "e", "f")
)
PACED_CROSS = instance(graph("ax xb cx xd"), robot("r1", "a", "b", pace=2), robot("r2", "c", "d", release=2))
SLOW_GOAL = instance(graph("ab bc dc", c={"duration": 2}), R1, robot("r2", "d", "c", release=2))
WAIT = instance(graph("ab bc bx"), R1, robot("r2", "b", "x"))
BUSY = solution(r2="b 0 6, x 6 7")
DETOUR = instance(graph("ab bc ad dc", b={"duration": 4}), R1)
DETOUR_TAKEN = instance(graph("ab bc bx ad de ef fc"), R1, robot("r2", "b", "x"))
OPTIMAL: Sequence[Vector] = (
    query("shortest-path", "alone, it takes a shortest path", ALONE, NOBODY, "a 0 1, b 1 2, c 2 3", cost=2),
    query("least-ticks", "more moves, fewer ticks: durations count",
          instance(graph("ab bc ad de ec", b={"duration": 9}), R1),
          NOBODY, "a 0 1, d 1 2, e 2 3, c 3 4", cost=3),
    query("waits", "a gap opens in front of it", WAIT, BUSY, "a 0 6, b 6 7, c 7 8", cost=7, flags=EDGE),
    query("goes-round", "a detour takes less time than waiting", DETOUR_TAKEN, BUSY,
          "a 0 1, d 1 2, e 2 3, f 3 4, c 4 5",
          cost=4),
    query("uses-a-gap", "x is free for just as long as it needs", SLOW_CROSS, solution(r2="c 1 4, x 4 7, d 7 8"),
          "a 0 1, x 1 4, b 4 5", cost=4, flags=EDGE),
    query("moves-aside-and-comes-back", "it arrives, makes room, and arrives for good", PASSED, PASSES,
          "a 0 1, b 1 2, c 2 5, b 5 6, c 6 -", cost=6),
    query("after-the-last-pass", "the last entry of the goal counts, not the first", PASSED, PASSES,
          "a 0 1, b 1 6, c 6 -",
          cost=6, flags=KNOWN_BUG),
    query("start-is-goal-comes-back", "it has to leave its goal and come back", HOME, THROUGH_HOME,
          "a 0 2, x 2 3, a 3 -", cost=3, flags=KNOWN_BUG),
    query("start-is-goal-comes-back-late", "r2 is gone at 3", HOME, THROUGH_HOME, "a 0 2, x 2 5, a 5 -",
          "query/optimal",
          cost=3),
    query("vanished-robot", "the goal of a robot that has vanished is free again",
          instance(row("abc"), R1, robot("r2", "c", "c")), solution(r2="c 0 1"), "a 0 1, b 1 2, c 2 3", cost=2,
          flags=KNOWN_BUG),
    query("waits-a-tick-too-long", "it could go one tick earlier", WAIT, BUSY, "a 0 7, b 7 8, c 8 9", "query/optimal",
          cost=7,
          flags=EDGE),
    query("fewest-moves", "the path of fewest moves takes more ticks", DETOUR, NOBODY, "a 0 1, b 1 5, c 5 6",
          "query/optimal", cost=2),
    query("waits-for-a-robot-that-vanished", "it takes r2 for parked in c and waits in vain",
          instance(row("abc"), R1, robot("r2", "c", "c")), solution(r2="c 0 1"), "a 0 5, b 5 6, c 6 7", "query/optimal",
          cost=2, flags=KNOWN_BUG),
    query("gap-missed", "it takes the window for too short: b - a equals the duration", SLOW_CROSS,
          solution(r2="c 1 4, x 4 7, d 7 8"), "a 0 7, x 7 10, b 10 11", "query/optimal", cost=4, flags=EDGE),
    query("avoids-following", "it keeps a distance that nobody asks for", ROW, AHEAD, "a 0 2, b 2 3, c 3 4",
          "query/optimal", cost=2),
    query("room-for-two", "one robot in x leaves room for another",
          instance(graph("ax xb cx xd", x={"capacity": 2}), robot("r1", "a", "b"), robot("r2", "c", "d")), ACROSS,
          "a 0 1, x 1 2, b 2 3", cost=2),
    query("no-room-for-three", "two robots fill x for a tick", THREE_WAYS,
          solution(r2="c 0 1, x 1 2, d 2 3", r3="e 0 1, x 1 2, f 2 3"), "a 0 2, x 2 3, b 3 4", cost=3, flags=EDGE),
    query("slow-robot", "its pace lengthens every stay, and the gap in x is too short for it", PACED_CROSS,
          solution(r2="c 2 3, x 3 4, d 4 5"), "a 0 4, x 4 6, b 6 8", cost=6, flags=KNOWN_BUG),
    query("stay-at-the-goal-fits", "it needs two ticks at its goal before it vanishes, and has just them", SLOW_GOAL,
          solution(r2="d 2 4, c 4 6"), "a 0 1, b 1 2, c 2 4", cost=2, flags=EDGE),
    query("stay-at-the-goal-too-short", "the goal is free for one tick of the two that it needs", SLOW_GOAL,
          solution(r2="d 2 3, c 3 5"), "a 0 1, b 1 5, c 5 7", cost=5, flags=KNOWN_BUG),
    query("keeps-a-tick-too-far", "it takes a stay [1,2) for one that lasts through tick 2", CROSS, ACROSS,
          "a 0 3, x 3 4, b 4 5", "query/optimal", cost=3, flags=EDGE),
)  # fmt: skip
HEAD_ON = instance(row("abc"), R1, robot("r2", "c", "a"))
WALLED = parking(graph("ab bc ad"), R1, robot("r2", "b", "b"))
COMPLETE: Sequence[Vector] = (
    query("unreachable", "no moves lead to the goal: the search must end", instance(graph("ab cd"), R1), NOBODY, None,
          cost=None, flags=KNOWN_BUG),
    query("against-one-way", "the only edge leads the other way", instance(graph("cb ba", directed=True), R1), NOBODY,
          None,
          cost=None),
    query("behind-a-parked-robot", "waiting is for ever possible and of no use: a search over ticks does not end",
          WALLED,
          solution(r2="b 0 -"), None, cost=None, flags=KNOWN_BUG),
    query("head-on-in-a-lane", "there is no place to pass", HEAD_ON, solution(r2="c 0 1, b 1 2, a 2 3"), None,
          cost=None,
          flags=KNOWN_BUG),
    query("start-taken", "another robot stands on its start at its release", instance(graph("ab bc ad"), R1,
          robot("r2", "a", "d")), solution(r2="a 0 2, d 2 3"), None, cost=None, flags=EDGE),
    query("goal-taken-for-ever", "two robots cannot park in one place", parking(row("abc"), R1, robot("r2", "c", "c")),
          solution(r2="c 0 -"), None, cost=None, flags=KNOWN_BUG),
    query("gives-up-too-early", "the way is free after a thousand ticks", WAIT, solution(r2="b 0 1000, x 1000 1001"),
          None,
          "query/complete", cost=1001, flags=EDGE),
    query("start-is-goal-refused", "an empty path is a path", instance(row("ab"), robot("r1", "a", "a")), NOBODY, None,
          "query/complete", cost=0, flags=KNOWN_BUG),
    query("start-left-in-time", "the other comes as it goes: its start is free just long enough",
          instance(graph("ab bc da"), R1, robot("r2", "d", "a")), solution(r2="d 0 1, a 1 2"), None, "query/complete",
          cost=2, flags=EDGE),
    query("way-back-over-the-start", "it must return to where it was to let the other pass",
          parking(graph("ab bc bx"), robot("r1", "b", "b"), robot("r2", "a", "c")),
          solution(r2="a 0 1, b 1 2, c 2 -"), None, "query/complete", cost=2),
    query("own-plan-taken-for-another-s", "it avoids its own reservations", WAIT,
          solution(r1="a 0 6, b 6 7, c 7 8", r2="b 0 6, x 6 7"), None, "query/complete", now=3, cost=7,
          flags=KNOWN_BUG),
)  # fmt: skip

DIAMOND = instance(graph("ab ad bc dc"), R1)
TIES: Sequence[Vector] = (
    *predicate("query/ties", "smallest-f", "the smallest f comes first, whatever g", name="order", right=[1, 0],
               input={"nodes": [[5, 5, 0, 0], [4, 0, 9, 9]]}, claimed=[[0, 1]]),
    *predicate("query/ties", "largest-g", "among equal f the one nearer the goal", name="order", right=[1, 2, 0],
               input={"nodes": [[5, 1, 0, 0], [5, 3, 2, 0], [5, 2, 1, 0]]}, claimed=[[0, 2, 1]]),
    *predicate("query/ties", "smallest-index", "then the resource listed first in the instance", name="order",
               right=[1, 0], input={"nodes": [[5, 2, 3, 0], [5, 2, 1, 8]]}, claimed=[[0, 1]]),
    *predicate("query/ties", "earliest-window", "then the window that opens first", name="order", right=[1, 0],
               input={"nodes": [[5, 2, 3, 6], [5, 2, 3, 0]]}, claimed=[[0, 1]]),
    query("diamond", "two ways are equally good; b is listed first", DIAMOND, NOBODY, "a 0 1, b 1 2, c 2 3", cost=2,
          flags=FREE),
    query("diamond-other-way", "as good, but not ours", DIAMOND, NOBODY, "a 0 1, d 1 2, c 2 3", "query/ties", cost=2,
          flags=FREE),
    query("waits-early-or-late", "it enters each window as early as it can and waits in the last one", WAIT,
          solution(r2="b 0 3, x 3 4"), "a 0 3, b 3 4, c 4 5", cost=4, flags=FREE),
)  # fmt: skip

WAITS = solution(r1="a 0 5, b 5 6, c 6 7")
LONG = instance(row("abc", b={"duration": 4}), R1)
UNDER_WAY = solution(r1="a 0 1, b 1 5, c 5 6")
LATER = instance(row("abc"), robot("r1", "a", "c", release=4))
BACK = parking(graph("ab bc dc ce"), R1, robot("r2", "d", "e", release=9))
ARRIVED, COMING = "a 0 1, b 1 2, c 2 -", "d 9 10, c 10 11, e 11 -"
HISTORY: Sequence[Vector] = (
    query("stops-waiting", "it was to wait until 5; at 2 it learns that it need not", ALONE, WAITS,
          "a 0 2, b 2 3, c 3 4", now=2, cost=3, flags=EDGE),
    query("in-the-middle-of-a-stay", "it keeps the tick at which it entered b, and leaves as soon as it could", LONG,
          UNDER_WAY, "a 0 1, b 1 5, c 5 6", now=3, cost=5),
    query("plan-ended", "a robot that has vanished keeps its plan", ALONE, solution(r1="a 0 1, b 1 2, c 2 3"),
          "a 0 1, b 1 2, c 2 3", now=3, cost=2, flags=EDGE),
    query("not-yet-released", "it has no history, and starts at its release", LATER,
          solution(r1="a 4 9, b 9 10, c 10 11"), "a 4 5, b 5 6, c 6 7", now=2, cost=2),
    query("parked-makes-room", "parked in c since 2, it comes back after r2 has passed", BACK,
          solution(r1=ARRIVED, r2=COMING), "a 0 1, b 1 2, c 2 10, b 10 11, c 11 -", now=6, cost=11),
    query("parked-stays", "nobody is in its way", parking(row("abc"), R1), solution(r1=ARRIVED), ARRIVED, now=6,
          cost=2),
    query("waiting-since-its-release", "without a plan it stands at its start until now", ALONE, NOBODY,
          "a 0 6, b 6 7, c 7 8", now=6, cost=7, flags=EDGE),
    query("leaves-in-the-past", "at 2 it cannot leave at 1", ALONE, WAITS, "a 0 1, b 1 2, c 2 3", "fleet/history",
          now=2,
          cost=3, flags=KNOWN_BUG),
    query("other-past", "at 3 it was in b since 1", LONG, UNDER_WAY, "a 0 3, b 3 7, c 7 8", "query/optimal",
          "fleet/history", now=3, cost=5),
    query("past-forgotten", "a plan that begins where the robot is now", LONG, UNDER_WAY, "b 3 7, c 7 8", "plan/start",
          "query/sound", "fleet/history", now=3, cost=5, flags=KNOWN_BUG),
    query("ended-plan-changed", "it had left the system by 3", ALONE, solution(r1="a 0 1, b 1 2, c 2 3"),
          "a 0 4, b 4 5, c 5 6", "query/optimal", "fleet/history", now=3, cost=2),
    query("stops-waiting-on-the-way", "it was to stay in x until 9, and learns at 5 that it may go", CROSS,
          solution(r1="a 0 1, x 1 9, b 9 10", r2="c 0 9, x 9 10, d 10 11"), "a 0 1, x 1 5, b 5 6", now=5, cost=5),
    query("own-plan-is-not-in-its-way", "its own stay is no occupation: it may keep it", WAIT,
          solution(r1="a 0 6, b 6 7, c 7 8", r2="b 0 6, x 6 7"), "a 0 6, b 6 7, c 7 8", now=3, cost=7, flags=KNOWN_BUG),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {
    "query/sound": SOUND,
    "query/optimal": OPTIMAL,
    "query/complete": COMPLETE,
    "query/ties": TIES,
    "fleet/history": HISTORY,
}
