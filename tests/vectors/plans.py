"""Cases of `solution/...`, `plan/...` and `cost/...`: what one plan must be."""

from collections.abc import Mapping, Sequence

from tests.vectors.making import (
    EDGE,
    KNOWN_BUG,
    Flags,
    case,
    check,
    graph,
    instance,
    parking,
    robot,
    row,
    solution,
)

from carp_spec.vectors import Fields, Vector

PAIR = instance(row("abcd"), robot("r1", "a", "c"), robot("r2", "b", "d"))
EAST, NEXT = "a 0 1, b 1 2, c 2 3", "b 0 1, c 1 2, d 2 3"
BOTH = solution(r1=EAST, r2=NEXT)
ONE = instance(row("abcd"), robot("r1", "a", "c"))
PARKS = parking(row("abcd"), robot("r1", "a", "c"))
LATE = instance(row("abcd"), robot("r1", "a", "c", release=3))
AT_GOAL = instance(row("ab"), robot("r1", "a", "a"))


def _with(**fields: object) -> Fields:
    return {**BOTH, **fields}


COVERS: Sequence[Vector] = (
    check("all-planned", "each robot has a plan", PAIR, BOTH, cost=4),
    check("one-unplanned", "a robot may be unplanned if it is said", PAIR, solution(["r2"], r1=EAST), cost=2,
          unplanned=1),
    check("none-planned", "all may be", PAIR, solution(["r2", "r1"]), cost=0, unplanned=2, flags=EDGE),
    check("no-robots", "nothing to cover", instance(row("ab")), solution(), cost=0, flags=EDGE),
    check("forgotten", "a robot that fails must not disappear from the count", PAIR, solution(r1=EAST),
          "solution/covers", cost=2, unplanned=1, flags=KNOWN_BUG),
    check("planned-and-unplanned", "one or the other", PAIR, _with(unplanned=["r1"]), "solution/covers", cost=4),
    check("stranger", "a robot that the instance does not have", PAIR, _with(unplanned=["r3"]), "solution/covers",
          cost=4),
    check("text-for-number", 'the robot "1" is not the robot 1', instance(row("ab"), robot(1, "a", "b")),
          solution(["1"]), "solution/covers", cost=0, unplanned=1),
)  # fmt: skip
ORDER: Sequence[Vector] = (
    check("as-listed", "the order of the plans", PAIR, BOTH, cost=4),
    check("another-order", "plans may be listed in any order; `order` says how they were made", PAIR,
          _with(order=["r2", "r1"]), cost=4),
    check("unplanned-not-in-it", "a robot without plan has no place in the order", PAIR, solution(["r2"], r1=EAST),
          cost=2, unplanned=1),
    check("incomplete", "the second robot was planned after whom?", PAIR, _with(order=["r1"]), "solution/order",
          cost=4),
    check("twice", "a robot is planned once", PAIR, _with(order=["r1", "r2", "r1"]), "solution/order", cost=4),
    check("names-unplanned", "a robot without plan was not planned", PAIR,
          {**solution(["r2"], r1=EAST), "order": ["r1", "r2"]}, "solution/order", cost=2, unplanned=1),
    check("empty", "no order at all", PAIR, _with(order=[]), "solution/order", cost=4, flags=EDGE),
)  # fmt: skip
START: Sequence[Vector] = (
    check("at-zero", "the usual start", ONE, solution(r1=EAST), cost=2),
    check("at-release", "a released robot enters its start at its release", LATE, solution(r1="a 3 4, b 4 5, c 5 6"),
          cost=2),
    check("waits-first", "waiting at the start is part of the plan", ONE, solution(r1="a 0 5, b 5 6, c 6 7"), cost=6),
    check("start-is-goal", "one visit is a whole plan, of cost 0", AT_GOAL, solution(r1="a 0 1"), cost=0,
          flags=KNOWN_BUG),
    check("too-late", "the ticks before are nowhere accounted for", ONE, solution(r1="a 1 2, b 2 3, c 3 4"),
          "plan/start", cost=3, flags=EDGE),
    check("release-ignored", "the robot is not there yet", LATE, solution(r1=EAST), "plan/start", cost=-1),
    check("elsewhere", "the right tick and the wrong place", ONE, solution(r1="b 0 1, c 1 2"), "plan/start", cost=1),
    check("first-step-left-out", "formats that list moves only lose the stay at the start", ONE,
          solution(r1="b 1 2, c 2 3"), "plan/start", cost=2, flags=KNOWN_BUG),
    check("no-visit", "an empty plan neither starts nor arrives", ONE, solution(r1=""), "plan/start", "plan/goal",
          cost=0,
          flags=EDGE),
)  # fmt: skip
GOAL: Sequence[Vector] = (
    check("vanishes", "it leaves one duration after it enters", ONE, solution(r1=EAST), cost=2),
    check("parks", "it stays for ever", PARKS, solution(r1="a 0 1, b 1 2, c 2 -"), cost=2),
    check("vanishes-slowly", "its duration at the goal counts its pace", instance(row("abc", c={"duration": 2}),
          robot("r1", "a", "c", pace=3)), solution(r1="a 0 3, b 3 6, c 6 12"), cost=6),
    check("through-the-goal", "passing the goal is not arriving: it is entered for the last time at 4", ONE,
          solution(r1="a 0 1, b 1 2, c 2 3, d 3 4, c 4 5"), cost=4),
    check("start-is-goal-parked", "it is where it wants to be", parking(row("ab"), robot("r1", "a", "a")),
          solution(r1="a 0 -"), cost=0, flags=KNOWN_BUG),
    check("stops-short", "one move before the goal", ONE, solution(r1="a 0 1, b 1 2"), "plan/goal", cost=1, flags=EDGE),
    check("leaves-goal-again", "arrived, and moved on", ONE, solution(r1="a 0 1, b 1 2, c 2 3, d 3 4"), "plan/goal",
          cost=3),
    check("never-vanishes", "a robot that stays at its goal blocks it for all others", ONE,
          solution(r1="a 0 1, b 1 2, c 2 -"), "plan/goal", cost=2, flags=KNOWN_BUG),
    check("vanishes-late", "a tick longer than it needs", ONE, solution(r1="a 0 1, b 1 2, c 2 4"), "plan/goal", cost=2,
          flags=EDGE),
    check("vanishes-though-parking", "a parked robot is still there after its plan ends", PARKS, solution(r1=EAST),
          "plan/goal", cost=2, flags=KNOWN_BUG),
)  # fmt: skip
RESOURCE: Sequence[Vector] = (
    check("known", "cells of the graph", ONE, solution(r1=EAST), cost=2),
    check("number-ids", "ids may be numbers", {**ONE, "graph": {"nodes": [{"id": 1}, {"id": "1"}],
          "edges": [{"source": 1, "target": "1"}]}, "robots": [{"id": "r1", "start": 1, "goal": "1"}]},
          {**solution(r1=""), "plans": [{"robot": "r1", "visits": [[1, 0, 1], ["1", 1, 2]]}]}, cost=1),
    check("visited-again", "a resource may be visited more than once", ONE,
          solution(r1="a 0 1, b 1 2, a 2 3, b 3 4, c 4 5"), cost=4),
    check("off-the-map", "one step beyond the edge of the map", ONE, solution(r1="a 0 1, x 1 2, b 2 3, c 3 4"),
          "plan/resource", cost=3),
    check("other-letter-case", "ids are compared letter by letter", ONE, solution(r1="a 0 1, B 1 2, c 2 3"),
          "plan/resource", cost=2),
    check("goal-off-the-map", "the last visit too", ONE, solution(r1="a 0 1, b 1 2, C 2 3"), "plan/goal",
          "plan/resource",
          cost=2),
)  # fmt: skip
MOVE: Sequence[Vector] = (
    check("along-edges", "each step is an edge", ONE, solution(r1=EAST), cost=2),
    check("backwards", "an undirected edge is two moves", instance(row("abcd"), robot("r1", "c", "a")),
          solution(r1="c 0 1, b 1 2, a 2 3"), cost=2),
    check("one-way", "along a directed edge", instance(graph("ab bc", directed=True), robot("r1", "a", "c")),
          solution(r1=EAST), cost=2),
    check("teleports", "from a to c is no move", ONE, solution(r1="a 0 1, c 1 2"), "plan/move", cost=1,
          flags=KNOWN_BUG),
    check("against-one-way", "the edge leads the other way",
          instance(graph("ab bc ca", directed=True), robot("r1", "a", "c")), solution(r1="a 0 1, c 1 2"), "plan/move",
          cost=1),
    check("waits-as-move", "waiting is one longer visit, not two", ONE, solution(r1="a 0 1, a 1 2, b 2 3, c 3 4"),
          "plan/move", cost=3),
    check("other-part", "there is no edge at all between them", instance(graph("ab cd"), robot("r1", "a", "d")),
          solution(r1="a 0 1, b 1 2, d 2 3"), "plan/move", cost=2),
)  # fmt: skip
CONTIGUOUS: Sequence[Vector] = (
    check("hand-over", "a visit ends at the tick at which the next begins", ONE, solution(r1=EAST), cost=2),
    check("waits-on-the-way", "waiting prolongs the visit", ONE, solution(r1="a 0 1, b 1 6, c 6 7"), cost=6),
    check("one-visit", "nothing to be joined", AT_GOAL, solution(r1="a 0 1"), cost=0, flags=EDGE),
    check("gap", "for a tick the robot is nowhere, and nobody can run into it", ONE, solution(r1="a 0 1, b 2 3, c 3 4"),
          "plan/contiguous", cost=3, flags=KNOWN_BUG),
    check("overlap", "closed intervals: the robot is in two places at tick 1", ONE,
          solution(r1="a 0 2, b 1 3, c 2 3"), "plan/contiguous", cost=2, flags=EDGE),
    check("after-for-ever", "nothing comes after a stay for ever", ONE, solution(r1="a 0 1, b 1 -, c 2 3"),
          "plan/contiguous", cost=2),
    check("backwards-in-time", "it enters before it was anywhere", ONE, solution(r1="a 0 3, b 1 2, c 2 3"),
          "plan/contiguous", cost=2),
)  # fmt: skip
SLOW = instance(row("abc", b={"duration": 3}), robot("r1", "a", "c"))
PACED = instance(row("abc", b={"duration": 3}), robot("r1", "a", "c", pace=2))
DURATION: Sequence[Vector] = (
    check("as-long-as-needed", "three ticks in b", SLOW, solution(r1="a 0 1, b 1 4, c 4 5"), cost=4, flags=EDGE),
    check("longer", "waiting is free", SLOW, solution(r1="a 0 1, b 1 9, c 9 10"), cost=9),
    check("paced", "a robot of pace 2 needs twice as long everywhere", PACED, solution(r1="a 0 2, b 2 8, c 8 10"),
          cost=8),
    check("a-tick-short", "the stay is one tick too short", SLOW, solution(r1="a 0 1, b 1 3, c 3 4"), "plan/duration",
          cost=3, flags=KNOWN_BUG),
    check("pace-ignored", "a slow robot timed like a fast one", PACED, solution(r1="a 0 1, b 1 4, c 4 6"),
          "plan/duration",
          cost=4, flags=KNOWN_BUG),
    check("pace-ignored-in-one-place", "only in b", PACED, solution(r1="a 0 2, b 2 7, c 7 9"), "plan/duration", cost=7,
          flags=EDGE),
    check("no-ticks", "a visit of zero length is no visit", ONE, solution(r1="a 0 1, b 1 1, c 1 2"), "plan/duration",
          cost=1, flags=KNOWN_BUG),
    check("negative", "a visit that ends before it begins", ONE, solution(r1="a 0 2, b 2 1, c 1 2"), "plan/duration",
          cost=1),
)  # fmt: skip


def _cost(  # noqa: PLR0913 - the fields of a case
    rule: str, id: str, comment: str, instance: Fields, solution: Fields, *, cost: int, wrong: int | None = None,
    flags: Flags = (),
) -> list[Vector]:  # fmt: skip
    """The right cost as a valid case and, where there is one, a wrong one as an invalid case."""
    input, answer = {"solution": solution}, {"cost": cost, "unplanned": 0}
    cases = [
        case(id, "check", comment, instance=instance, input=input, claim={"cost": cost}, answer=answer, flags=flags)
    ]
    if wrong is not None:
        cases.append(
            case(f"{id}-wrong", "check", comment, instance=instance, input=input, claim={"cost": wrong},
                 violated=[rule], answer=answer, flags=flags)
        )  # fmt: skip
    return cases


COST: Sequence[Vector] = (
    *_cost("cost/robot", "moves-and-waits", "two moves and two waits; the stay at the goal is not counted", ONE,
           solution(r1="a 0 2, b 2 4, c 4 5"), cost=4, wrong=5),
    *_cost("cost/robot", "from-the-release", "a late robot is not charged for the time before it came", LATE,
           solution(r1="a 3 4, b 4 5, c 5 6"), cost=2, wrong=5, flags=KNOWN_BUG),
    *_cost("cost/robot", "start-is-goal", "it is there at once", AT_GOAL, solution(r1="a 0 1"), cost=0, wrong=1,
           flags=KNOWN_BUG),
    *_cost("cost/robot", "comes-back", "a robot that moves off its goal and comes back pays for all of it", PARKS,
           solution(r1="a 0 1, b 1 2, c 2 7, d 7 8, c 8 -"), cost=8, wrong=2, flags=KNOWN_BUG),
    *_cost("cost/robot", "durations", "ticks count, not moves", SLOW, solution(r1="a 0 1, b 1 4, c 4 5"), cost=4,
           wrong=2),
)  # fmt: skip
MIXED = instance(graph("ab bc de"), robot("r1", "a", "c"), robot("r2", "d", "e", release=1))
TOTAL: Sequence[Vector] = (
    *_cost("cost/total", "sum", "the sum of costs", PAIR, BOTH, cost=4, wrong=2),
    *_cost("cost/total", "not-the-makespan", "it is not the tick at which the last one arrives", MIXED,
           solution(r1="a 0 1, b 1 5, c 5 6", r2="d 1 2, e 2 3"), cost=6, wrong=5),
    *_cost("cost/total", "no-robots", "of nothing it is 0", instance(row("ab")), solution(), cost=0, flags=EDGE),
    *_cost("cost/total", "releases-counted-off", "each from its own release", MIXED,
           solution(r1=EAST, r2="d 1 3, e 3 4"), cost=4, wrong=5, flags=EDGE),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {
    "solution/covers": COVERS,
    "solution/order": ORDER,
    "plan/start": START,
    "plan/goal": GOAL,
    "plan/resource": RESOURCE,
    "plan/move": MOVE,
    "plan/contiguous": CONTIGUOUS,
    "plan/duration": DURATION,
    "cost/robot": COST,
    "cost/total": TOTAL,
}
