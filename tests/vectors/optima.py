"""Cases of the op `optimum`: small instances whose least total cost is proved by looking at all plans."""

from collections.abc import Mapping, Sequence

from tests.vectors.making import EDGE, KNOWN_BUG, Flags, case, graph, instance, parking, robot, row

from carp_spec.vectors import Fields, Vector


def _optimum(id: str, comment: str, instance: Fields, cost: int | None, flags: Flags = ()) -> Vector:
    return case(id, "optimum", comment, instance=instance, answer={"cost": cost}, flags=flags)


EAST, WEST = robot("r1", "a", "c"), robot("r2", "c", "a")
BAY = graph("ab bc bx")
PAIR = graph("ab", a={"capacity": 2}, b={"capacity": 2})
RING = graph("ab bc cd da")
ROUND = [robot(f"r{number}", *ends) for number, ends in enumerate(("ab", "bc", "cd", "da"), start=1)]
SLOW = graph("ax xb cx xd", x={"duration": 3})

OPTIMA: Sequence[Vector] = (
    _optimum("no-robots", "nothing to do", instance(row("ab")), 0, EDGE),
    _optimum("alone", "a shortest path", instance(row("abc"), EAST), 2),
    _optimum("at-home", "start and goal are the same", instance(row("ab"), robot("r1", "a", "a")), 0, KNOWN_BUG),
    _optimum("bay", "head-on in a lane with one bay: one of them waits there", instance(BAY, EAST, WEST), 7),
    _optimum("bay-parked", "the same, with robots that stay", parking(BAY, EAST, WEST), 7),
    _optimum("lane", "head-on in a lane without a bay: there are no such plans", instance(row("abc"), EAST, WEST), None,
             KNOWN_BUG),
    _optimum("same-goal", "both park in one place: there are no such plans",
             parking(row("abc"), robot("r1", "a", "b"), robot("r2", "c", "b")), None, KNOWN_BUG),
    _optimum("same-goal-vanishing", "one after the other",
             instance(row("abc"), robot("r1", "a", "b"), robot("r2", "c", "b")), 3),
    _optimum("ring", "all turn at once", parking(RING, *ROUND), 4, EDGE),
    _optimum("pass-where-two-fit", "opposite moves at different ticks",
             instance(PAIR, robot("r1", "a", "b"), robot("r2", "b", "a")), 3, EDGE),
    _optimum("slow-crossing", "the crossing takes three ticks, and one waits for it",
             instance(SLOW, robot("r1", "a", "b"), robot("r2", "c", "d")), 11),
    _optimum("makes-room", "the robot at its goal moves aside and comes back",
             parking(graph("ab bc bx"), robot("r1", "b", "b"), robot("r2", "a", "c")), 4, KNOWN_BUG),
    _optimum("waits-for-the-late", "the one that comes late is cheaper to let pass",
             instance(graph("ax xb cx xd"), robot("r1", "a", "b"), robot("r2", "c", "d", release=1)), 4),
    _optimum("slow-robot", "the fast robot waits behind the slow one",
             instance(row("abcd"), robot("r1", "b", "d", pace=3), robot("r2", "a", "c")), 12),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {"optimum": OPTIMA}
