"""Cases of the op `verify-query`: certificates that prove how early a robot can arrive, and others that do not."""

from collections.abc import Mapping, Sequence

from tests.vectors.making import EDGE, Flags, case, graph, instance, parking, robot, row, solution

from carp_spec.query_certificates import QUERY_FORMAT
from carp_spec.vectors import Fields, Vector

PLANS, ROBOT, BOUND, POTENTIAL, CLOSED = (
    f"query-certificate/{name}" for name in ("plans", "robot", "bound", "potential", "closed")
)

EAST = robot("r1", "a", "c")
LANE = instance(row("abc"), EAST)
CROSSING = instance(graph("ab bc db be"), EAST, robot("r2", "d", "e"))
CROSSED = solution(["r1"], r2="d 0 1, b 1 2, e 2 3")
BLOCKED = parking(row("abc"), EAST, robot("r2", "b", "b"))
PARKED = solution(["r1"], r2="b 0 -")
AT_HOME = instance(row("ab"), robot("r1", "a", "a"))
NOBODY = solution(["r1"])
ABC: Sequence[tuple[str, int]] = (("a", 2), ("b", 1), ("c", 0))


def _certificate(  # noqa: PLR0913 - the fields of a case
    id: str,
    comment: str,
    instance: Fields,
    solution: Fields,
    arrival: int | None,
    *violated: str,
    bound: int | None = None,
    labels: Sequence[tuple[str, int]] = (),
    potential: Sequence[tuple[str, int]] = ABC,
    robot: str = "r1",
    now: int = 0,
    flags: Flags = (),
) -> Vector:
    """A certificate for a robot whose earliest arrival is known."""
    certificate: Fields = {
        "format": QUERY_FORMAT,
        "robot": robot,
        "now": now,
        "bound": bound,
        "labels": [[*label] for label in labels],
        "potential": [[*each] for each in potential],
    }
    return case(
        id,
        "verify-query",
        comment,
        instance=instance,
        input={"solution": solution, "certificate": certificate},
        violated=violated,
        answer={"arrival": arrival},
        flags=flags,
    )


CERTIFICATES: Sequence[Vector] = (
    _certificate("alone", "the potential of the start is the bound: no label is needed", LANE, NOBODY, 2, bound=2),
    _certificate("too-low", "a bound may be lower than the earliest arrival", LANE, NOBODY, 2, bound=1, flags=EDGE),
    _certificate("low-potential", "a potential of 0 everywhere is right, and needs labels", LANE, NOBODY, 2, bound=2,
                 labels=[("b", 1)], potential=[("a", 0), ("b", 0), ("c", 0)]),
    _certificate("waits-for-the-crossing", "the start is left a tick later: b is full in [1,2)", CROSSING, CROSSED, 3,
                 bound=3, potential=[*ABC, ("d", 2), ("e", 2)]),
    _certificate("blocked", "a parked robot is in the way for ever", BLOCKED, PARKED, None),
    _certificate("out-of-reach", "from a resource without a potential the goal cannot be reached",
                 instance(graph("ba bc", directed=True), EAST), NOBODY, None, potential=[("b", 1), ("c", 0)]),
    _certificate("ended", "a plan that has ended stays as it is", AT_HOME, solution(r1="a 0 1"), 0, bound=0, now=1,
                 potential=[], flags=EDGE),
    _certificate("nowhere-labels", "labels outside all windows, and of resources that there are not, mean nothing",
                 LANE, NOBODY, 2, bound=2, labels=[("z", 0), ("b", -1)], potential=[*ABC, ("z", 9)], flags=EDGE),
    _certificate("in-b-until-now", "the plan is followed up to now: the robot is in b, and leaves it now", LANE,
                 solution(r1="a 0 1, b 1 9, c 9 10"), 4, bound=4, now=4, labels=[("b", 3), ("a", 5)]),
    _certificate("one-tick-late", "the robot can arrive at 2", LANE, NOBODY, 2, CLOSED, bound=3),
    _certificate("no-plan-claimed", "the robot has a plan", LANE, NOBODY, 2, CLOSED),
    _certificate("label-missing", "b can be entered at 2", CROSSING, CROSSED, 3, CLOSED, bound=4,
                 potential=[*ABC, ("d", 2), ("e", 2)]),
    _certificate("label-late", "b can be entered at 1, and has a label at 2", LANE, NOBODY, 2, CLOSED, bound=4,
                 labels=[("b", 2)]),
    _certificate("label-in-another-window", "b can be entered at 2, and the label is in the window before", CROSSING,
                 CROSSED, 3, CLOSED, bound=4, labels=[("b", 0)], potential=[*ABC, ("d", 2), ("e", 2)]),
    _certificate("can-end", "the label of the goal lets the plan end there", LANE, NOBODY, 2, CLOSED, bound=3,
                 labels=[("b", 1), ("c", 2)]),
    _certificate("goal-at-1", "the potential of the goal is not 0", LANE, NOBODY, 2, POTENTIAL, bound=3,
                 potential=[("a", 3), ("b", 2), ("c", 1)]),
    _certificate("grows-by-2", "one move from b to c takes one tick", LANE, NOBODY, 2, POTENTIAL, bound=3,
                 potential=[("a", 3), ("b", 2), ("c", 0)]),
    _certificate("way-left-out", "b leads to c, which has a potential, and has none", LANE, NOBODY, 2, POTENTIAL,
                 potential=[("c", 0)]),
    _certificate("ended-later", "the plan has ended, and arrived at 0", AT_HOME, solution(r1="a 0 1"), 0, BOUND,
                 bound=1, now=1, potential=[("a", 0), ("b", 1)]),
    _certificate("stranger", "the instance has no r9", LANE, NOBODY, None, ROBOT, robot="r9"),
    _certificate("plan-that-jumps", "the plan beside which it is planned breaks a rule by itself",
                 CROSSING, solution(["r1"], r2="d 0 1, e 1 2"), None, PLANS, potential=[*ABC, ("d", 2), ("e", 2)]),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {"verify-query": CERTIFICATES}
