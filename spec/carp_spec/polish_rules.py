"""The rules of polishing, large neighbourhood search (LNS): `polish/...`.

A round removes a few robots from a solution and replans them. It draws, one after the other: its kind, its pivot, its
candidates, its members, and their order.
"""

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import accumulate, islice
from sys import float_info
from typing import Any, Literal, TypeAlias, TypeVar, cast

from carp_spec.model import Plan, ResourceId, Visit
from carp_spec.permutations import shuffle
from carp_spec.planners import LARGEST_SEED
from carp_spec.rule import DESIGN, Found, Rule, fault_rule, is_between, rule

T = TypeVar("T")
Kind: TypeAlias = Literal["repair", "delayed", "contested", "near"]
Span: TypeAlias = tuple[int, int | None]

DELAYED: tuple[Kind, ...] = ("delayed",) * 8
KINDS: tuple[Kind, ...] = (*DELAYED, "contested", "near")
LEAST_MEMBERS = 4
SIZES = 7
ITERATIONS = 10_000
LARGE_NEIGHBOURHOOD = "Li et al. 2021, MAPF-LNS"


@rule(
    "polish/draws",
    "All choices of a polish come from the SplitMix64 stream of its seed, in order. A choice among n is the next "
    "number mod n. To draw some of n things, the thing in place k = 0, 1, ... is swapped with the thing in place k "
    "plus a choice among n - k; the things in the first places are drawn, in that order.",
    DESIGN,
)
def drawn(things: Sequence[T], count: int, stream: Iterator[int]) -> list[T]:
    places = list(things)
    for k in range(count):
        other = k + next(stream) % (len(places) - k)
        places[k], places[other] = places[other], places[k]
    return places[:count]


@rule(
    "polish/kind",
    "While a robot that has a path is unplanned, every other round repairs, the first included, and every round if no "
    "robot is delayed. If no robot is unplanned or delayed, the polish ends. Else a choice among 10 decides: 0 to 7 is "
    "a round for a delayed robot, 8 for a contested resource, 9 for near robots.",
    f"{LARGE_NEIGHBOURHOOD}; {DESIGN}",
)
def kind_of(turn: int, waiting: int, delay: int, stream: Iterator[int]) -> Kind | None:
    """`waiting` robots that have a path are unplanned; the delays sum up to `delay`."""
    if waiting > 0 and (turn % 2 == 0 or delay == 0):
        return "repair"
    return None if delay == 0 else KINDS[next(stream) % len(KINDS)]


@rule(
    "polish/pivot",
    "The first member, the pivot, is the first robot, in the order of the instance, at which the sum of the weights "
    "exceeds a choice among their sum. The weight is 1 of each unplanned robot that has a path (repair), the delay, "
    "the cost less that of the plan alone, of each planned robot (delayed), or 1 of each planned robot (contested, "
    "near).",
    f"{LARGE_NEIGHBOURHOOD}; {DESIGN}",
)
def pivot_of(weights: Sequence[int], stream: Iterator[int]) -> int:
    return bisect_right(list(accumulate(weights)), next(stream) % sum(weights))


@rule(
    "polish/members",
    f"The neighbourhood has {LEAST_MEMBERS} robots and a choice among {SIZES} more, but at most all that have a path: "
    "the pivot, then the first of the candidates, then robots drawn from the others that have a path, in the order of "
    "the instance. After tick 0 a robot without a plan counts as one without a path.",
    DESIGN,
)
def members_of(pivot: T, candidates: Sequence[T], everyone: Sequence[T], stream: Iterator[int]) -> list[T]:
    """`everyone` is all robots that have a path, in the order of the instance."""
    size = min(LEAST_MEMBERS + next(stream) % SIZES, len(everyone))
    chosen = [pivot, *islice(candidates, size - 1)]
    others = [each for each in everyone if each not in chosen]
    return chosen + drawn(others, size - len(chosen), stream)


def spans(successors: Mapping[ResourceId, Sequence[ResourceId]], plan: Plan) -> Mapping[ResourceId, Span]:
    """The spans of `polish/way`; plans have their visits in order of time."""
    found: dict[ResourceId, Span] = {}
    for visit in plan.visits:
        for resource in (visit.resource, *successors[visit.resource]):
            first, _ = found.get(resource, (visit.enter, None))
            found[resource] = (first, visit.leave)
    return found


@rule(
    "polish/way",
    "A robot is in the way of a plan if one of its stays, [enter, leave), meets the span, [first, last], of the "
    "resource: first <= leave and enter <= last. A span is from the first enter to the last leave of the plan's "
    "visits there and in resources with a move to it. The plan is that of the pivot alone (repair; delayed, by a "
    "choice of 0 among 2) or its own (1). The candidates are the robots in its way, drawn.",
    f"{LARGE_NEIGHBOURHOOD}; {DESIGN}",
)
def is_in_way(spans: Mapping[ResourceId, Span], other: Plan) -> bool:
    met = ((visit, *spans[visit.resource]) for visit in other.visits if visit.resource in spans)
    return any(
        (visit.leave is None or first <= visit.leave) and (last is None or visit.enter <= last)
        for visit, first, last in met
    )


@rule(
    "polish/contested",
    "A choice among the visits of the pivot's plan gives a resource and the tick at which it is entered. The "
    "candidates are the other robots that visit the resource, ordered by the fewest ticks earlier or later that they "
    "enter it; a tie goes to the earlier in the instance.",
    f"{LARGE_NEIGHBOURHOOD}; {DESIGN}",
)
def ticks_apart(visit: Visit, other: Plan) -> int | None:
    """How many ticks; `None` if the robot never visits the resource."""
    ticks = [abs(each.enter - visit.enter) for each in other.visits if each.resource == visit.resource]
    return min(ticks, default=None)


@rule(
    "polish/near",
    "The candidates are all other robots that have a plan, ordered by their `neighbourhood/distance` from the pivot; a "
    "tie goes to the earlier in the instance.",
    "paper, Algorithm 1, line 7",
)
def by_distance(distances: Sequence[Fraction]) -> list[int]:
    """The places, the nearest first."""
    return sorted(range(len(distances)), key=distances.__getitem__)


@rule(
    "polish/order",
    "The members are planned in the order in which they were chosen. In a repair, and by a choice of 0 among 2, all "
    "but the pivot are shuffled; by 1, all are shuffled. The shuffle is Fisher-Yates, as in `neighbourhood/orders`.",
    DESIGN,
)
def order_of(members: Sequence[T], is_repair: bool, stream: Iterator[int]) -> tuple[T, ...]:
    first = int(is_repair or next(stream) % 2 == 0)
    return (*members[:first], *shuffle(members[first:], stream))


@rule(
    "polish/kept",
    "Each member is planned by CARP, at the tick at which plans are polished, against the robots outside and the "
    "members before it: it keeps what it has done by then (`fleet/history`). One that finds no plan is unplanned. The "
    "new plans are kept if fewer robots are unplanned than before, or equally many and the total is not larger. The "
    "planning order is then that of the robots outside, then that of the members.",
    DESIGN,
)
def is_kept(before: tuple[int, int], after: tuple[int, int]) -> bool:
    """Each argument is the number of unplanned robots and the total."""
    return after <= before


@fault_rule(
    "polish/options",
    "A polish has a number of rounds, iterations, a whole number of at least 0, or a time, seconds, above 0, or "
    f"neither, which means {ITERATIONS} iterations; and a seed between 0 and 2^64 - 1.",
    DESIGN,
)
def options_are_right(iterations: object, seconds: object, seed: object) -> Found:
    if iterations is not None and seconds is not None:
        yield "$.seconds", "there must be either iterations or seconds, not both"
    if iterations is not None and not is_between(iterations, 0):
        yield "$.iterations", f"the iterations must be a whole number of at least 0, not {iterations!r}"
    is_number = isinstance(seconds, int | float) and not isinstance(seconds, bool)
    if not (seconds is None or (is_number and 0 < cast("float", seconds) <= float_info.max)):
        yield "$.seconds", f"the seconds must be a number above 0, not {seconds!r}"
    if not is_between(seed, 0, LARGEST_SEED):
        yield "$.seed", f"the seed must be a whole number between 0 and {LARGEST_SEED}, not {seed!r}"


def last_round(iterations: int | None, seconds: float | None) -> int | None:
    """The rounds of a polish; `None`: the time decides."""
    return ITERATIONS if iterations is None and seconds is None else iterations


POLISH_RULES: tuple[Rule[..., Any], ...] = (
    drawn,
    kind_of,
    pivot_of,
    members_of,
    is_in_way,
    ticks_apart,
    by_distance,
    order_of,
    is_kept,
    options_are_right,
)
